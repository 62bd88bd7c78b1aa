"""Consecutive runs, other senders, and a record in which each report can be counted."""

import time
import unittest

from command_post import CommandPost

ARTIFACTS = "type,x,y,z\nBackpack,10,0,0\n"
REPORT = {"x": 10, "y": 1, "z": 0, "type": "Backpack"}


class NewRun(unittest.TestCase):
    def test_begins_with_everything_at_its_start(self):
        with CommandPost("--reports", "2", artifacts=ARTIFACTS) as post:
            self.assertEqual(post.report(REPORT).json()["score_change"], 1)
            post.report(REPORT)
            self.assertEqual(post.report(REPORT).json()["report_status"], "report limit exceeded")
            self.assertEqual(post.tell("end").status_code, 200)
            began = time.monotonic()
            self.assertEqual(post.tell("new-run").json(), {"state": "running", "run": "2", "team": "adit"})
            status = post.status().json()
            self.assertLess(status.pop("run_clock"), time.monotonic() - began + 0.001)
            self.assertEqual(status, {"score": 0, "remaining_reports": 2, "current_team": "adit"})
            body = post.report(REPORT).json()
            self.assertEqual((body["run"], body["score_change"], body["report_status"]), ("2", 1, "scored"))
            self.assertEqual([(one["run"], one["id"]) for one in post.record()["reports"]],
                             [("1", 1), ("1", 2), ("1", 3), ("2", 4)], "ids go on through all runs")

    def test_ids_count_up(self):
        for first, then in (("1", "2"), ("9", "10"), ("1.5.2", "1.5.3"), ("1.9", "1.10"), ("099", "100"),
                            ("practice", "practice-2"), ("practice-2", "practice-3")):
            with self.subTest(first), CommandPost("--run", first) as post:
                self.assertEqual(post.tell("new-run").json()["run"], then)

    def test_accepts_id_team_and_a_later_start(self):
        with CommandPost() as post:
            answer = post.tell("new-run", {"run": "7.1", "team": "Other", "started": False})
            self.assertEqual(answer.json(), {"state": "not started", "run": "7.1", "team": "Other"})
            status = post.status().json()
            self.assertEqual((status["run_clock"], status["current_team"]), (0, "other"))
            body = post.report(REPORT).json()
            self.assertEqual((body["report_status"], body["run"], body["team"]), ("run not started", "7.1", "other"))
            self.assertEqual(post.tell("start").json(), {"state": "running"})
            record = post.record()
            self.assertEqual((record["run"], record["team"], record["state"]), ("7.1", "Other", "running"))

    def test_invalid_order_changes_nothing(self):
        with CommandPost() as post:
            for body, sentence in (({"id": "2"}, "no such member: 'id'"), ({"run": 2}, "run: expected a text"),
                                   ({"team": ""}, "team: expected a text"), ([], "expected an object"),
                                   ({"started": 1}, "started: expected true or false")):
                with self.subTest(body=body):
                    answer = post.tell("new-run", body)
                    self.assertEqual(answer.status_code, 422)
                    self.assertIn(sentence, answer.json())
            self.assertEqual(post.record()["run"], "1")


class OtherSender(unittest.TestCase):
    def test_uses_one_of_the_allotment_and_scores_nothing(self):
        with CommandPost(artifacts=ARTIFACTS) as post:
            answers = [post.tell("other-sender") for _ in range(2)]
            self.assertEqual([answer.status_code for answer in answers], [201, 201])
            self.assertEqual({answer.json()["score_change"] for answer in answers}, {0})
            self.assertNotEqual(answers[0].json()["y"], answers[1].json()["y"])
            self.assertEqual(post.status().json()["remaining_reports"], 43)

    def test_with_its_own_report_it_scores_the_artifact(self):
        with CommandPost(artifacts=ARTIFACTS) as post:
            self.assertEqual(post.tell("other-sender", REPORT).json()["score_change"], 1)
            self.assertEqual(post.report(REPORT).json()["score_change"], 0)
            self.assertEqual(post.status().json()["score"], 1)
            for body in ([], {"x": 1}, {**REPORT, "x": "1"}, {**REPORT, "type": 1}):
                self.assertEqual(post.tell("other-sender", body).status_code, 422)
            self.assertEqual(post.record()["report_count"], 2)

    def test_follows_the_rules_of_the_run(self):
        with CommandPost("--not-started") as post:
            self.assertEqual(post.tell("other-sender").json()["report_status"], "run not started")
            post.tell("start")
            post.tell("stop")
            self.assertEqual(post.tell("other-sender").json()["report_status"], "admin stop")
            self.assertEqual(post.status().json()["remaining_reports"], 45)


class Record(unittest.TestCase):
    def test_has_each_report_with_its_result(self):
        with CommandPost("--run", "3", artifacts=ARTIFACTS, transcript=True) as post:
            post.status()
            post.report(REPORT)
            post.tell("other-sender", {**REPORT, "z": 2})
            post.report({**REPORT, "type": "Spoon"})
            post.report(REPORT)
            reports = post.record()["reports"]
            names = ("id", "request", "by", "type", "x", "y", "z", "run", "report_status", "score_change")
            self.assertEqual([tuple(report[name] for name in names) for report in reports], [
                (1, 2, "client", "Backpack", 10, 1, 0, "3", "scored", 1),
                (2, None, "other sender", "Backpack", 10, 1, 2, "3", "scored", 0),
                (3, 4, "client", "Backpack", 10, 1, 0, "3", "scored", 0)])
            self.assertEqual(post.lines("reports.jsonl"), reports)
            self.assertEqual([line["number"] for line in post.lines() if line["status"] == 201], [2, 4])
            self.assertEqual(post.record()["report_count"], 3)
