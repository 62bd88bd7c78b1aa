"""A report whose record is unknown: it is in doubt, its client is told so, the operator sees why and decides, and other messages are
sent. Causes of doubts: dispatch/inquiry_test and dispatch/reports_doubt_test."""

import time
import unittest

from programs import Stage, patient
from reporting import QUICK, REPORT, another, began, insist, sendings, submit


class InDoubt(unittest.TestCase):
    def test_the_operator_calls_it_done(self):
        with Stage(**{**QUICK, "reports__answer_within_ms": 3000}) as stage:
            began(stage).post.will("other-sender,record-then-drop")
            told = submit(stage)
            self.assertEqual(told.status_code, 504, told.text)
            number = int(told.headers["Adit-Report"])
            insist(stage, another(7), 10, until=lambda answer: answer.status_code == 201)
            time.sleep(patient(1.0))  # longer than it takes to find out what can be found out
            self.assertIn(f"report_in_doubt:{number}", stage.box.alarms())
            self.assertIn("the operator decides: Send again or Settle", stage.box.reports()[0]["note"])
            self.assertEqual(sendings(stage), 1)
            self.assertEqual(stage.box.judge(number, "settle"), (200, {"report": number}))
            self.assertNotIn(f"report_in_doubt:{number}", stage.box.alarms())
            self.assertEqual(submit(stage).status_code, 409)
            self.assertEqual(stage.box.judge(number, "send")[0], 409, "a settled report is not sent")
            self.assertEqual(len(stage.post.recorded(REPORT)), 1)
