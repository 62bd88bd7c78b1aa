"""Whatever happens to the answer to a report, the report is recorded exactly once, and its clients get a true answer. One story per
outcome; which fault has which outcome: uplink/doubt_test, dispatch/report_verdict_test and dispatch/reports_doubt_test."""

import json
import time
import unittest

from programs import Stage, patient
from reporting import QUICK, REPORT, another, at_once, began, insist, submit


class ExactlyOnce(unittest.TestCase):
    def played(self, fault):
        """Two clients post the same report during this fault. One waits, the other hangs up after 300 ms and retries. Returns their
        common answer and the stage's record."""
        with Stage(**QUICK) as stage:
            began(stage)
            named = {**another(9), "name": "spot1"}
            self.assertEqual(submit(stage, named).status_code, 201)  # and the run's name is known
            self.assertEqual(stage.post.requests("/api/artifact_reports")[0]["message"], named)
            self.assertEqual(stage.box.reports()[0]["robot"], "spot1")
            stage.post.will(fault)
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
            self.assertEqual(stage.box.alarms(), set())
            return waited, recorded[0]

    def is_true(self, answer, record):
        """Checks the content of a reconciled answer."""
        self.assertEqual(answer.headers["Adit-Reconciled"], "yes")
        said = answer.json()
        for name in ("x", "y", "z", "type", "team", "run", "report_status", "score_change"):
            self.assertEqual(said[name], record[name], name)
        self.assertEqual(said["score_change"], 1)
        self.assertIs(said["adit"]["reconciled"], True)
        self.assertGreater(said["run_clock"], record["run_clock"] - patient(1.0))
        self.assertTrue(said["adit"]["evidence"])
        self.assertEqual((said["id"], said["url"]), (None, None), "not known, and not made up")

    def is_its_own(self, answer, record):
        self.assertNotIn("Adit-Reconciled", answer.headers)
        own = {name: value for name, value in record.items() if name not in ("by", "request")}
        self.assertEqual(answer.text, json.dumps(own, separators=(",", ":")))

    def test_recorded_and_the_answer_lost(self):
        self.is_true(*self.played("reset"))

    def test_lost_before_it_was_recorded(self):
        self.is_its_own(*self.played("drop"))

    def test_answered(self):
        self.is_its_own(*self.played("ok"))
