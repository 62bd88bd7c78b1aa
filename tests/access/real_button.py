"""The button and the lights of the real program, with a simulated panel: real_button.py ADITD. On loopback."""

import json
import os
import re
import tempfile
import time
import unittest

import real_aditd
from real_aditd import OPERATOR, Box, wait_until

REPORT = {"x": 1.0, "y": 2.0, "z": 3.0, "type": "Drill"}
NEW = "a password set at the box"


class Button(unittest.TestCase):
    token = real_aditd.TOKENS["team"]

    def start_box(self, first=True, **options):
        folder = self.enterContext(tempfile.TemporaryDirectory(prefix="adit-button-"))
        self.box = Box(folder, **options)
        self.addCleanup(lambda: self.box.process.wait())
        self.addCleanup(lambda: self.box.process.kill())
        if first:
            self.assertEqual(self.box.set_first()[0], 200)
            self.me = self.box.log_in()
        return self.box

    def write(self, text):
        file = os.open(self.box.state / "panel.button", os.O_WRONLY | os.O_NONBLOCK)
        try:
            os.write(file, text)
        finally:
            os.close(file)

    def hold(self, pattern):
        """Presses until all lights have this pattern: "on" after 3 s, "rush" after 6."""
        self.write(b"press\n")
        wait_until(lambda: set(self.patterns().values()) == {pattern}, f"all lights to be {pattern}")
        self.write(b"release\n")

    def listening(self):
        return re.findall(r"listening .*port=(\d+)", self.box.output())

    def await_restart(self, before):
        """Waits until aditd listens again, at any port."""
        self.box.port = int(wait_until(lambda: self.listening()[before:], "it to restart")[-1])

    def run_view(self):
        status, view, _ = self.box.ask("GET /adit/run", Authorization="Bearer " + self.token)
        self.assertEqual(status, 200)
        return view

    def patterns(self):
        return {light["name"]: light["pattern"] for light in self.run_view()["lights"]}

    def lit(self):
        return [line.split()[1] for line in (self.box.state / "panel").read_text().splitlines()]

    def is_open(self):
        return self.box.ask("GET /adit/session")[1]["set_up_open"]

    def set_password(self, password=NEW):
        return self.box.ask("POST /adit/password", {"role": "operator", "password": password})[0]

    def test_press_of_three_seconds_opens_set_up(self):
        box = self.start_box()
        self.write(b"press\n")
        time.sleep(2.8)
        self.assertFalse(self.is_open())
        self.assertEqual(self.set_password(), 401, "nobody stands at the box")
        wait_until(lambda: set(self.patterns().values()) == {"on"}, "all lights to be lit")
        self.assertEqual(self.lit(), ["on"] * 4)
        self.write(b"release\n")
        wait_until(self.is_open, "set-up to be open")
        view = self.run_view()
        self.assertTrue(570 < view["setup_open_until"] - view["now"] <= 600.1, view)
        self.assertEqual(self.patterns(), {"health": "off", "scoring": "off", "mapping": "off", "attention": "digits"})
        self.assertIn("the lights show the address address=127.0.0.1", box.output())

        self.assertEqual(box.ask("GET /adit/sessions", **self.me)[0], 200, "nothing has changed yet")
        self.assertEqual(box.log_in().keys(), self.me.keys())
        for body in ({"role": "viewer", "password": NEW}, {"role": "operator", "current": "x", "password": NEW}):
            self.assertEqual(box.ask("POST /adit/password", body)[0], 401)
        self.assertEqual(box.ask("POST /adit/reset", {"password": NEW})[0], 401)
        self.assertEqual(box.ask("POST /adit/password", {"role": "operator", "password": NEW},
                                 Origin="http://elsewhere.example")[0], 403)

        self.assertEqual(self.set_password(), 200)
        self.assertFalse(self.is_open())
        self.assertIsNone(self.run_view()["setup_open_until"])
        self.assertEqual(self.set_password("another password still"), 401, "it is good once")
        self.assertEqual(box.ask("GET /adit/sessions", **self.me)[0], 401)
        self.assertEqual(box.ask("POST /adit/login", {"password": OPERATOR})[0], 403)
        box.log_in(NEW)
        wait_until(lambda: "set-up is closed" in box.output(), "that to be logged")
        self.assertIn("set-up opened at the box", box.output())
        self.assertNotIn(NEW, box.output())

    def test_press_of_ten_seconds_resets_all_but_the_reports(self):
        box = self.start_box()
        self.assertEqual(box.ask("POST /adit/reports", REPORT, **self.me)[0], 202)
        self.assertEqual(box.ask("POST /adit/tokens", {"name": "team", "token": "team-from-the-page"}, **self.me)[0], 200)
        self.token = "team-from-the-page"
        wait_until(lambda: self.box.ask("GET /adit/run", Authorization="Bearer " + self.token)[0] == 200, "it to be applied")
        self.hold("rush")
        wait_until(lambda: "rush" not in self.patterns().values(), "the warning to end")
        self.assertFalse(self.is_open(), "who lets go at the warning wants out")
        self.assertTrue((box.state / "secrets" / "team.token").exists())
        pressed = time.monotonic()
        self.write(b"press\n")
        self.await_restart(1)
        self.assertGreater(time.monotonic() - pressed, 10)
        self.assertEqual(box.ask("GET /adit/session")[1]["first_start"], True)
        for gone in ("settings.json", "settings.json.copy", "secrets", "access.json", "access.json.copy"):
            self.assertFalse((box.state / gone).exists(), gone)
        self.assertEqual(box.ask("GET /adit/sessions", **self.me)[0], 401)
        self.assertIn("button held: factory reset", box.output())
        self.assertEqual(box.set_first(password=NEW)[0], 200)
        report, = box.ask("GET /adit/reports", **box.log_in(NEW))[1]
        self.assertEqual(report["type"], "Drill")
