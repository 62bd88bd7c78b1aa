"""A report of which nobody can tell whether it was recorded: it is in doubt, its client is told so, the operator sees
why and decides, and all else goes on. What leaves a report in doubt is in dispatch/evidence_test and dispatch/reports_doubt_test."""

import contextlib
import time
import unittest

from programs import Stage, patient, wait_until
from reporting import QUICK, REPORT, another, began, insist, sendings, submit

DEADLINE = 3.0  # seconds until a client is told how its report stands


class InDoubt(unittest.TestCase):
    @contextlib.contextmanager
    def stage(self):
        overrides = {**QUICK, "reports__answer_within_ms": int(DEADLINE * 1000)}
        with Stage(**overrides) as stage:
            yield began(stage)

    def attention_says(self, stage, *words):
        said = stage.box.attention()
        for word in words:
            self.assertIn(word, said)

    def is_in_doubt(self, stage, *why):
        """Its client is told so at its deadline and the operator why, it is never sent again, and another report goes
        on. Its number."""
        told = submit(stage)
        self.assertEqual(told.status_code, 504, told.text)
        self.assertIn("in doubt: it may or may not have been recorded", told.json())
        number = int(told.headers["Adit-Report"])
        self.attention_says(stage, f"report {number} is in doubt", *why)
        insist(stage, another(7), 10, until=lambda answer: answer.status_code == 201)
        time.sleep(patient(1.0))  # longer than it takes to find out what can be found out
        self.attention_says(stage, f"report {number} is in doubt", *why)
        self.assertEqual(sendings(stage), 1)
        return number

    def test_a_status_that_cannot_be_had_and_then_can(self):
        with self.stage() as stage:
            stage.post.will("record-then-drop", status=["500", "drop", "401"] + ["500"] * 100)
            self.is_in_doubt(stage)
            stage.post.control("DELETE /faults")
            found = insist(stage, until=lambda answer: answer.status_code == 201)
            self.assertEqual(found.headers["Adit-Reconciled"], "yes")
            self.assertEqual((sendings(stage), len(stage.post.recorded(REPORT))), (1, 1))
            wait_until(lambda: stage.box.attention() == "", "the alarm of a status that fails for long to pass")

    def test_the_operator_calls_it_done(self):
        with self.stage() as stage:
            stage.post.will("other-sender,record-then-drop")
            number = self.is_in_doubt(stage, "remaining_reports went from 45 to 43", "does somebody else report with this token?",
                                      "the operator decides: send it, or call it done")
            self.assertEqual(stage.box.judge(number, "done"), (200, {"report": number}))
            self.assertNotIn("in doubt", stage.box.attention())
            told = submit(stage)
            self.assertEqual(told.status_code, 409)
            self.assertIn("called done by the operator", told.json())
            self.assertEqual(stage.box.judge(number, "send")[0], 409, "what is done is not sent")
            self.assertEqual(len(stage.post.recorded(REPORT)), 1)

    def test_the_operator_sends_it(self):
        with self.stage() as stage:
            stage.post.will("other-sender,record-then-drop")
            number = self.is_in_doubt(stage)
            self.assertEqual(stage.box.judge(number, "send"), (200, {"report": number}))
            self.assertEqual(submit(stage).status_code, 201)
            self.assertEqual(len(stage.post.recorded(REPORT)), 2, "once more, on the operator's word")
            self.assertNotIn("in doubt", stage.box.attention())
