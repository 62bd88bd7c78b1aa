"""Whatever becomes of a report's answer: it is recorded exactly once, and its clients get a true answer."""

import json
import time
import unittest

import requests

import hosts
from programs import Stage, patient, wait_until
from reporting import QUICK, REPORT, another, at_once, began, insist, left_unanswered, sendings, submit

# Recorded, and the answer is lost: found out, and never sent again.
LOST_AND_RECORDED = ("record-then-drop", "reset", "half-answer", "garbage", "500-recorded", "answer-after=1",
                     "record-after=0.6", "record-after=0.3,reset")
# Not recorded, and the answer is lost: sent again.
LOST_AND_NOT_RECORDED = ("drop", "reset-unrecorded", "500")
# The Command Post's own answer comes, late or after more tries.
ANSWERED = ("ok", "answer-after=0.2", "record-after=0.2", "429", "429=8", "429,retry-after=1")
# What goes wrong with the run's status as well, while it is asked for.
LOST_STATUS = ("500", "drop", "reset", "garbage", "half-answer", "429", "401", "answer-after=1")


def setUpModule():
    hosts.needs_namespaces()


class ExactlyOnce(unittest.TestCase):
    def played(self, *faults, of_status=()):
        """Two clients post the same report, one that waits and one that hangs up after 300 ms and tries again, while
        these faults befall it. The answer, which is the same for both, and the stage's record of it."""
        with Stage(**QUICK) as stage:
            began(stage)
            self.assertEqual(submit(stage, another(9)).status_code, 201)  # and the run's name is known
            stage.post.will(*faults, status=list(of_status))
            waited, insisted = at_once(lambda: submit(stage), lambda: insist(stage))
            self.assertEqual(waited.status_code, 201, waited.text)
            self.assertEqual(waited.content, insisted.content)
            self.assertEqual(waited.headers["Content-Type"], "application/json")
            self.assertEqual(submit(stage).content, waited.content, "asked for once more")
            time.sleep(patient(0.3))  # what might still be sent would be by now
            recorded = stage.post.recorded(REPORT)
            self.assertEqual(len(recorded), 1, "recorded exactly once")
            self.assertEqual(len(stage.post.recorded()), 2)
            self.assertEqual(stage.post.violations(), [])
            self.assertEqual(stage.box.attention(), "")
            return waited, recorded[0]

    def is_true(self, answer, record):
        """What a reconciled answer says."""
        self.assertEqual(answer.headers["Adit-Reconciled"], "yes")
        said = answer.json()
        for name in ("x", "y", "z", "type", "team", "run", "report_status", "score_change"):
            self.assertEqual(said[name], record[name], name)
        self.assertEqual(said["score_change"], 1)
        self.assertIs(said["adit"]["reconciled"], True)
        self.assertGreater(said["run_clock"], record["run_clock"] - patient(1.0))
        self.assertIn("remaining_reports went from 44 to 43 and the score from 0 to 1", said["adit"]["evidence"])
        self.assertEqual((said["id"], said["url"]), (None, None), "not known, and not made up")

    def is_its_own(self, answer, record):
        self.assertNotIn("Adit-Reconciled", answer.headers)
        own = {name: value for name, value in record.items() if name not in ("by", "request")}
        self.assertEqual(answer.text, json.dumps(own, separators=(",", ":")))

    def test_recorded_and_the_answer_lost(self):
        for fault in LOST_AND_RECORDED:
            with self.subTest(fault):
                self.is_true(*self.played(fault))

    def test_lost_before_it_was_recorded(self):
        for fault in LOST_AND_NOT_RECORDED:
            with self.subTest(fault):
                self.is_its_own(*self.played(fault))

    def test_answered_late_or_after_more_tries(self):
        for fault in ANSWERED:
            with self.subTest(fault):
                self.is_its_own(*self.played(fault))

    def test_lost_again_and_again(self):
        self.is_its_own(*self.played("drop", "500", "reset-unrecorded"))
        self.is_true(*self.played("drop", "429", "record-then-drop"))

    def test_the_status_is_lost_too_while_it_is_asked_for(self):
        for fault in LOST_STATUS:
            with self.subTest(fault):
                self.is_true(*self.played("reset", of_status=[fault]))
        self.is_its_own(*self.played("drop", of_status=["500", "ok", "drop"]))

    def test_a_client_that_hung_up_and_came_back_gets_the_real_answer(self):
        for fault, check, patience in (("answer-after=1", self.is_its_own, 5000),
                                       ("record-after=1", self.is_its_own, 5000),
                                       ("answer-after=1", self.is_true, 400), ("reset", self.is_true, 400)):
            with self.subTest(fault, patience=patience), Stage(**{
                    **QUICK, "command_post__timeouts__scoring_answer_ms": patience}) as stage:
                began(stage)
                self.assertEqual(submit(stage, another(9)).status_code, 201)
                stage.post.will(fault, status=["drop"])
                left_unanswered(stage, patience=0.3 if patience > 400 else 0.08)
                wait_until(lambda stage=stage: stage.box.on_disk()[1:] in (["answered"], ["settled"]), "its answer")
                check(submit(stage), *stage.post.recorded(REPORT))
                self.assertEqual(sendings(stage), 1)

    def test_nothing_is_made_up_about_a_run_that_was_never_heard_of(self):
        with Stage(**QUICK) as stage:
            began(stage)
            stage.post.will("reset")
            said = submit(stage).json()
            self.assertEqual((said["run"], said["team"], said["score_change"]), (None, "adit", 1))

    def test_reports_in_doubt_together_are_each_recorded_once(self):
        with Stage(**QUICK) as stage:
            began(stage)
            stage.post.will("reset", "drop", "429=3", "half-answer", "500", "record-then-drop", "answer-after=1")
            answers = at_once(*[lambda n=n: insist(stage, another(n), 0.1 * n) for n in range(1, 9)])
            self.assertEqual({answer.status_code for answer in answers}, {201})
            self.assertEqual(sorted(made["x"] for made in stage.post.recorded()), [10.0 * n for n in range(1, 9)])

    def test_a_client_that_hangs_up_again_and_again_is_never_turned_away(self):
        with Stage(**{**QUICK, "reports__doubt_for_ms": 12000, "reports__answer_within_ms": 30000}) as stage:
            began(stage).post.will("drop")
            posted = time.monotonic()
            while time.monotonic() - posted < 6:
                with self.assertRaises(requests.Timeout):  # and no ConnectionError
                    submit(stage, timeout=0.3)
            said = [(alarm["severity"], alarm["subject"]) for alarm in stage.box.ask("GET /adit/run")[1]["alarms"]]
            self.assertIn(("wait", "1"), said, "Adit itself asks what became of it")
            self.assertEqual(submit(stage).status_code, 201)


if __name__ == "__main__":
    unittest.main()
