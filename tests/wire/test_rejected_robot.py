"""A Command Post that rejects the states of one robot, which it does not know."""

import time
import unittest

import requests

import maps
import messages
from messages import Style
from programs import wait_until
from python_post import stage_of

CBOR = Style("cbor")
SECONDS = 15


def names_in(state):
    return [pose["name"] for pose in state["poses"]]


class TestRejectedRobot(unittest.TestCase):
    def post_states(self, stage, x):
        for name in ("uav1", "ugv1", "ugv2"):
            state = {"poses": [{"name": name, "position": {"x": float(x), "y": 0.0, "z": 0.0}, "orientation": dict(maps.IDENTITY)}]}
            self.assertEqual(messages.post(self.session, stage.box.url, "/state/update", state, CBOR).status_code, 200)

    def row(self, stage, robot):
        rows = stage.box.ask("GET /adit/run")[1]["activities"]
        return next(row for row in rows if row["robot"] == robot and row["kind"] == "state")

    def test_other_robots_go_on(self):
        stage, post = stage_of(self)
        self.session = requests.Session()
        post.rejects = lambda path, message: 403 if path == "/state/update" and "uav1" in names_in(message) else 0
        for number in range(SECONDS):
            self.post_states(stage, number)
            time.sleep(1)
        states = post.messages("/state/update")
        print(f"in {SECONDS} s: {len(states)} states were accepted")
        self.assertGreater(len(states), SECONDS / 3)
        for robot in ("ugv1", "ugv2"):
            self.assertTrue(any(robot in names_in(state) for state in states), robot)
        self.assertNotIn("command_post_refusing", str(stage.box.alarms()))
        row = self.row(stage, "uav1")
        self.assertEqual(row["last_status"], 403)
        self.assertIn("other robots' states are accepted", row["last_sentence"])
        post.rejects = lambda path, message: 0
        wait_until(lambda: any("uav1" in names_in(state) for state in post.messages("/state/update")), "the robot's pose", within=70)


if __name__ == "__main__":
    unittest.main()
