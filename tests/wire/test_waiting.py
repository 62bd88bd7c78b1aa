"""What waits loses nothing: a pulled cable, restarts, a silent Command Post; and networks that overlap do not touch."""

import signal
import socket
import subprocess
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


def pose(name, x):
    return {"poses": [{"name": name, "position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}


class Waiting(unittest.TestCase):
    def stage(self, **overrides):
        stage = self.enterContext(Stage(**overrides))
        self.addCleanup(lambda: self.assertEqual(stage.post.violations() if stage.post else [], []))
        self.session = requests.Session()
        return stage

    def post(self, stage, uri, message):
        answer = messages.post(self.session, stage.box.url, uri, message, CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def post_map(self, stage, source, name):
        self.post(stage, "/map/update", messages.map_update(source, name, time.time(), CBOR))

    def taken(self, stage, uri):
        return [request for request in stage.post.requests(uri) if request["status"] == 200]

    def cloud_bytes(self, stage, name):
        return sum(request["message"]["msg"]["data"]["bytes"] for request in self.taken(stage, "/map/update")
                   if request["message"]["name"] == name)

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
