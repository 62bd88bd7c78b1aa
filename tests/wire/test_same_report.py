"""A repeated report is the same report."""

import signal
import unittest

from alarming import reason
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, at_once, began, sendings, submit


def run(stage):
    return stage.box.ask("GET /adit/run")[1]


def left(stage):
    """The reports left, from the last status."""
    return run(stage)["run"]["remaining_reports"]


class SameReport(unittest.TestCase):
    def test_clients_that_post_it_at_once_get_one_answer(self):
        with Stage(**QUICK) as stage:
            began(stage).post.will("answer-after=0.3")
            spelled = {**REPORT, "type": "BACKPACK", "name": "robot2"}  # ICD 5.2: any letter case
            answers = at_once(*[lambda: submit(stage)] * 5, lambda: submit(stage, spelled))
            self.assertEqual([answer.status_code for answer in answers], [201] * 6)
            self.assertEqual({answer.content for answer in answers}, {answers[0].content})
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (1, 1))

    def test_it_is_the_same_after_the_referee_granted_a_report(self):
        with Stage(**QUICK) as stage:
            all_left = left(began(stage))
            first = submit(stage)
            wait_until(lambda: left(stage) == all_left - 1, "a status with the report")
            stage.post.control("POST /grant")
            wait_until(lambda: left(stage) == all_left, "a status with one more report")
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            again = submit(stage)
            self.assertEqual((again.status_code, again.content), (201, first.content))
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (2, 1))

    def test_it_is_held_if_the_server_renames_the_run(self):
        with Stage(**QUICK) as stage:
            all_left = left(began(stage))
            submit(stage)
            wait_until(lambda: left(stage) == all_left - 1, "a status with the report")
            wait_until(lambda: run(stage)["run"]["run_clock"] > 5, "a clock that no young run shows")
            stage.post.control("POST /rename")
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            wait_until(lambda: "run_renamed" in stage.box.alarms(), "the alarm")
            why = next(reason(alarm) for alarm in run(stage)["alarms"] if alarm["id"] == "run_renamed")
            self.assertIn("its count of reports and its clock go on", why)
            again = submit(stage)
            self.assertEqual(again.status_code, 503)
            self.assertIn("the same as report 1", again.text)
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (2, 1))

    def test_it_is_the_same_after_a_restart(self):
        with Stage(**QUICK) as stage:
            first = submit(began(stage))
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            again = submit(stage)  # before the run is known
            self.assertEqual((again.status_code, again.content), (201, first.content))
            self.assertEqual(len(stage.post.recorded()), 1)
