#!/usr/bin/python3
"""adit-lights, which sets the lights while aditd does not run: real_lights.py ADIT_LIGHTS. With a simulated panel."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

NOWHERE = {"address": "127.0.0.1", "port": 9}
DARK = {"health": False, "scoring": False, "mapping": False, "attention": False}
program = None


class Lights(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-lights-")))
        self.panel, self.settings, self.board = (self.folder / name for name in ("panel", "settings.json", "board.json"))
        self.write_settings()
        self.panel.write_text("health on\nscoring on\nmapping on\nattention off\n")  # what a killed aditd left

    def write_settings(self, **panel):
        self.settings.write_text(json.dumps({
            "version": 1, "command_post": {"scoring": NOWHERE, "mapping": NOWHERE},
            "team": {"listen": [{"address": "127.0.0.1", "port": 0}]}, "panel": panel}))

    def begin(self, *words, result=None, settings=None):
        environment = {name: value for name, value in os.environ.items() if name != "SERVICE_RESULT"}
        if result:
            environment["SERVICE_RESULT"] = result
        process = subprocess.Popen([program, *words, "--board", self.board, "--settings", settings or self.settings,
                                    "--simulated", self.panel], env=environment, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def ends(self, process, code=0, within=60):
        _, said = process.communicate(timeout=within)
        self.assertEqual(process.returncode, code, said)
        return said

    def lit(self):
        return {name: state == "on" for name, state in map(str.split, self.panel.read_text().splitlines())}

    def health_over(self, seconds):
        """What the health light showed, each 10 ms; all others are dark."""
        seen, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            lit = self.lit()
            self.assertEqual({**lit, "health": False}, DARK)
            seen.append(lit["health"])
            time.sleep(0.01)
        return seen

    def await_fault(self, process):
        end = time.monotonic() + 30
        while time.monotonic() < end:
            self.assertIsNone(process.poll())
            if not self.lit()["scoring"]:
                return
            time.sleep(0.01)
        self.fail("no fault within 30 s")

    def test_makes_all_dark_at_once(self):
        self.ends(self.begin("dark"))
        self.assertEqual(self.lit(), DARK)

    def test_blinks_health_alone_at_one_hertz_until_it_is_ended_and_leaves_it_dark(self):
        process = self.begin("fault")
        self.await_fault(process)
        for _ in range(10):  # a machine that does much besides may sleep through a flash
            seen = self.health_over(2.5)
            turns = sum(before != after for before, after in zip(seen, seen[1:]))
            if turns in (4, 5):
                break
        self.assertIn(turns, (4, 5), seen)
        process.send_signal(signal.SIGTERM)
        self.ends(process)
        self.assertEqual(self.lit(), DARK)

    def test_ends_by_itself_after_so_many_seconds(self):
        began = time.monotonic()
        self.ends(self.begin("fault", "--seconds", "1"))
        self.assertGreater(time.monotonic() - began, 0.9)
        self.assertEqual(self.lit(), DARK)

    def test_after_a_service_tells_a_death_from_a_stop(self):
        process = self.begin("ended", "--seconds", "2", result="signal")
        self.await_fault(process)
        seen = []
        while process.poll() is None:
            seen += self.health_over(0.1)
        self.assertIn(True, seen)
        self.ends(process)
        self.assertEqual(self.lit(), DARK)
        for result in ("success", None):
            began = time.monotonic()
            self.ends(self.begin("ended", "--seconds", "50", result=result))
            self.assertLess(time.monotonic() - began, 40)

    def test_the_boards_panel_counts_before_the_settings(self):
        self.board.write_text('{"name": "b", "title": "B", "panel": {"chip": "no-such-chip", "health": "H"}}')
        said = self.ends(self.begin("dark"), code=1)
        self.assertIn("panel: chip no-such-chip: No such file or directory", said)

    def test_says_what_is_wrong_with_a_board_and_goes_on_with_the_settings(self):
        self.board.write_text('{"name": "b", "title": "B", "panle": {}}')
        self.assertIn("board.json: panle: no such key; did you mean panel?", self.ends(self.begin("dark")))
        self.assertEqual(self.lit(), DARK)
        self.write_settings(chip="no-such-chip", health="H")
        self.assertIn("chip no-such-chip", self.ends(self.begin("dark"), code=1))

    def test_takes_the_first_settings_that_can_be_read(self):
        damaged = self.folder / "damaged.json"
        damaged.write_text("{")
        said = self.ends(self.begin("dark", "--settings", self.folder / "absent", "--settings", damaged))
        self.assertIn("damaged.json: not JSON", said)
        self.assertEqual(self.lit(), DARK)

    def test_passes_over_what_a_later_adit_saved(self):
        self.write_settings(chip="no-such-chip", health="H")
        self.settings.write_text(json.dumps({**json.loads(self.settings.read_text()), "of_later": 1}))
        self.assertIn("chip no-such-chip", self.ends(self.begin("dark"), code=1))

    def test_says_where_nothing_tells_it_of_any_lights(self):
        self.assertIn("neither a board nor settings", self.ends(self.begin("dark", settings="/nowhere"), code=1))

    def test_names_a_word_that_is_none(self):
        self.assertIn("unknown word 'bright'", self.ends(self.begin("bright"), code=2))


if __name__ == "__main__":
    program = sys.argv.pop(1)
    unittest.main()
