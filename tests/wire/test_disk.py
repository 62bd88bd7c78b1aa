"""A full disk, and a missing or unreadable ledger: no unwritten report is accepted, and the client gets the reason."""

import os
import shutil
import signal
import time
import unittest

import requests

import maps
import messages
from filling import Filler
from programs import Stage, wait_until
from reporting import QUICK, another, began, submit

FULL = {**QUICK, "disk": "12m", "post_options": ("--rate", "0", "--reports", "9999"),
        "command_post__rates__reports_hz": 1000}
BRIEF = {**QUICK, "reports__answer_within_ms": 1000}


class Disk(unittest.TestCase):
    def until_refused(self, stage):
        """Posts reports until the disk is full. Returns the number of accepted ones."""
        for number in range(1, 1500):
            answer = submit(stage, another(number))
            if answer.status_code != 201:
                break
        self.assertEqual(answer.status_code, 503, answer.text)
        self.assertNotIn("Adit-Report", answer.headers)
        self.assertEqual([made["x"] for made in stage.post.recorded()[1:]], [another(taken)["x"] for taken in range(1, number)])
        return number - 1

    def test_a_disk_that_fills_up(self):
        for ends in ("while it runs", "after a kill"):
            with self.subTest(ends), Stage(**FULL) as stage:
                first = submit(began(stage))
                filler = Filler(stage.box.state)
                taken = self.until_refused(stage)
                refused = another(1 + taken)
                self.assertEqual(stage.post.recorded(refused), [], "a report that was not accepted was not sent")
                self.assertIn("ledger_unwritable", stage.box.alarms())
                self.assertEqual(submit(stage).content, first.content, "a known report is still answered")
                if ends == "after a kill":
                    stage.box.stop(signal.SIGKILL)
                filler.make_room()
                if ends == "after a kill":
                    stage.restart_box()
                again = wait_until(lambda: (answer := submit(stage, refused)).status_code == 201 and answer, "room to be found")
                self.assertNotIn("Adit-Reconciled", again.headers)
                wait_until(lambda: not stage.box.alarms(), "nothing to be left to do")
                stage.box.stop(signal.SIGKILL)
                self.assertEqual(stage.box.on_disk(), ["answered"] * (2 + taken))
                stage.restart_box()
                self.assertEqual(submit(stage, refused).content, again.content)
                self.assertEqual(len(stage.post.recorded()), 2 + taken)

    def test_a_ledger_that_is_gone(self):
        with Stage(**BRIEF) as stage:
            self.assertEqual(submit(began(stage)).headers["Adit-Report"], "1")
            self.assertEqual(stage.box.stop(), 0)
            shutil.rmtree(stage.box.state / "ledger")
            os.remove(stage.box.state / "ledger-on-disk")  # in memory, so it ends with a boot
            stage.restart_box()
            self.assertIn("reports may be missing from number", began(stage).box.output())
            self.assertIn("ledger_damaged", stage.box.alarms())
            self.assertEqual(submit(stage).status_code, 503, "it may be the same as a report that is lost")
            self.assertEqual([(each["number"], each["state"]) for each in stage.box.reports()], [(1000, "in_doubt"), (1001, "held")])
            self.assertEqual(len(stage.post.recorded()), 1)

    def test_a_ledger_that_was_put_back_to_an_older_copy(self):
        """In the copy the report is queued. It has been sent since, and is not sent again."""
        with Stage(**BRIEF, command_post__rates__reports_hz=0.2) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            self.assertEqual(submit(stage, another(1)).status_code, 503)
            self.assertEqual([each["state"] for each in stage.box.reports()], ["answered", "queued"])
            ledger, copy = stage.box.state / "ledger", stage.folder / "copy"
            shutil.copytree(ledger, copy)
            wait_until(lambda: stage.box.on_disk() == ["answered", "answered"], "the report to be sent")
            stage.box.stop(signal.SIGKILL)
            shutil.rmtree(ledger)
            copy.rename(ledger)
            stage.restart_box()
            self.assertIn("its last records are not there", began(stage).box.output())
            self.assertIn("ledger_damaged", stage.box.alarms())
            self.assertEqual(submit(stage, another(1)).status_code, 504)
            self.assertEqual([each["state"] for each in stage.box.reports()], ["answered", "in_doubt"])
            self.assertEqual(len(stage.post.recorded(another(1))), 1)

    def test_an_earlier_ledger(self):
        with Stage(**BRIEF) as stage:
            earlier = began(stage).box.state / "ledger.sqlite"
            earlier.write_bytes(b"SQLite format 3")
            wait_until(lambda: stage.box.alarms() == {"other_ledger"}, "the file to be named")
            self.assertEqual(submit(stage).status_code, 201)
            earlier.unlink()
            wait_until(lambda: not stage.box.alarms(), "the alarm to end")

    def test_a_ledger_that_cannot_be_read(self):
        with Stage(**QUICK) as stage:
            first = submit(began(stage))
            stage.box.stop(signal.SIGKILL)
            ledger, elsewhere, style = stage.box.state / "ledger", stage.folder / "log", messages.Style()
            log, = ledger.iterdir()
            log.rename(elsewhere)
            log.mkdir()
            stage.restart_box()
            refused = submit(began(stage), another(1))
            self.assertEqual(refused.status_code, 503)
            self.assertIn("could not be stored and was not accepted", refused.json())
            self.assertIn("ledger_unwritable", stage.box.alarms())
            self.assertIn("rejecting reports: the ledger cannot be read", stage.box.output())
            grid = messages.map_update(maps.made_grid(20, 20), "r1", time.time(), style)
            messages.post(requests, stage.box.url, "/map/update", grid, style)
            wait_until(lambda: stage.post.requests("/map/update"), "the map to arrive")
            self.assertEqual(list(ledger.iterdir()), [log])
            log.rmdir()
            elsewhere.rename(log)
            wait_until(lambda: submit(stage, another(1)).status_code == 201, "the ledger to be read", tolerates=requests.ConnectionError)
            self.assertEqual(submit(stage).content, first.content)
            self.assertEqual(stage.box.alarms(), set())
            self.assertEqual((stage.box.on_disk(), len(stage.post.recorded())), (["answered", "answered"], 2))

    def test_a_log_of_an_absurd_size(self):
        with Stage(**QUICK) as stage:
            first = submit(began(stage))
            stage.box.stop(signal.SIGKILL)
            for log in (stage.box.state / "ledger").iterdir():
                os.truncate(log, 1 << 40)
            stage.restart_box()
            self.assertEqual(submit(began(stage)).content, first.content)
            self.assertIn("it has 1099511627776 bytes", stage.box.output())
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            self.assertEqual([each["state"] for each in stage.box.reports()], ["answered", "answered"])
            self.assertEqual(len(stage.post.recorded()), 2)

    def test_a_damaged_ledger_on_a_full_disk(self):
        with Stage(**FULL) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            stage.box.stop(signal.SIGKILL)
            ledger = stage.box.state / "ledger"
            log, = ledger.iterdir()
            with open(log, "r+b") as file:
                file.seek(8192)
                file.write(bytes(8192))  # both copies of the first record
            filler, before = Filler(stage.box.state), len(stage.box.output())
            stage.restart_box()
            self.assertEqual([submit(began(stage), another(1)).status_code for _ in range(5)], [503] * 5)
            self.assertEqual(sorted(each.name for each in ledger.iterdir()), ["damaged-1", log.name])
            self.assertEqual(stage.box.output()[before:].count("the ledger cannot be written"), 1)
            filler.make_room()
            wait_until(lambda: submit(stage, another(1)).status_code == 201, "room to be found")
            self.assertEqual(stage.box.on_disk(), ["answered", "answered"])
            self.assertEqual(stage.box.alarms() & {"ledger_damaged", "ledger_unwritable"}, {"ledger_damaged"})
