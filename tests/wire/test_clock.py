"""A box without a battery clock: it continues from the last known time, its stamps never go back, and the operator sets its clock.
clock/source_test and admin/clock_setting_test have the rules on its sources. The real adit-clock runs, without permission to set this machine's
clock."""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import time
import unittest
from unittest import mock

import requests

import ledger_files
import maps
import messages
from alarming import reason
from programs import BIN, Stage, log_in, wait_until
from reporting import submit

DAYS = 90 * 86400.0
YEARS = 10 * 365 * 86400.0
PASSWORD = "correct horse battery"


class Ahead:
    """A simulated time of day for programs started with `env`."""

    def __init__(self, folder):
        self.file = folder / "ahead"
        self.set(0)
        library = folder / "set_clock.so"
        subprocess.run(["clang-19", "-shared", "-fPIC", "-o", library, pathlib.Path(__file__).with_name("set_clock.c"), "-lm"], check=True)
        self.env = {"LD_PRELOAD": str(library), "ADIT_CLOCK_AHEAD": str(self.file)}

    def set(self, seconds):
        """Written in place, so the programs see it at once."""
        with self.file.open("r+b" if self.file.exists() else "wb") as file:
            file.write(struct.pack("d", seconds))


class Clock(unittest.TestCase):
    def setUp(self):
        self.stage = self.enterContext(Stage())

    def set_clock(self, chip=None):
        """Runs adit-clock as its path unit does. `chip`: the time of a clock with a battery."""
        for name in ("clock", "chip"):
            (self.stage.folder / name).mkdir(exist_ok=True)
        if chip is not None:
            (self.stage.folder / "chip" / "since_epoch").write_text(f"{chip:.0f}\n")
        box = self.stage.box
        subprocess.run(["unshare", "--user", "--map-root-user", BIN / "adit-clock", "--wanted", box.state, "--status",
                        self.stage.folder / "clock", "--chip", self.stage.folder / "chip", "--chip-device",
                        self.stage.folder / "none"], check=True, timeout=30, capture_output=True)
        return json.loads((self.stage.folder / "clock" / "status.json").read_text())

    def clock(self):
        return self.stage.box.ask("GET /adit/clock")[1]

    def lose_power(self, known):
        """Boots the machine: memory is lost, and the last known time is changed."""
        self.assertEqual(self.stage.box.stop(), 0)
        shutil.rmtree(self.stage.box.state / "journal")
        ledger_files.write_stamps(self.stage.box.state / "stamps", known + 30, known)
        self.stage.restart_box()

    def post_state(self):
        """Posts a pose and returns the stamp that the Command Post got."""
        before = len(self.stage.post.requests("/state/update"))
        state = {"poses": [{"name": "R1", "position": {"x": float(before), "y": 0.0, "z": 0.0},
                            "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}],
                 "header": {"stamp": time.time(), "frame_id": "darpa"}}
        self.assertEqual(self.stage.box.ask("POST /state/update", body=state), (200, None))
        wait_until(lambda: len(self.stage.post.requests("/state/update")) > before, "the state to arrive")
        return self.stage.post.requests("/state/update")[-1]["message"]["header"]["stamp"]

    def test_time_continues_after_a_power_cut_and_stamps_never_go_back(self):
        first = self.post_state()
        self.lose_power(first + DAYS)
        self.assertGreaterEqual(self.stage.box.ask("GET /adit/run")[1]["now"], first + DAYS)
        second = self.post_state()
        self.assertGreaterEqual(second, first + DAYS + 30, "the highest stamp that may have been given out")
        alarms = wait_until(lambda: [reason(each) for each in self.stage.box.ask("GET /adit/run")[1]["alarms"] if each["id"] == "stamps"],
                            "the alarm, by the Command Post's time")
        self.assertIn("days; a factory reset", alarms[0])
        self.lose_power(first - DAYS)
        now = self.stage.box.ask("GET /adit/run")[1]["now"]
        self.assertAlmostEqual(now, time.time(), delta=60, msg="the machine's clock went on")

    def test_operators_time_is_requested_and_its_outcome_shown(self):
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


class Step(unittest.TestCase):
    """The clock is set by years, forward and back, during a run."""

    def setUp(self):
        if not shutil.which("clang-19"):
            self.skipTest("clang-19 is not here")
        self.stage = Stage()
        self.ahead = Ahead(self.stage.folder)
        self.enterContext(mock.patch.dict(os.environ, self.ahead.env))
        self.enterContext(self.stage)

    def view(self):
        return self.stage.box.ask("GET /adit/run")[1]

    def ages(self):
        """Each age on the page and its time bar, by name."""
        box, run = self.stage.box, self.view()
        times = {"run_clock": run["run_clock"] and run["now"] - run["run_clock"]["age"]}
        times |= {f"robot {row['name']}": row["at"] for row in run["robots"]}
        times |= {f"refusal {row['uri']}": row["at"] for row in run["refusals"]}
        times |= {f"alarm {row['id']}": row["since"] for row in run["alarms"]}
        for row in run["activities"]:
            for name in ("last_accepted", "last_forwarded", "behind_since"):
                times[f"{name} {row['robot']} {row['kind']}"] = row[name]
        for report in box.reports():
            times[f"report {report['number']}"] = report["received"]
        for layer in box.ask("GET /adit/map")[1]["layers"]:
            times |= {f"{name} of layer {layer['robot']}": layer[name] for name in ("first", "last")}
        for track in box.ask("GET /adit/tracks")[1]["tracks"]:
            times[f"track {track['robot']}"] = track["poses"][0][0]
        for marker in box.ask("GET /adit/markers?since=0")[1]["markers"]:
            times[f"marker {marker['id']}"] = marker["at"]
        for run in box.ask("GET /adit/runs")[1]["runs"]:
            times |= {f"{name} of run {run['key']}": run[name] for name in ("began", "last") if run["is_present"]}
        times |= {f"plot {i}": at for i, at in enumerate(box.ask("GET /adit/history")[1]["at"][:1])}
        times |= {f"session {i}": row["seen"] for i, row in enumerate(box.ask("GET /adit/sessions")[1])}
        return {name: self.view()["now"] - at for name, at in times.items() if at is not None}

    def test_ages_sessions_and_ledger_survive_a_clock_step(self):
        box = self.stage.box
        box.ask("POST /adit/password", body={"role": "operator", "code": self.code(), "password": PASSWORD}, token=None)
        session = log_in(box, PASSWORD)
        self.assertEqual(box.ask("POST /adit/runs", body={})[0], 200)
        self.assertEqual(submit(self.stage).status_code, 201)
        post = requests.Session()
        style = messages.Style()
        pose = {"name": "r1", "position": {"x": 4.0, "y": 0.0, "z": 0.0}, "orientation": maps.IDENTITY}
        messages.post(post, box.url, "/state/update", {"poses": [pose]}, style)
        messages.post(post, box.url, "/map/update", messages.map_update(maps.made_grid(20, 20), "r1", time.time(), style), style)
        messages.post(post, box.url, "/state/update", {"poses": 7}, style)
        wait_until(lambda: len(self.ages()) > 8 and "first of layer r1" in self.ages(), "all of it to be shown")
        shown, stored = set(self.ages()), box.on_disk("received")
        for ahead in (YEARS, -YEARS, 0.0):
            self.ahead.set(ahead)
            wait_until(lambda ahead=ahead: abs(self.view()["now"] - time.time() - ahead) < 60, "the step to be seen")
            ages = self.ages()
            self.assertLessEqual(shown - {"plot 0"}, set(ages))
            for name, age in ages.items():
                self.assertTrue(-5 < age < 600, f"{name}: {age:.0f} s ago, with the clock {ahead:.0f} s ahead")
            self.assertEqual(box.ask("GET /adit/session", session, token=None)[1]["role"], "operator")
            self.assertEqual(box.on_disk("received"), stored)
            self.assertEqual(submit(self.stage).status_code, 201, "the same report: it is known")
        self.ahead.set(-YEARS)
        wait_until(lambda: abs(self.view()["now"] - time.time() + YEARS) < 60, "the step to be seen")
        self.assertEqual(box.stop(), 0)
        self.stage.restart_box()
        wait_until(lambda: "first of layer r1" in self.ages(), "the picture to go on")
        for name, age in self.ages().items():
            self.assertTrue(-5 < age < 600, f"{name}: {age:.0f} s ago, after a restart")
        self.assertEqual(self.stage.box.ask("GET /adit/session", session, token=None)[1]["role"], "operator")

    def code(self):
        return self.stage.box.output().split("code=")[1].split()[0].strip('"')
