"""Checks an alarm on the real programs: in /adit/run, /metrics, `adit status` and the lights, with its text and its side; and its
end."""

import os
import pathlib
import subprocess
import threading
import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until
from reporting import QUICK, began

CBOR = Style("cbor")
EXIT = {"bad": 1, "ask": 1, "wait": 0}


class Robot(threading.Thread):
    """A robot that posts its pose a few times a second until it is silenced."""

    def __init__(self, stage, name):
        super().__init__(daemon=True)
        self.stage, self.name, self.over, self.told = stage, name, threading.Event(), 0
        self.start()

    def run(self):
        session = requests.Session()
        while not self.over.wait(0.3):
            pose = {"name": self.name, "position": {"x": float(self.told), "y": 0.0, "z": 0.0},
                    "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
            messages.post(session, self.stage.box.url, "/state/update", {"poses": [pose]}, CBOR)
            self.told += 1

    def quiet(self):
        self.over.set()
        self.join(30)


def reason(alarm):
    """The whole reason of an alarm."""
    return alarm["details"] or alarm["why"]


class WithAlarms(unittest.TestCase):
    def stage(self, **overrides):
        return began(self.enterContext(Stage(**{**QUICK, **overrides})))

    def robot(self, stage, name):
        robot = Robot(stage, name)
        self.addCleanup(robot.quiet)
        return robot

    def send_map(self, stage, name, seed=1, points=100):
        return messages.post(requests.Session(), stage.box.url, "/map/update",
                             messages.map_update(maps.made_cloud(points, seed=seed), name, time.time(), CBOR), CBOR)

    def view(self, stage):
        return stage.box.ask("GET /adit/run")[1]

    def alarm(self, stage, name):
        return next((alarm for alarm in self.view(stage)["alarms"] if alarm["id"] == name), None)

    def metrics(self, stage):
        return requests.get(stage.box.url + "/metrics", timeout=30,
                            headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"}).text

    def status(self, stage):
        """The output of `adit status`, and its exit status."""
        done = subprocess.run([programs.BIN / "adit", "status", "--at", f"{stage.network.box_address}:{programs.PORT}",
                               "--token-file", stage.folder / "secrets/team.token"], capture_output=True, text=True, check=False)
        return done.stdout, done.returncode

    def light(self, stage, name="attention"):
        return next(light["pattern"] for light in self.view(stage)["lights"] if light["name"] == name)

    def blinks(self, stage, name):
        """The light in the simulated panel blinked."""
        panel = pathlib.Path(os.environ.get("RUNTIME_DIRECTORY", stage.box.state), "panel")
        for word in ("off", "on"):
            wait_until(lambda word=word: panel.exists() and f"{name} {word}\n" in panel.read_text(), f"the {name} light to be {word}")

    def sees(self, stage, name, severity, side, why="", light=None, within=60, panel=True):
        """Waits for the alarm, with the same text everywhere. `light`: a light that blinks beside attention. `panel`: its file can be
        written."""
        wanted = {"severity": severity, "side": side}
        alarm = wait_until(lambda: (found := self.alarm(stage, name)) and {**found, **wanted} == found and found, name, within)
        self.assertIn(why, reason(alarm))
        self.assertIn(f'adit_alarm{{id="{name}",severity="{severity}",side="{side}"}} 1\n', self.metrics(stage))
        text, status = self.status(stage)
        self.assertIn(alarm["what"], text)
        self.assertGreaterEqual(status, EXIT[severity], text)
        wait_until(lambda: self.view(stage)["now"] - self.alarm(stage, name)["since"] > 1.5, "it to last")
        if severity != "wait":
            wait_until(lambda: self.light(stage) == "fast", "the attention light")
            if panel:
                self.blinks(stage, "attention")
        if light:
            wait_until(lambda: self.light(stage, light) == "fast", f"the {light} light")
            self.blinks(stage, light)
        return alarm

    def goes(self, stage, name, within=60):
        """Waits until the alarm is only in the list of past alarms."""
        wait_until(lambda: not self.alarm(stage, name), f"the end of {name}", within)
        wait_until(lambda: any(over["id"] == name for over in self.view(stage)["alarms_over"]), "it to be remembered")
        self.assertNotIn(f'id="{name}"', self.metrics(stage))
        if not self.view(stage)["alarms"]:
            self.assertEqual(self.status(stage)[1], 0)
            wait_until(lambda: self.light(stage) == "off", "the attention light to be dark")
