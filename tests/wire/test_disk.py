"""A disk that is full or read-only: no report is taken that is not written down, and it is said."""

import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest
from unittest import mock

import requests

import programs
from filling import Filler
from programs import Stage, wait_until
from reporting import QUICK, another, began, submit


FULL = {**QUICK, "disk": "6m", "post_options": ("--rate", "0", "--reports", "9999"),
        "command_post__rates__reports_hz": 1000}


class Disk(unittest.TestCase):
    def until_refused(self, stage, first):
        """Posts one report after another until the disk takes no more. The number of those that were taken."""
        for number in range(first, first + 1500):
            answer = submit(stage, another(number))
            if answer.status_code != 201:
                break
            self.assertEqual(len(stage.post.recorded(another(number))), 1)
        self.assertEqual(answer.status_code, 503, answer.text)
        self.assertIn("could not be written down and was not taken", answer.json())
        self.assertNotIn("Adit-Report", answer.headers)
        return number - first

    def test_a_disk_that_fills_up(self):
        with Stage(**FULL) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            filler = Filler(stage.box.state)
            taken = self.until_refused(stage, 1)
            refused = another(1 + taken)
            self.assertEqual(stage.post.recorded(refused), [], "what was not taken was not sent")
            self.assertIn("no report is taken: the ledger cannot be written: ", stage.box.attention())
            self.assertEqual(submit(stage).json()["score_change"], 1, "what was answered before is still answered")
            filler.make_room()
            again = wait_until(lambda: (answer := submit(stage, refused)).status_code == 201 and answer, "room to be found")
            self.assertNotIn("Adit-Reconciled", again.headers)
            self.assertEqual(len(stage.post.recorded(refused)), 1)
            wait_until(lambda: stage.box.attention() == "", "nothing to be left to do")
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            self.assertEqual(submit(stage, refused).content, again.content)
            self.assertEqual(len(stage.post.recorded()), 2 + taken)

    def test_a_state_folder_that_is_read_only(self):
        runtime = self.enterContext(tempfile.TemporaryDirectory())  # elsewhere, as with systemd
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=runtime))
        with Stage(**FULL) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            stage.box.stop(signal.SIGKILL)
            self.remount(stage, "ro")  # as the kernel does where a disk fails
            stage.restart_box()
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            self.assertEqual(len(self.stand_ins(runtime)), 1, "the copy of the one that was killed is gone")
            self.assertIn("no report is taken: the ledger cannot be written: ", stage.box.attention())
            self.assertIn("Read-only file system", stage.box.attention())
            self.assertEqual([row["state"] for row in stage.box.reports()], ["answered"], "what can be read is shown")
            refused = submit(stage, another(1))
            self.assertEqual(refused.status_code, 503, refused.text)
            self.assertIn("could not be written down and was not taken", refused.json())
            wait_until(lambda: submit(stage).status_code == 201, "the one that is known to get its answer")
            headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"}
            state = {"header": {"stamp": 1.0, "frame_id": "darpa"}, "poses": []}
            taken = requests.post(f"{stage.box.url}/state/update", json=state, headers=headers, timeout=10)
            self.assertEqual(taken.status_code, 200, taken.text)
            self.remount(stage, "rw")
            self.remount(stage, "rw", "nsenter", "--mount", f"--target={stage.box.process.pid}")
            wait_until(lambda: self.taken(stage, another(1)), "it to recover by itself")
            self.assertEqual(len(stage.post.recorded()), 2)
            self.assertNotIn("the ledger", stage.box.attention())
            self.assertEqual(self.stand_ins(runtime), [])

    @staticmethod
    def stand_ins(runtime):
        return list(pathlib.Path(runtime).glob("adit-stand-in-*"))

    @staticmethod
    def taken(stage, report):
        with contextlib.suppress(requests.RequestException):  # it restarts
            return submit(stage, report).status_code == 201

    @staticmethod
    def remount(stage, how, *where):
        subprocess.run([*where, "mount", "--options-mode=ignore", "-o", f"remount,{how}", stage.box.state], check=True)
