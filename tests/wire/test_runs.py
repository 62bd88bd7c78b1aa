"""What a run has to show outlives the service: picture, tracks and plots after a kill, each run by itself."""

import signal
import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

CBOR = Style("cbor")
UPRIGHT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}


class Runs(unittest.TestCase):
    def stage(self, **overrides):
        stage = self.enterContext(Stage(**overrides))
        self.session = requests.Session()
        wait_until(stage.box.knows_the_run, "the run to be known")
        return stage

    def post(self, stage, uri, message):
        answer = messages.post(self.session, stage.box.url, uri, message, CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def drive(self, stage, seed=1, robots=("ugv1", "ugv2")):
        """Each robot maps and moves; until the page shows all of it."""
        for name in robots:
            self.post(stage, "/map/update", messages.map_update(maps.made_grid(120, 90, seed), name, time.time(), CBOR))
            self.post(stage, "/map/update", messages.map_update(maps.made_cloud(3000, seed), name, time.time(), CBOR))
            self.move(stage, name, 3.0 * seed)
        layers = 2 * len(robots)
        wait_until(lambda: len(self.drawn(stage)) == layers and len(self.tracks(stage)) == len(robots),
                   "all to be taken and drawn")

    def move(self, stage, name, x):
        self.post(stage, "/state/update", {"header": messages.header(time.time(), CBOR),
                                           "poses": [{"name": name, "position": {"x": x, "y": 1.0, "z": 0.0}, "orientation": UPRIGHT}]})

    def ask(self, stage, path):
        status, said = stage.box.ask(f"GET {path}")
        self.assertEqual(status, 200, said)
        return said

    def drawn(self, stage, base="/adit", at=""):
        """Each layer with the bytes of its tiles that are there."""
        found = {}
        for layer in self.ask(stage, f"{base}/map")["layers"]:
            tiles = {}
            for tile in layer["tiles"]:
                path = (f"{base}/map/{layer['kind']}/{layer['robot'] or '-'}/"
                        f"{tile['level']}/{tile['x']}/{tile['y']}.png{at}")
                answer = requests.get(f"http://{stage.box.network.box_address}:{programs.PORT}{path}", timeout=30,
                                      headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"})
                if answer.status_code == 200:
                    tiles[(tile["level"], tile["x"], tile["y"])] = answer.content
            if tiles:
                found[(layer["robot"], layer["kind"])] = tiles
        return found

    def tracks(self, stage):
        return self.ask(stage, "/adit/tracks")["tracks"]

    def wait_until_kept(self, stage):
        """The map is written, and so are tracks and plots since a robot has moved."""
        def sizes():
            return [file.stat().st_size for file in (stage.box.state / "runs").glob("*/map-*")]

        def rests():
            before = sizes()
            self.move(stage, "ugv1", time.monotonic() % 100)
            time.sleep(6)
            return before and before == sizes()
        wait_until(rests, "the map to be kept", within=120)

    def test_a_kill_takes_nothing_of_what_the_page_shows(self):
        stage = self.stage()
        self.drive(stage)
        self.wait_until_kept(stage)
        picture, tracks = self.drawn(stage), self.tracks(stage)
        plots = self.ask(stage, "/adit/history")
        self.assertGreater(len(plots["at"]), 1)
        stage.box.stop(signal.SIGKILL)
        stage.restart_box()
        wait_until(lambda: self.drawn(stage) == picture, "the picture of the life before")
        self.assertEqual(self.tracks(stage), tracks)
        again = self.ask(stage, "/adit/history")
        kept = [moment for moment in plots["at"] if moment in again["at"]]
        self.assertGreaterEqual(len(kept), len(plots["at"]) - 4)  # those of the last seconds are not on the disk yet
        self.assertEqual({robot["robot"] for robot in again["robots"]} & {"ugv1", "ugv2"}, {"ugv1", "ugv2"})
