"""A full disk: no report is taken that is not written down, and it is said."""

import signal
import unittest

from filling import Filler
from programs import Stage, wait_until
from reporting import QUICK, another, began, submit

FULL = {**QUICK, "disk": "6m", "post_options": ("--rate", "0", "--reports", "9999"),
        "command_post__rates__reports_hz": 1000}


class Disk(unittest.TestCase):
    def until_refused(self, stage):
        """Posts one report after another until the disk takes no more. The number of those that were taken."""
        for number in range(1, 1500):
            answer = submit(stage, another(number))
            if answer.status_code != 201:
                break
        self.assertEqual(answer.status_code, 503, answer.text)
        self.assertNotIn("Adit-Report", answer.headers)
        self.assertEqual([made["x"] for made in stage.post.recorded()[1:]], [another(taken)["x"] for taken in range(1, number)])
        return number - 1

    def test_a_disk_that_fills_up(self):
        with Stage(**FULL) as stage:
            self.assertEqual(submit(began(stage)).status_code, 201)
            filler = Filler(stage.box.state)
            taken = self.until_refused(stage)
            refused = another(1 + taken)
            self.assertEqual(stage.post.recorded(refused), [], "what was not taken was not sent")
            self.assertIn("ledger_unwritable", stage.box.alarms())
            self.assertEqual(submit(stage).json()["score_change"], 1, "what was answered before is still answered")
            filler.make_room()
            again = wait_until(lambda: (answer := submit(stage, refused)).status_code == 201 and answer, "room to be found")
            self.assertNotIn("Adit-Reconciled", again.headers)
            self.assertEqual(len(stage.post.recorded(refused)), 1)
            wait_until(lambda: not stage.box.alarms(), "nothing to be left to do")
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            self.assertEqual(submit(stage, refused).content, again.content)
            self.assertEqual(len(stage.post.recorded()), 2 + taken)
