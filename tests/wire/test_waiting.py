"""What waits loses nothing: throttling, full links, pulled cables, restarts, networks that overlap."""

import json
import pathlib
import random
import signal
import socket
import struct
import subprocess
import sys
import time
import unittest

import requests

import hosts
import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

CBOR = Style("cbor")
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}


def setUpModule():
    hosts.needs_namespaces()


def pose(name, x):
    return {"poses": [{"name": name, "position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}


def one_point(x):
    return maps.Cloud("one", maps.XYZ, 12, struct.pack("<3f", x, 0, 0))


class Waiting(unittest.TestCase):
    def stage(self, **overrides):
        stage = self.enterContext(Stage(**overrides))
        self.began = time.monotonic()
        self.addCleanup(lambda: self.assertEqual(stage.post.violations() if stage.post else [], []))
        self.session = requests.Session()
        return stage

    def post(self, stage, uri, message):
        answer = messages.post(self.session, stage.box.url, uri, message, CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def post_map(self, stage, source, name, seconds=None):
        self.post(stage, "/map/update", messages.map_update(source, name, seconds or time.time(), CBOR))

    def taken(self, stage, uri):
        return [request for request in stage.post.requests(uri) if request["status"] == 200]

    def are_one_a_second(self, requests):
        """At most, however long the test took."""
        self.assertLessEqual(len(requests), time.monotonic() - self.began + 1)

    def cloud_bytes(self, stage, name):
        return sum(request["message"]["msg"]["data"]["bytes"] for request in self.taken(stage, "/map/update")
                   if request["message"]["name"] == name)

    def test_clouds_ten_times_too_often_all_arrive_within_the_rate(self):
        stage = self.stage(post_options=("--rate", "1"), command_post__rates__map_hz=1)
        sent = {"r1": 0, "r2": 0}
        for number in range(30):
            for name in sent:
                cloud = maps.made_cloud(200 + number, seed=number)
                self.post_map(stage, cloud, name)
                sent[name] += len(cloud.data)
            time.sleep(0.05)
        for name, size in sent.items():
            wait_until(lambda name=name, size=size: self.cloud_bytes(stage, name) == size, f"all clouds of {name}")
        self.assertEqual([request["status"] for request in stage.post.requests("/map/update")].count(429), 0)
        self.are_one_a_second(stage.post.requests("/map/update"))

    def row_of_clouds(self, stage, name):
        return next(row for row in stage.box.ask("GET /adit/run")[1]["activities"]
                    if (row["kind"], row["robot"]) == ("cloud", name))

    def coordinates(self, stage, request):
        """In darpa, by axis, each in rising order, as a picture of the Command Post's transcript has them."""
        msg = request["message"]["msg"]
        data = (stage.post.transcript / msg["data"]["file"]).read_bytes().partition(b"DATA binary\n")[2]
        start = msg.get("origin", {}).get("position", {"x": 0.0, "y": 0.0, "z": 0.0})
        return [[value + start[axis] for value in struct.unpack(f"<{len(data) // 4}f", data)[number::3]]
                for number, axis in enumerate("xyz")]

    def test_clouds_are_rounded_as_far_as_what_waits_forces_it(self):
        stage = self.stage(robots=[{"name": "r1", "precision": "auto"}])
        clouds = [maps.made_cloud(2000, seed=number) for number in range(60)]
        self.post_map(stage, clouds[0], "r1")
        wait_until(lambda: self.taken(stage, "/map/update"), "the first cloud")
        wait_until(lambda: self.row_of_clouds(stage, "r1")["precision"] == "exact", "nothing to be forced")
        stage.post.process.send_signal(signal.SIGSTOP)
        for cloud in clouds[1:-1]:
            self.post_map(stage, cloud, "r1")
        stage.post.process.send_signal(signal.SIGCONT)
        sent = sum(len(cloud.data) for cloud in clouds[:-1])
        wait_until(lambda: self.cloud_bytes(stage, "r1") == sent, "all that waited")
        self.post_map(stage, clouds[-1], "r1")
        wait_until(lambda: self.cloud_bytes(stage, "r1") == sent + len(clouds[-1].data), "the last cloud")
        wait_until(lambda: self.row_of_clouds(stage, "r1")["precision"] == "exact", "that nothing forces it any more")
        requests = self.taken(stage, "/map/update")
        rounded = ["origin" in request["message"]["msg"] for request in requests]
        self.assertTrue(any(rounded))
        self.assertFalse(rounded[0] or rounded[-1])
        arrived = [self.coordinates(stage, request) for request in requests]
        for axis in range(3):
            here = sorted(value for each in arrived for value in each[axis])
            posted = sorted(value for cloud in clouds
                            for value in struct.unpack(f"<{len(cloud.data) // 4}f", cloud.data)[axis::3])
            self.assertEqual(len(here), len(posted))
            self.assertLessEqual(max(abs(a - b) for a, b in zip(here, posted, strict=True)), 1.3 / 128)

    def test_a_grid_that_covers_replaces_and_one_that_does_not_is_sent_beside(self):
        stage = self.stage()
        first = maps.made_grid(20, 20, seed=1)
        self.post_map(stage, first, "r1")
        wait_until(lambda: self.taken(stage, "/map/update"), "the first grid")
        stage.post.process.send_signal(signal.SIGSTOP)
        for name in ("r2", "r3"):  # one under way, and one packed: behind these the others wait
            self.post_map(stage, maps.made_grid(10, 10), name)
        aside = maps.made_grid(20, 20, seed=2)
        aside.origin = (first.origin[0] + 10.03, *first.origin[1:])  # not of one lattice with the others
        small, large = maps.made_grid(30, 30, seed=3), maps.made_grid(40, 40, seed=4)
        small.origin = large.origin = first.origin
        for grid in (small, aside, large):
            self.post_map(stage, grid, "r1")
        stage.post.process.send_signal(signal.SIGCONT)
        wait_until(lambda: not any(row["waiting"] for row in stage.box.ask("GET /adit/run")[1]["activities"]), "them to go")
        wait_until(lambda: len(self.taken(stage, "/map/update")) >= 5, "the grids that are left")
        arrived = [request["message"]["msg"]["info"]["width"] for request in self.taken(stage, "/map/update")
                   if request["message"]["name"] == "r1"]
        self.assertEqual(arrived, [20, 20, 40], "in the order in which they were made")

    def test_robots_that_post_alone_are_sent_together_at_one_a_second(self):
        stage = self.stage(post_options=("--rate", "1"), command_post__rates__state_hz=1)
        for step in range(25):
            for name in ("r1", "r2", "r3"):
                self.post(stage, "/state/update", pose(name, float(step)))
            time.sleep(0.1)
        wait_until(lambda: {item["position"]["x"] for item in self.taken(stage, "/state/update")[-1]["message"]["poses"]}
                   == {24.0}, "the last poses")
        last = self.taken(stage, "/state/update")[-1]["message"]["poses"]
        self.assertEqual([item["name"] for item in last], ["r1", "r2", "r3"])
        self.are_one_a_second(stage.post.requests("/state/update"))
        self.assertEqual(len(self.taken(stage, "/state/update")), len(stage.post.requests("/state/update")))

    def test_markers_merge_by_ns_and_id_with_their_deletes_in_order(self):
        stage = self.stage(command_post__rates__markers_hz=1)
        chance, scene = random.Random(5), {}
        for step in range(60):
            key = (chance.choice("ab"), chance.randint(0, 9))
            action = 3 if step == 30 else chance.choice((0, 0, 0, 2))
            marker = {"ns": key[0], "id": key[1], "type": 2, "action": action,
                      "pose": {"position": {"x": float(step), "y": 0.0, "z": 0.0}, "orientation": TURNED},
                      "scale": {"x": 1, "y": 1, "z": 1}, "color": {"r": 1, "g": 1, "b": 1, "a": 1}}
            replay(scene, [marker])
            self.post(stage, "/markers/update", {"markers": [marker]})
            time.sleep(0.02)

        def arrived():
            shown = {}
            for request in self.taken(stage, "/markers/update"):
                replay(shown, request["message"]["markers"])
            return shown

        wait_until(lambda: arrived() == scene, "the same scene")
        self.are_one_a_second(stage.post.requests("/markers/update"))

    def test_throttled_maps_are_sent_again_until_they_are_taken(self):
        stage = self.stage(post_options=("--rate", "2"))
        sent = 0
        for number in range(5):
            cloud = maps.made_cloud(100, seed=number, padding=4 * number)  # other fields: never merged
            cloud.fields = [dict(item, name=item["name"]) for item in cloud.fields]
            self.post_map(stage, cloud, "r1")
            sent += 100 * 12  # the padding stays here
        wait_until(lambda: self.cloud_bytes(stage, "r1") == sent, "all of them")
        view = stage.box.ask("GET /adit/run")[1]
        row = next(row for row in view["activities"] if row["kind"] == "cloud")
        self.assertEqual((row["accepted"], row["waiting"]), (5, 0))

    def test_a_pulled_cable_delays_and_loses_nothing(self):
        stage = self.stage(command_post__timeouts__mapping_answer_ms=2000, command_post__timeouts__connect_ms=500)
        self.post_map(stage, maps.made_cloud(100), "r1")
        wait_until(lambda: self.cloud_bytes(stage, "r1") == 1200, "the first cloud")
        stage.network.pull_cable()
        for number in range(3):
            self.post_map(stage, maps.made_cloud(100, seed=number), "r1")
            self.post(stage, "/state/update", pose("r1", float(number)))
        time.sleep(3)
        stage.network.pull_cable(False)
        wait_until(lambda: self.cloud_bytes(stage, "r1") >= 4800, "what came while the cable was out")
        wait_until(lambda: any(item["position"]["x"] == 2.0 for request in self.taken(stage, "/state/update")
                               for item in request["message"]["poses"]), "the last pose")

    def test_what_waits_outlives_the_end_of_the_service(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(number.name), Stage(post_options=None) as stage:
                self.session = requests.Session()
                self.outlives(stage, number)

    def outlives(self, stage, number):
        grid, cloud = maps.made_grid(64, 48), maps.made_cloud(300)
        for _ in range(3):  # each replaces the one before
            self.post_map(stage, grid, "r1")
        self.post_map(stage, cloud, "r2")
        self.post(stage, "/state/update", pose("r3", 4.0))
        self.post(stage, "/markers/update", {"markers": [{"action": 2, "ns": "a", "id": 1}]})
        kept = stage.box.state / "waiting"
        wait_until(lambda: len(list(kept.glob("*.cbor"))) == 2, "the maps to be kept")
        stage.box.stop(number)
        stage.post = programs.CommandPost(stage.network, stage.folder, "--rate", "0")
        stage.restart_box()
        wait_until(lambda: len(self.taken(stage, "/map/update")) == 2, "both maps")
        wait_until(lambda: self.taken(stage, "/state/update") and self.taken(stage, "/markers/update"), "the rest")
        sizes = {request["message"]["name"]: request["message"]["msg"]["data"]["bytes"]
                 for request in self.taken(stage, "/map/update")}
        self.assertEqual(sizes, {"r1": len(grid.data), "r2": len(cloud.data)})
        wait_until(lambda: not list(kept.glob("*.cbor")), "what was taken to be forgotten")
        self.assertEqual(stage.post.violations(), [])

    def test_senders_with_clocks_of_their_own_never_run_upstream_backward(self):
        stage = self.stage()
        clocks = {"r1": 1000.0, "r2": 1700000000.0, "r3": 5.0}
        chance = random.Random(3)
        for _ in range(40):
            name = chance.choice(list(clocks))
            clocks[name] += 0.05 if chance.random() < 0.9 else -3.0
            self.post(stage, "/state/update", {"header": {"stamp": clocks[name]}, **pose(name, 1.0)})
            self.post_map(stage, maps.made_cloud(3), name, clocks[name])
            time.sleep(0.02)
        wait_until(lambda: len(self.taken(stage, "/map/update")) > 10, "maps")
        for uri, at in (("/map/update", lambda message: message["msg"]), ("/state/update", lambda message: message)):
            stamps = [at(request["message"])["header"]["stamp"] for request in stage.post.requests(uri)]
            self.assertEqual(stamps, sorted(stamps))

    def picky_post(self, stage):
        """What gives its log: the status and the points of each request."""
        log = stage.folder / "picky.jsonl"
        picky = programs.Program(stage.network, stage.network.post, stage.folder / "picky.log",
                                 [sys.executable, "-B", pathlib.Path(__file__).with_name("picky_post.py"),
                                  f"{hosts.MAPPING}:{programs.PORT}", log, 422])
        self.addCleanup(picky.stop, signal.SIGKILL)
        wait_until(lambda: "listening" in picky.said(), "the picky Command Post")
        return lambda: [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []

    def test_one_cloud_that_is_refused_takes_no_other_with_it(self):
        stage = self.stage(post_options=None, command_post__rates__map_hz=4)
        log = self.picky_post(stage)
        for number in range(1, 31):
            self.post_map(stage, one_point(number), "r1")

        def arrived():
            return sorted(point for status, points in log() if status == 200 for point in points)

        wait_until(lambda: len(arrived()) == 29, "all clouds but one")
        self.assertEqual(arrived(), [float(number) for number in range(1, 31) if number != 13])

    def test_a_cloud_that_is_refused_waits_or_is_set_aside_whenever_the_box_is_killed(self):
        stage = self.stage(post_options=None, command_post__rates__map_hz=4)
        log = self.picky_post(stage)
        chance = random.Random(5)
        for number in range(6):
            before = len(log())
            self.post_map(stage, one_point(13), f"k{number}")
            while len(log()) == before:
                time.sleep(0.0005)
            time.sleep(chance.random() * 0.004)
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
        wait_until(lambda: {row["robot"] for row in stage.box.ask("GET /adit/run")[1]["aside"]} ==
                   {f"k{number}" for number in range(6)}, "each to be set aside, sooner or later")
        numbers = [row["number"] for row in stage.box.ask("GET /adit/run")[1]["aside"]]
        for number in numbers:
            self.assertEqual(stage.box.ask(f"POST /adit/aside/{number}/send", body={})[0], 200)
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
        wait_until(lambda: {row["robot"] for row in stage.box.ask("GET /adit/run")[1]["aside"]} ==
                   {f"k{number}" for number in range(6)}, "each to be refused and set aside again")

    def test_a_large_map_is_in_its_file_as_it_comes_and_leaves_none_where_it_is_cut_off(self):
        stage = self.stage(post_options=None)
        content = messages.body(messages.map_update(maps.made_cloud(100_000), "r1", time.time(), CBOR), CBOR)
        fields = {**messages.headers(CBOR), "Host": "adit", "Content-Length": len(content)}
        head = "POST /map/update HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in fields.items())

        def files():
            return sorted(path.name for path in (stage.box.state / "waiting").iterdir())

        for end in ("the sender", "the box"):
            with self.subTest(end), socket.create_connection((stage.network.box_address, programs.PORT), 20) as sender:
                sender.sendall(head.encode() + b"\r\n" + content[: len(content) // 4 * 3])
                wait_until(lambda: [name for name in files() if name.endswith(".part")], "its data to be written")
                if end == "the box":
                    stage.box.stop(signal.SIGKILL)
                    stage.restart_box()
                else:
                    sender.close()
                wait_until(lambda: not files(), "nothing to be left")
        self.post_map(stage, maps.made_cloud(100_000), "r1")
        self.assertEqual(len(files()), 1)

    def test_a_full_queue_is_told_to_the_sender(self):
        stage = self.stage(post_options=None, queues__map_bytes=1 << 20)
        refused = None
        for number in range(20):
            update = messages.map_update(maps.made_cloud(10000, seed=number), "r1", time.time(), CBOR)
            refused = messages.post(self.session, stage.box.url, "/map/update", update, CBOR)
            if refused.status_code != 200:
                break
        self.assertEqual(refused.status_code, 429)
        self.assertIn("wait already", refused.json())

    def test_networks_that_overlap_do_not_touch(self):
        stage = self.stage(team_net="10.100.1")
        self.post_map(stage, maps.made_grid(10, 10), "r1")
        wait_until(lambda: self.taken(stage, "/map/update"), "the map")
        answer = requests.get(stage.box.url + "/api/status", timeout=30, headers=messages.headers(Style()))
        self.assertEqual(answer.status_code, 200)

    def test_nothing_listens_towards_the_command_post(self):
        stage = self.stage()
        for address in (hosts.BOX_DARPA, stage.network.box_address):
            stage.network.start(stage.network.post, "ip", "route", "replace", "default", "via", hosts.BOX_DARPA).wait()
            knock = f"import socket; socket.create_connection(('{address}', {programs.PORT}), 2)"
            tried = stage.network.start(stage.network.post, "/usr/bin/python3", "-c", knock, stderr=subprocess.PIPE)
            said = tried.communicate()[1].decode()
            self.assertNotEqual(tried.returncode, 0)
            self.assertRegex(said, "refused|timed out")

    def test_silent_command_post_does_not_stop_the_teams_side(self):
        stage = self.stage(command_post__timeouts__mapping_answer_ms=60000)
        stage.post.process.send_signal(signal.SIGSTOP)
        for number in range(20):
            self.post(stage, "/state/update", pose("r1", float(number)))
            self.post_map(stage, maps.made_grid(20, 20), "r1")
        stage.post.process.send_signal(signal.SIGCONT)
        wait_until(lambda: self.taken(stage, "/map/update") and self.taken(stage, "/state/update"), "them to arrive")


def replay(scene, markers):
    """ROS's meaning of a list of markers, applied to a scene {(ns, id): x}."""
    for marker in markers:
        key = (marker["ns"], marker["id"])
        if marker["action"] == 3:
            scene.clear()
        elif marker["action"] == 2:
            scene.pop(key, None)
        else:
            scene[key] = marker["pose"]["position"]["x"]
