"""Alarms of the box itself. What these hosts cannot make true is driven through the file of adit-update."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from unittest import mock

from alarming import WithAlarms
from programs import wait_until
from reporting import began, submit


class Box(WithAlarms):
    def test_the_box_rests(self):
        stage = self.stage()
        self.assertEqual(stage.box.ask("POST /adit/spare/rest", body={})[0], 200)
        self.sees(stage, "rests", "bad", "box", "This box rests and sends nothing", "for its spare")
        self.assertEqual([alarm["id"] for alarm in self.view(stage)["alarms"]], ["rests"], "the only cause")
        wait_until(lambda: stage.box.ask("POST /adit/spare/wake", body={})[0] == 200, "it to be woken up")
        wait_until(lambda: self.view(stage)["lights"] and not self.alarm(stage, "rests"), "it to go on")
        began(stage)
        self.assertEqual(submit(stage).status_code, 201)

    # By adit-update's file: it needs an image with two slots.
    def tell_of_update(self, stage, **more):
        status = {"format": 1, "trouble": "", "running": {"compatible": "adit-x", "version": "1.2.0", "slot": "B", "other": "A"},
                  "nonce": "", "refusal": "", "doing": "", "progress": None,
                  "last": {"stage": "installed", "version": "1.2.0", "slot": "B", "boot": "b", "why": ""},
                  "trial": False, "stray": "", "stick": None, "stick_trouble": "", **more}
        folder = stage.folder / "update"
        folder.mkdir(exist_ok=True)
        (folder / "status.new").write_text(json.dumps(status))
        (folder / "status.new").rename(folder / "status.json")

    def test_an_update_is_on_trial_and_then_another_slot_runs(self):
        stage = self.stage()
        self.tell_of_update(stage, trial=True)
        self.sees(stage, "update_on_trial", "wait", "box", "Version 1.2.0 is on trial")
        self.tell_of_update(stage, stray="A with 1.1.0 runs, and B with 1.2.0 was good last")
        self.goes(stage, "update_on_trial")
        self.sees(stage, "other_slot", "ask", "box", "Another slot is running", "B with 1.2.0 was good last")
        self.tell_of_update(stage)
        self.goes(stage, "other_slot")

    def test_the_time_is_not_set(self):
        if not shutil.which("clang-19"):
            self.skipTest("clang-19 is not here")
        library = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()), "no_clock.so")
        subprocess.run(["clang-19", "-shared", "-fPIC", "-o", library, pathlib.Path(__file__).with_name("no_clock.c")], check=True)
        with mock.patch.dict(os.environ, LD_PRELOAD=str(library)):
            stage = self.stage()
        self.sees(stage, "time_not_set", "wait", "box", "The box's time is not set", "of a wrong day")
        self.gone_after_a_restart(stage, "time_not_set")

    def test_ntp_does_not_work(self):
        """On a machine that keeps its time by itself."""
        stage = self.stage(clock={"ntp_server": "192.168.7.5"})
        self.sees(stage, "ntp", "wait", "box", "NTP does not work", "keeps its time by itself")
        self.gone_after_a_restart(stage, "ntp", clock={"ntp_server": ""})

    def test_the_boards_file_is_not_used(self):
        stage = self.stage()
        self.assertEqual(stage.box.stop(), 0)
        (stage.folder / "board.json").write_text("{")
        stage.restart_box()
        self.sees(began(stage), "board_not_used", "bad", "box", "The board's file is not used")
        (stage.folder / "board.json").unlink()
        self.gone_after_a_restart(stage, "board_not_used")

    def test_the_lights_cannot_be_set(self):
        """The simulated panel's, while a folder stands in the way of its file."""
        stage = self.stage()
        obstacle = stage.box.state / "panel.new"
        obstacle.mkdir()
        self.assertEqual(stage.box.ask("POST /adit/identify", body={"seconds": 1})[0], 200)  # something to show
        self.sees(stage, "lights_not_set", "bad", "box", "The lights are not to be trusted", "Is a directory", panel=False)
        obstacle.rmdir()
        self.goes(stage, "lights_not_set")

    def test_a_notice_is_left_while_it_runs(self):
        stage = began(self.stage())
        (stage.folder / "notices").mkdir(exist_ok=True)
        (stage.folder / "notices/disks").write_text("2 disks hold an Adit\n")
        self.sees(stage, "notice:disks", "bad", "box", "The box is not well", "2 disks hold an Adit")
        (stage.folder / "notices/disks").unlink()
        self.goes(stage, "notice:disks")
