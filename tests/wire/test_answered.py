"""A message that was answered 200 arrives. The service is stopped, killed, or a setting is saved exactly at an answer, while five
robots send grids, clouds, states, markers and reports as fast as possible. ADIT_ENDS sets the number of repetitions; counts are
printed."""

import base64
import collections
import contextlib
import dataclasses
import gzip
import json
import os
import random
import signal
import threading
import unittest
import zlib

import requests

import maps
import messages
from messages import Style
from programs import Stage, wait_until

ENDS = int(os.environ.get("ADIT_ENDS", "12"))  # in all, a third of each kind
SEED = 20210921
ROBOTS = 5
CELLS = 2500  # a side
GROWN = CELLS + 1  # rows of the same robot's next grid, which covers the one before
POINTS = 16_000_000 // 12
JSON, CBOR, PACKED = Style(), Style("cbor"), Style(body="gzip")
FINITE = bytes(range(64)) * 4  # what makes any bytes numbers that are finite
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}


def said_of(data):
    """The identity of a map's data in the Command Post's transcript."""
    return len(data), zlib.crc32(data)


class Bodies:
    """The bytes of the large maps, made once; only the name differs."""

    def __init__(self):
        grown = maps.made_grid(CELLS, GROWN)
        self.grids = [self.parts_of(dataclasses.replace(grown, height=rows, cells=grown.cells[: CELLS * rows]))
                      for rows in (CELLS, GROWN)]
        self.points = random.Random(SEED).randbytes(12 * 1000).translate(FINITE) * (POINTS // 1000)
        self.cloud = messages.map_update(maps.Cloud("large", maps.XYZ, 12, b""), "NAME", 1.0, CBOR)

    @staticmethod
    def parts_of(grid):
        """The message without its cells, its cells, and the identity of the data that must arrive."""
        message = messages.map_update(grid, "NAME", 1.0, JSON)
        message["msg"]["data"] = "DATA"
        return json.dumps(message), base64.b64encode(grid.data).decode(), said_of(grid.data)

    def grids_of(self, name):
        """The posts of a robot: its grid, and then a grid that covers it."""
        return [(name, gzip.compress(message.replace("NAME", name).replace("DATA", cells).encode(), 1), PACKED, data)
                for message, cells, data in self.grids]

    def cloud_of(self, name):
        """A cloud with unique points: every thousandth point differs from those of all other clouds."""
        own = random.Random(name).randbytes(12).translate(FINITE)
        points = bytearray(self.points)
        for byte in range(12):
            points[byte::12000] = own[byte:byte + 1] * (len(points) // 12000)
        data = bytes(points)
        return name, messages.body({**self.cloud, "name": name, "msg": {**self.cloud["msg"], "data": data}}, CBOR), CBOR, \
            said_of(data)


class Round:
    """The messages of the robots during one process of the service, and those that were answered 200."""

    def __init__(self, stage, number, bodies):
        self.stage, self.number = stage, number
        self.accepted = {"map": {}, "state": {}, "markers": {}, "report": {}}
        self.odd, self.lock, self.answers, self.over = [], threading.Lock(), threading.Semaphore(0), threading.Event()
        self.plans = []
        for robot in range(ROBOTS):
            made = bodies.grids_of(f"g{number}x{robot}")
            cloud = [bodies.cloud_of(f"c{number}x{robot}")] if robot < 2 else []
            self.plans.append(cloud + made if robot == 1 else made + cloud)
        self.threads = [threading.Thread(target=self.send_maps, args=(plan,), daemon=True) for plan in self.plans]
        self.threads += [threading.Thread(target=self.send_news, args=(robot,), daemon=True) for robot in range(ROBOTS)]
        self.threads.append(threading.Thread(target=self.send_reports, daemon=True))

    def post(self, session, uri, content, style):
        """The status; None without an answer."""
        try:
            answer = session.post(self.stage.box.url + uri, data=content, headers=messages.headers(style), timeout=30)
        except requests.RequestException:
            return None
        if answer.status_code not in (200, 201, 503):
            self.odd.append((uri, answer.status_code, answer.text))
        return answer.status_code

    def send_maps(self, plan):
        with requests.Session() as session:
            for name, content, style, data in plan:
                if self.post(session, "/map/update", content, style) == 200:
                    with self.lock:
                        self.accepted["map"][name] = data
                    self.answers.release()

    def send_news(self, robot):
        with requests.Session() as session:
            for step in range(1, 10_000):
                if self.over.is_set():
                    return
                x = self.number * 10_000.0 + step
                state = {"poses": [{"name": f"r{robot}", "position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}
                if self.post(session, "/state/update", messages.body(state, JSON), JSON) == 200:
                    self.accepted["state"][f"r{robot}"] = x
                marker = {"ns": f"r{robot}", "id": step % 7, "type": 2, "action": 0,
                          "pose": {"position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": TURNED},
                          "scale": {"x": 1, "y": 1, "z": 1}, "color": {"r": 1, "g": 1, "b": 1, "a": 1}}
                if self.post(session, "/markers/update", messages.body({"markers": [marker]}, JSON), JSON) == 200:
                    self.accepted["markers"][f"r{robot}", step % 7] = x
                self.over.wait(0.02)

    def send_reports(self):
        with requests.Session() as session:
            for step in range(1, 100):
                if self.over.is_set():
                    return
                x = self.number * 100.0 + step
                report = {"x": x, "y": 2.5, "z": 0.25, "type": "Backpack"}
                if self.post(session, "/api/artifact_reports", json.dumps(report), JSON) in (200, 201):
                    self.accepted["report"][x] = 1

    def go(self, answers, end):
        """Ends the service after that many answers to maps."""
        for thread in self.threads:
            thread.start()
        for _ in range(answers):
            self.answers.acquire(timeout=60)
        end()
        self.over.set()
        for thread in self.threads:
            thread.join(60)


class Answered(unittest.TestCase):
    def setUp(self):
        self.stage, self.bodies = self.enterContext(Stage(command_post__arrange_clouds=False)), Bodies()
        self.arrived = {"map": {}, "state": {}, "markers": {}, "report": {}}

    def killed(self):
        self.stage.box.stop(signal.SIGKILL)

    def stopped(self):
        self.stage.box.stop()

    def saved(self):
        held = self.stage.box.ask("GET /adit/settings")[1]
        settings = held["settings"]
        settings["reports"] = {"near_metres": 3 + settings.get("reports", {}).get("near_metres", 5) % 5}
        status, said = self.stage.box.ask("POST /adit/settings", body={"settings": settings, "base": held["tag"]})
        self.assertEqual(status, 200, said)

    def look(self):
        """The messages that the Command Post has accepted so far."""
        for request in self.stage.post.requests():
            if request["status"] != 200:
                continue
            message = request.get("message")
            if request["uri"] == "/map/update":
                data = message["msg"]["data"]
                self.arrived["map"][message["name"]] = data["bytes"], data["crc32"]
            elif request["uri"] == "/state/update":
                self.arrived["state"].update({pose["name"]: pose["position"]["x"] for pose in message["poses"]})
            elif request["uri"] == "/markers/update":
                self.arrived["markers"].update({(marker["ns"], marker["id"]): marker["pose"]["position"]["x"]
                                                for marker in message["markers"]})
        self.arrived["report"] = collections.Counter(made["x"] for made in self.stage.post.recorded())

    def lost(self, kind, accepted):
        """For each name, the newest answered message or a newer one must have arrived; a map byte for byte."""
        if kind == "map":
            return {name: data for name, data in accepted.items() if not self.has_map(name, data)}
        return {name: value for name, value in accepted.items() if self.arrived[kind].get(name, -1) < value}

    def has_map(self, name, data):
        """The map, or the larger grid that its robot sent after it without an answer."""
        arrived = self.arrived["map"].get(name, (0, 0))
        return arrived == data or (name.startswith("g") and arrived == self.bodies.grids[-1][-1])

    def all_there(self, accepted):
        self.look()
        return not any(self.lost(kind, those) for kind, those in accepted.items())

    def test_answered_messages_survive_each_kind_of_end(self):
        chance, bodies = random.Random(SEED), self.bodies
        counts = dict.fromkeys(("map", "state", "markers", "report"), 0)
        losses = []
        for number in range(ENDS):
            end = (self.stopped, self.killed, self.saved)[number % 3]
            life = Round(self.stage, number, bodies)
            life.go(1 if number % 2 else chance.randint(2, 5), end)
            if self.stage.box.process.poll() is not None:
                self.stage.restart_box()
            with contextlib.suppress(AssertionError):
                wait_until(lambda life=life: self.all_there(life.accepted), "what was answered to arrive", within=60)
            for kind, those in life.accepted.items():
                counts[kind] += len(those)
                if lost := self.lost(kind, those):
                    losses.append((number, end.__name__, kind, lost))
            self.assertEqual(life.odd, [])
        doubled = [x for x, times in self.arrived["report"].items() if times > 1]
        print(f"\n{ENDS} ends at an answer: {counts['map']} maps, the newest of {counts['state']} states and",
              f"{counts['markers']} markers, and {counts['report']} reports were answered;",
              f"{sum(len(lost) for *_, lost in losses)} lost, {len(doubled)} reports doubled", flush=True)
        self.assertEqual((losses, doubled), ([], []))
        self.assertGreater(counts["map"], ENDS)
