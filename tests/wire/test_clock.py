"""A box without a clock of its own: it goes on from the last time known, its stamps never go back, and its clock is set on a
word of the operator. adit-clock is the real one, without the right to set this machine's clock."""

import json
import shutil
import subprocess
import time
import unittest

import hosts
from programs import BIN, Stage, wait_until

DAYS = 90 * 86400.0


def setUpModule():
    hosts.needs_namespaces()


class Clock(unittest.TestCase):
    def setUp(self):
        self.stage = self.enterContext(Stage())

    def set_clock(self):
        """adit-clock, as its path unit would start it."""
        (self.stage.folder / "clock").mkdir(exist_ok=True)
        box = self.stage.box
        subprocess.run(["unshare", "--user", "--map-root-user", BIN / "adit-clock", "--wanted", box.state, "--status",
                        self.stage.folder / "clock", "--chip", self.stage.folder / "none", "--chip-device",
                        self.stage.folder / "none"], check=True, timeout=30, capture_output=True)
        return json.loads((self.stage.folder / "clock" / "status.json").read_text())

    def clock(self):
        return self.stage.box.ask("GET /adit/clock")[1]

    def lose_power(self, known):
        """The machine starts again, in memory there is nothing, and the last time known is another than it has."""
        self.assertEqual(self.stage.box.stop(), 0)
        shutil.rmtree(self.stage.box.state / "journal")
        (self.stage.box.state / "stamps").write_text(f"{known + 30:.6f}\n{known:.6f}\n")
        self.stage.restart_box()

    def post_state(self):
        """The stamp that the Command Post got."""
        before = len(self.stage.post.requests("/state/update"))
        state = {"poses": [{"name": "R1", "position": {"x": float(before), "y": 0.0, "z": 0.0},
                            "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}],
                 "header": {"stamp": time.time(), "frame_id": "darpa"}}
        self.assertEqual(self.stage.box.ask("POST /state/update", body=state), (200, None))
        wait_until(lambda: len(self.stage.post.requests("/state/update")) > before, "the state to arrive")
        return self.stage.post.requests("/state/update")[-1]["message"]["header"]["stamp"]

    def test_goes_on_from_the_last_time_known_and_no_stamp_goes_back(self):
        first = self.post_state()
        self.lose_power(first + DAYS)
        self.assertGreaterEqual(self.stage.box.ask("GET /adit/run")[1]["now"], first + DAYS)
        second = self.post_state()
        self.assertGreaterEqual(second, first + DAYS + 30, "the highest stamp that may have been given out")
        self.lose_power(first - DAYS)
        now = self.stage.box.ask("GET /adit/run")[1]["now"]
        self.assertAlmostEqual(now, time.time(), delta=60, msg="the machine's clock went on")

    def test_leaves_the_clock_alone_where_adit_clock_does_not_run(self):
        clock = self.clock()
        self.assertFalse(clock["managed"])
        self.assertIn("adit-clock", clock["why"])
        self.assertEqual(self.stage.box.ask("POST /adit/clock", body={"time": time.time()})[0], 409)
        self.assertFalse((self.stage.box.state / "clock.json").exists())

    def test_asks_for_the_operators_time_and_tells_what_became_of_it(self):
        self.assertEqual(self.set_clock()["source"], "none")
        wait_until(lambda: self.clock()["managed"], "adit-clock to be known")
        alarms = {alarm["id"] for alarm in self.stage.box.ask("GET /adit/run")[1]["alarms"]}
        self.assertIn("time_not_set", alarms)
        asked = time.time() + DAYS
        self.assertEqual(self.stage.box.ask("POST /adit/clock", body={"time": asked})[0], 200)
        request = json.loads((self.stage.box.state / "clock.json").read_text())
        self.assertEqual((request["time"], request["source"]), (asked, "operator"))
        self.assertIn("not permitted", self.set_clock()["refusal"])
        self.assertFalse((self.stage.box.state / "clock.json").exists())
        wait_until(lambda: "not permitted" in self.clock()["refusal"], "the refusal to be told")

    def test_names_the_field_of_a_time_that_no_box_has(self):
        self.set_clock()
        wait_until(lambda: self.clock()["managed"], "adit-clock to be known")
        for wrong in (0, 5e9, "now"):
            status, said = self.stage.box.ask("POST /adit/clock", body={"time": wrong})
            self.assertEqual(status, 422, said)
            self.assertIn("time", said)


if __name__ == "__main__":
    unittest.main()
