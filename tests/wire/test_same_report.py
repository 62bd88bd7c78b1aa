"""The same report again is the same report; what is held for the operator; what a repeat does after each of the Command
Post's answers, and in a new run."""

import contextlib
import signal
import time
import unittest

import hosts
import programs
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, at_once, began, is_taken, left_unanswered, sendings, submit


def setUpModule():
    hosts.needs_namespaces()


def moved(metres):
    """As REPORT, so far from it."""
    return {**REPORT, "y": REPORT["y"] + metres}


@contextlib.contextmanager
def playing(*options, **overrides):
    with Stage(post_options=("--rate", "0", *options), **{**QUICK, **overrides}) as stage:
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

    def test_a_deliberate_repeat_is_asked_for(self):
        with playing() as stage:
            first = submit(stage)
            repeated = submit(stage, Adit_Resubmit="Yes")
            self.assertEqual(repeated.status_code, 201)
            self.assertNotEqual(repeated.json()["id"], first.json()["id"])
            self.assertEqual(len(stage.post.recorded()), 2)
            self.assertEqual(submit(stage).content, repeated.content, "the latest of the same")
            refused = submit(stage, Adit_Resubmit="please")
            self.assertEqual(refused.status_code, 422)
            self.assertIn("Adit-Resubmit", refused.json())
            self.assertEqual(stage.box.judge(int(first.headers["Adit-Report"]), "resubmit"), (200, {"report": 3}))
            wait_until(lambda: len(stage.post.recorded()) == 3, "the operator's repeat")

    def test_what_a_repeat_does_after_an_answer_that_did_not_score(self):
        for said, options, action, is_new in (("run not started", ["--not-started"], None, True),
                                            ("admin stop", [], "POST /stop", True),
                                            ("report limit exceeded", ["--reports", "0"], None, False),
                                            ("time limit exceeded", [], "POST /end", False)):
            with self.subTest(said), playing(*options) as stage:
                if action is not None:
                    stage.post.control(action)
                first, repeated = submit(stage), submit(stage)
                self.assertEqual([first.status_code, repeated.status_code], [201, 201])
                self.assertEqual([first.json()["report_status"], repeated.json()["report_status"]], [said, said])
                self.assertEqual(repeated.content != first.content, is_new)
                self.assertEqual(len(stage.post.recorded()), 2 if is_new else 1)

    def test_a_repeat_after_the_stop_is_scored(self):
        with playing() as stage:
            stage.post.control("POST /stop")
            self.assertEqual(submit(stage).json()["report_status"], "admin stop")
            stage.post.control("POST /resume")
            self.assertEqual(submit(stage).json()["score_change"], 1)
            self.assertEqual(submit(stage).json()["report_status"], "scored")
            self.assertEqual(len(stage.post.recorded()), 2)


class Held(unittest.TestCase):
    def is_held(self, stage, report, why):
        told = submit(stage, report)
        self.assertEqual(told.status_code, 503, told.text)
        self.assertIn("waits for the operator's word", told.json())
        self.assertIn(why, told.json())
        number = int(told.headers["Adit-Report"])
        self.assertIn(f"report {number} is held: ", stage.box.attention())
        self.assertIn(why, stage.box.attention())
        self.assertEqual(stage.post.recorded(report), [])
        return number

    def test_near_duplicates(self):
        with playing(reports__review="duplicates", reports__answer_within_ms=2000) as stage:
            for report in (REPORT, moved(5.1), {**moved(1), "type": "Drill"}):
                is_taken(stage, report)
            number = self.is_held(stage, moved(2), "the same type as report ")
            self.assertIn(" m from it", stage.box.attention())
            self.assertEqual(stage.box.judge(number, "send"), (200, {"report": number}))
            is_taken(stage, moved(2))
            self.assertEqual(len(stage.post.recorded()), 4)
            self.assertEqual(stage.box.attention(), "")

    def test_every_report(self):
        with playing(reports__review="all", reports__answer_within_ms=2000) as stage:
            first = self.is_held(stage, another(1), "every report is reviewed")
            second = self.is_held(stage, another(2), "every report is reviewed")
            self.assertEqual(stage.box.judge(first, "withdraw")[0], 200)
            submit(stage, another(2), Adit_Resubmit="yes")
            wait_until(lambda: stage.post.recorded(another(2)), "what was asked for")
            self.assertEqual(stage.box.judge(second, "withdraw")[0], 200)
            self.assertEqual([made["x"] for made in stage.post.recorded()], [20])

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

    def test_a_new_run_that_the_operator_declares(self):
        with Stage(post_options=None, **{**QUICK, "reports__answer_within_ms": 300}) as stage:
            self.assertEqual(submit(stage).status_code, 503)
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()  # what was posted to the service before is old
            headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"}
            self.assertEqual(stage.box.ask("POST /adit/runs", headers), (200, {"run": 2}))
            self.assertIn("a new run began (the operator says so)", stage.box.attention())
            stage.post = programs.CommandPost(stage.network, stage.folder, "--rate", "0")
            wait_until(stage.box.knows_the_run, "the run to be known")
            time.sleep(0.5)
            self.assertEqual(stage.post.recorded(), [])

    def test_the_same_report_in_a_new_run_is_a_new_report(self):
        with playing() as stage:
            wait_until(lambda: stage.post.control("GET /record")["run_clock"] > 1.5, "the run to go on")
            first = submit(stage)
            wait_until(lambda: stage.box.ask("GET /adit/run")[1]["run"]["remaining_reports"] == 44, "it to be counted")
            stage.post.control("POST /new-run")
            wait_until(lambda: stage.box.ask("GET /adit/run")[1]["run_number"] == 2, "the new run to be noticed")
            second = submit(stage)
            self.assertEqual([first.json()["run"], second.json()["run"]], ["1", "2"])
            self.assertEqual(len(stage.post.recorded()), 2)


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
