"""The same report again is the same report; what waited for the run before is held for the operator; a refused token."""

import contextlib
import signal
import unittest

from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, at_once, began, left_unanswered, sendings, submit


@contextlib.contextmanager
def playing(**overrides):
    with Stage(**{**QUICK, **overrides}) as stage:
        yield began(stage)


class SameReport(unittest.TestCase):
    def test_clients_that_post_it_at_once_get_one_answer(self):
        with playing() as stage:
            stage.post.will("answer-after=0.3")
            spelled = {**REPORT, "type": "BACKPACK", "name": "robot2"}  # ICD 5.2: any letter case
            answers = at_once(*[lambda: submit(stage)] * 5, lambda: submit(stage, spelled))
            self.assertEqual([answer.status_code for answer in answers], [201] * 6)
            self.assertEqual({answer.content for answer in answers}, {answers[0].content})
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (1, 1))

    def test_it_is_the_same_after_a_restart(self):
        with playing() as stage:
            first = submit(stage)
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            again = submit(stage)  # before the run is known
            self.assertEqual((again.status_code, again.content), (201, first.content))
            self.assertEqual(len(stage.post.recorded()), 1)


class Held(unittest.TestCase):

    def test_what_waits_when_a_new_run_begins(self):
        with playing() as stage:
            wait_until(lambda: stage.post.control("GET /record")["run_clock"] > 1.5, "the run to go on")
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            wait_until(lambda: stage.box.on_disk("SELECT remaining_reports FROM run") == [44], "the first to be counted")
            stage.post.will("429,retry-after=8")  # which is heeded by the box's next life, too
            left_unanswered(stage)
            wait_until(lambda: sendings(stage) == 1 and stage.box.on_disk() == ["answered", "waiting"], "it to be put off")
            stage.box.stop(signal.SIGKILL)
            stage.post.control("POST /new-run")
            stage.restart_box()
            wait_until(lambda: "a new run began (the reports left went up from 44 to 45" in stage.box.attention(), "it to be held")
            self.assertEqual(submit(stage, another(2)).json()["run"], "2", "what is posted now is for this run")
            self.assertEqual(stage.post.recorded(REPORT), [])
            held = next(row for row in stage.box.reports() if row["state"] == "received")
            self.assertEqual(stage.box.judge(held["number"], "send")[0], 200)
            wait_until(lambda: stage.post.recorded(REPORT), "the operator's word")
            self.assertEqual(stage.post.recorded(REPORT)[0]["run"], "2")
            self.assertEqual(stage.box.attention(), "")


class Barred(unittest.TestCase):
    def test_a_token_that_is_refused_for_a_while(self):
        with playing(reports__answer_within_ms=600000) as stage:
            stage.post.will("401", status=["401,for=4"])  # for seconds, so that it is seen on a busy machine, too
            told = submit(stage)  # which waits for less than ten minutes: it is told at once
            self.assertEqual(told.status_code, 503)
            self.assertIn("is kept and waiting", told.json())
            self.assertNotIn("WWW-Authenticate", told.headers)
            wait_until(lambda: "scoring token is refused" in stage.box.attention(), "that to be told")
            wait_until(lambda: stage.post.recorded(REPORT), "the token to be accepted again")
            again = submit(stage)
            self.assertEqual((again.status_code, again.json()["score_change"]), (201, 1))
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (1, 2))
            wait_until(lambda: stage.box.attention() == "", "nothing to be left to do")
