"""A disk that is full and a ledger that is damaged: no report is taken that is not written down, and it is said."""

import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest
from unittest import mock

import requests

import hosts
import programs
from filling import Filler
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, began, left_unanswered, submit


FULL = {**QUICK, "disk": "6m", "post_options": ("--rate", "0", "--reports", "9999"),
        "command_post__rates__reports_hz": 1000}


def setUpModule():
    hosts.needs_namespaces()


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
            self.recovers(stage, Filler(stage.box.state))

    def test_a_disk_that_is_full_at_the_start(self):
        with Stage(**FULL) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            self.assertEqual(stage.box.stop(), 0)
            filler = Filler(stage.box.state)
            stage.restart_box()
            self.recovers(began(stage), filler)

    def recovers(self, stage, filler):
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

    def test_a_disk_that_fills_up_while_an_answer_is_awaited(self):
        with Stage(**{**FULL, "command_post__timeouts__scoring_answer_ms": 20000}) as stage:
            self.assertEqual(began(stage).box.stop(), 0)
            Filler(stage.box.state)
            stage.restart_box()  # its log has no room ahead of need
            Filler(began(stage).box.state).make_room()
            stage.post.will("answer-after=3")
            with self.assertRaises(OSError):
                submit(stage, timeout=1)
            filler = Filler(stage.box.state)
            answer = submit(stage)
            self.assertEqual((answer.status_code, answer.json()["score_change"]), (201, 1), "it is true all the same")
            self.assertIn("the ledger cannot be written", stage.box.attention())
            self.assertEqual(stage.box.on_disk(), ["sending"])
            filler.make_room()
            wait_until(lambda: stage.box.attention() == "", "the answer to be written down after all")
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            self.assertEqual(submit(stage).content, answer.content)
            self.assertEqual(len(stage.post.recorded(REPORT)), 1)

    def test_a_damaged_ledger_is_set_aside_and_all_goes_on(self):
        with Stage(**QUICK) as stage:
            began(stage)
            self.assertEqual(submit(stage).status_code, 201)
            self.assertEqual(stage.box.stop(), 0)
            damaged = self.damage(stage.box.state / "ledger.sqlite")
            stage.restart_box()
            self.assertIn("damaged", stage.box.attention())
            aside = stage.box.state / "ledger.sqlite.damaged-1"
            self.assertEqual(aside.read_bytes(), damaged, "kept for whoever wants to read it")
            self.may_be_lost(stage)

    def may_be_lost(self, stage):
        """What is posted may be what was lost: the operator decides, and then all is as before."""
        self.assertIn("reports from 1 on may be lost from the ledger", stage.box.attention())
        left_unanswered(stage)
        self.assertIn("report 1001 is held: ", stage.box.attention())
        self.assertEqual(stage.box.judge(1001, "withdraw")[0], 200)
        self.assertEqual(len(stage.post.recorded()), 1, "it was sent before")
        self.assertEqual(stage.box.judge(1000, "done")[0], 200)
        self.assertEqual(submit(stage, another(1)).status_code, 201)
        self.assertEqual(stage.box.on_disk(), ["settled", "withdrawn", "answered"])
        self.assertEqual(len(stage.post.recorded()), 2)

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
        subprocess.run([*where, "mount", "-o", f"remount,{how}", stage.box.state], check=True)

    @staticmethod
    def damage(path: pathlib.Path):
        """Its middle overwritten. What is in it then."""
        size = path.stat().st_size
        with open(path, "r+b") as file:
            file.seek(4096)
            file.write(os.urandom(size - 4096))
        return path.read_bytes()
