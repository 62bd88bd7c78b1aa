"""A disk that is full and a ledger that is damaged: no report is taken that is not written down, and it is said."""

import errno
import os
import pathlib
import signal
import unittest

import hosts
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, began, submit


FULL = {**QUICK, "disk": "6m", "post_options": ("--rate", "0", "--reports", "9999"),
        "command_post__rates__reports_hz": 1000}


def setUpModule():
    hosts.needs_namespaces()


class Filler:
    """A file that takes up all the room there is."""

    def __init__(self, folder):
        self.path = folder / "filler"
        self.fill()

    def fill(self):
        for size in (65536, 4096, 1):
            with open(self.path, "ab", buffering=0) as file:
                try:
                    while file.write(b"x" * size):
                        pass
                except OSError as error:
                    if error.errno != errno.ENOSPC:
                        raise

    def make_room(self):
        self.path.unlink()


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
        self.assertIn("no report is taken, the ledger cannot be written: ", stage.box.attention())
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
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            self.assertEqual(stage.box.on_disk(), ["answered"])
            self.assertEqual(len(stage.post.recorded()), 2)

    @staticmethod
    def damage(path: pathlib.Path):
        """Its middle overwritten. What is in it then."""
        size = path.stat().st_size
        with open(path, "r+b") as file:
            file.seek(4096)
            file.write(os.urandom(size - 4096))
        return path.read_bytes()


if __name__ == "__main__":
    unittest.main()
