"""A report of which nobody can tell whether it was recorded: it is in doubt, its client is told so, the operator sees
why and decides, and all else goes on."""

import contextlib
import time
import unittest

import requests

import hosts
import programs
from programs import Stage, patient, wait_until
from reporting import QUICK, REPORT, another, at_once, began, insist, sendings, submit

DEADLINE = 3.0  # seconds until a client is told how its report stands


def setUpModule():
    hosts.needs_namespaces()


def status(stage):
    headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
    return requests.get(stage.box.url + "/api/status", headers=headers, timeout=60)


class InDoubt(unittest.TestCase):
    @contextlib.contextmanager
    def stage(self, *options):
        overrides = {**QUICK, "reports__answer_within_ms": int(DEADLINE * 1000)}
        with Stage(post_options=("--rate", "0", *options), **overrides) as stage:
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

    def test_another_sender_while_it_was_on_its_way(self):
        with self.stage() as stage:
            stage.post.will("other-sender,record-then-drop")
            self.is_in_doubt(stage, "remaining_reports went from 45 to 43",
                             "does somebody else report with this token?",
                             "the operator decides: send it, or call it done")

    def test_another_sender_earlier_in_the_run(self):
        with self.stage() as stage:
            stage.post.control("POST /other-sender")
            wait_until(lambda: status(stage) and "somebody else reports with this token" in stage.box.attention(),
                       "the other sender to be noticed")
            stage.post.will("drop")
            self.is_in_doubt(stage, "somebody else reports with this token")

    def test_a_count_that_contradicts(self):
        for fault, why in (("remaining=+3,drop", "a new run began"),
                           ("remaining=-3,record-then-drop", "does somebody else report with this token?")):
            with self.subTest(fault), self.stage() as stage:
                stage.post.will(fault)
                self.is_in_doubt(stage, why)

    def test_a_new_run_meanwhile(self):
        for body in ({}, {"team": "other"}):  # the run clock goes back; another team
            with self.subTest(body), self.stage() as stage:
                # So long that the new run's clock is behind what the box last heard, however busy the machine is.
                wait_until(lambda stage=stage: stage.box.ask("GET /adit/run")[1]["run"]["run_clock"] > 8, "the run to go on")
                stage.post.will("drop", status=["500"] * 1000)  # nothing is found out before the new run
                told, _ = at_once(lambda: submit(stage), lambda: self.begin_new_run(stage, body))
                self.assertEqual(told.status_code, 504, told.text)
                self.attention_says(stage, "report 1 is in doubt", "a new run began", "the operator decides")
                self.assertEqual(submit(stage, another(1)).status_code, 201)
                time.sleep(1.0)
                self.assertEqual((sendings(stage), stage.post.recorded(REPORT)), (1, []))
                self.assertEqual(stage.box.ask("GET /adit/run")[1]["run_number"], 2)

    def begin_new_run(self, stage, body):
        wait_until(lambda: [row["state"] for row in stage.box.reports()] == ["in doubt"], "the report to be in doubt")
        stage.post.control("POST /new-run", body)
        stage.post.control("DELETE /faults")

    def test_an_administrative_stop_that_is_known(self):
        with self.stage() as stage:
            stage.post.control("POST /stop")
            self.assertEqual(submit(stage, another(1)).json()["report_status"], "admin stop")
            stage.post.will("record-then-drop")
            self.is_in_doubt(stage, "not known for certain")

    def test_reports_that_are_not_being_scored(self):
        for options in (("--not-started",), ("--reports", "0")):
            with self.subTest(options), self.stage(*options) as stage:
                stage.post.will("record-then-drop")
                self.is_in_doubt(stage, "reports are not being scored")

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
            number = self.is_in_doubt(stage)
            self.assertEqual(stage.box.judge(number, "done"), (200, {"report": number}))
            self.assertNotIn("in doubt", stage.box.attention())
            told = submit(stage)
            self.assertEqual(told.status_code, 409)
            self.assertIn("called done by the operator", told.json())
            self.assertEqual(stage.box.judge(number, "send")[0], 409, "what is done is not sent")
            self.assertEqual(len(stage.post.recorded(REPORT)), 1)

    def test_the_operator_sends_it(self):
        for fault, records in (("other-sender,record-then-drop", 2), ("remaining=+3,drop", 1)):
            with self.subTest(fault), self.stage() as stage:
                stage.post.will(fault)
                number = self.is_in_doubt(stage)
                self.assertEqual(stage.box.judge(number, "send"), (200, {"report": number}))
                self.assertEqual(submit(stage).status_code, 201)
                self.assertEqual(len(stage.post.recorded(REPORT)), records, "once more, on the operator's word")
                self.assertNotIn("in doubt", stage.box.attention())


if __name__ == "__main__":
    unittest.main()
