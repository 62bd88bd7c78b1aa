"""Whatever ends a life of the service (a kill, a stop) or changes what it runs with (saved settings, another course), the
Command Post sees none of it: no URI is asked sooner than its rate allows, and stamps go on as their sender spaces them, also
of one who runs ahead."""

import itertools
import shutil
import signal
import time
import unittest

import requests

import hosts
import messages
from messages import Style
from programs import PORT, CommandPost, Stage, wait_until
from test_disk import Filler

CBOR = Style("cbor")
AHEAD = 4.0  # seconds by which the robot's stamps run ahead after the first
STEP = 0.05  # between two posts
RATE = 1.0  # a second
JITTER = 0.25  # seconds that a busy machine may be late with a request, and not with the next


def setUpModule():
    hosts.needs_namespaces()


class Robot:
    """Says its own clock with each pose: what the Command Post sees of both must stay as far apart."""

    def __init__(self, stage):
        self.stage, self.session = stage, requests.Session()
        self.began = time.monotonic()
        self.posted = []

    def posts(self, seconds):
        """For so long; posts that nobody answers are left."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                self.post()
            except requests.RequestException:
                self.session = requests.Session()
            time.sleep(STEP)

    def post(self):
        clock = 5000 + time.monotonic() - self.began + (AHEAD if self.posted else 0)
        message = {"header": {"stamp": clock}, "poses": [
            {"name": "r1", "position": {"x": clock, "y": 0.0, "z": 0.0},
             "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}]}
        answer = messages.post(self.session, self.stage.box.url, "/state/update", message, CBOR)
        if answer.status_code == 200:
            self.posted.append(clock)
        return answer


class AnyEnd(unittest.TestCase):
    def setUp(self):
        rates = {f"command_post__rates__{kind}_hz": RATE for kind in ("state", "status")}
        post = {"scoring": {"address": hosts.SCORING, "port": PORT}, "mapping": {"address": hosts.MAPPING, "port": PORT}}
        self.stage = self.enterContext(Stage(courses=[{"name": "A", **post}, {"name": "B", **post}], **rates))
        self.robot = Robot(self.stage)

    def killed(self):
        self.stage.box.stop(signal.SIGKILL)
        self.stage.restart_box()

    def stopped(self):
        self.stage.box.stop()
        self.stage.restart_box()

    def saved(self):
        def nearer(settings):
            settings["reports"] = {"near_metres": 3 + settings.get("reports", {}).get("near_metres", 5)}

        self.stage.box.save(nearer)

    def switched(self):
        self.stage.box.apply("POST /adit/course", {"name": "B"})

    def test_is_not_seen_upstream(self):
        self.robot.posts(2.5)
        for ends in (self.killed, self.saved, self.stopped, self.switched, self.killed):
            ends()
            self.robot.posts(1.5)
        last = self.robot.posted[-1]

        def sent():
            return [request for request in self.stage.post.requests("/state/update") if request["status"] == 200]

        def clock(request):
            return request["message"]["poses"][0]["position"]["x"]

        wait_until(lambda: sent() and clock(sent()[-1]) == last, "the last pose that was answered")
        states = sent()
        stamps = [request["message"]["header"]["stamp"] for request in states]
        self.assertEqual(stamps, sorted(stamps))
        apart = [stamp - clock(request) for request, stamp in zip(states, stamps)]
        self.assertLess(max(apart) - min(apart), 0.001, "as far apart as the robot's own")
        for uri in ("/state/update", "/api/status"):
            asked = [request["at"] for request in self.stage.post.requests(uri)]
            self.assertGreater(len(asked), 3)
            self.assertGreater(min(later - earlier for earlier, later in itertools.pairwise(asked)), 1 / RATE - JITTER, uri)
        self.assertEqual(self.stage.post.violations(), [])

    def test_stamps_go_on_after_a_power_cut_that_took_the_clock(self):
        floor = self.stage.box.state / "stamps"
        self.robot.posts(0.2)
        wait_until(floor.exists, "what it is to be known by")
        self.stage.box.stop(signal.SIGKILL)
        shutil.rmtree(self.stage.box.state / "journal")  # as the memory that it is in is
        self.assertGreater(float(floor.read_text()), time.time() + AHEAD)
        ahead = time.time() + 3600  # the box's clock is behind what it was
        floor.write_text(f"{ahead}\n")
        sent = len(self.stage.post.requests("/state/update"))
        self.stage.restart_box()
        self.robot.posts(0.2)
        wait_until(lambda: len(self.stage.post.requests("/state/update")) > sent, "a pose")
        self.assertGreaterEqual(self.stage.post.requests("/state/update")[-1]["message"]["header"]["stamp"], ahead)


class NoRoom(unittest.TestCase):
    def test_telemetry_that_cannot_be_kept_is_not_taken(self):
        with Stage(post_options=None, disk="6m") as stage:
            robot = Robot(stage)
            robot.posts(0.2)
            filler = Filler(stage.box.state)
            refused = self.until_refused(stage, robot)
            self.assertEqual(refused.status_code, 503)
            self.assertIn("cannot be kept", refused.json())
            self.assertIn("states and markers are not taken", stage.box.attention())
            stage.box.stop(signal.SIGKILL)
            filler.make_room()
            stage.post = CommandPost(stage.network, stage.folder, "--rate", "0")
            stage.restart_box()
            wait_until(lambda: stage.post.requests("/state/update"), "what was answered")
            sent = stage.post.requests("/state/update")[0]["message"]["poses"][0]["position"]["x"]
            self.assertEqual(sent, robot.posted[-1], "and nothing that was not")
            robot.posts(0.2)
            self.assertGreater(robot.posted[-1], sent)

    def until_refused(self, stage, robot):
        for _ in range(500):
            answer = robot.post()
            if answer.status_code != 200:
                return answer
        raise AssertionError("the disk is full, and all was taken")


if __name__ == "__main__":
    unittest.main()
