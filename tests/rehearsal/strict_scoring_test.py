"""The scoring endpoint of a strict Command Post: ICD 4 and 5."""

import datetime
import time
import unittest

from command_post import DROP, SCORING_TOKEN, CommandPost, changed, two_at_once

ARTIFACTS = "type,x,y,z\nBackpack,10,0,0\nCell Phone,20,5,-1\nBackpack,10,1,0\n"
REPORT = {"x": 10.0, "y": 3.0, "z": 4.0, "type": "backpack"}  # 5 m from the first


class Status(unittest.TestCase):
    def test_has_the_four_members_of_icd_5_1(self):
        with CommandPost("--team", "SubT", "--reports", "12") as post:
            answer = post.status()
            self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (200, "application/json"))
            body = answer.json()
            self.assertLess(0, body.pop("run_clock"))
            self.assertEqual(body, {"score": 0, "remaining_reports": 12, "current_team": "subt"})


class Reports(unittest.TestCase):
    def test_answer_has_the_members_of_icd_5_2(self):
        with CommandPost("--run", "1.5.2", artifacts=ARTIFACTS) as post:
            answer = post.report({**REPORT, "name": "robot1"})
            self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (201, "application/json"))
            body = answer.json()
            self.assertIsNotNone(datetime.datetime.fromisoformat(body.pop("submitted_datetime")).tzinfo)
            self.assertLess(0, body.pop("run_clock"))
            self.assertEqual(body, {"url": f"http://{post.scoring}/api/artifact_reports/1", "id": 1, **REPORT,
                                    "team": "adit", "run": "1.5.2", "report_status": "scored",
                                    "score_change": 1})

    def test_an_artifact_scores_once_within_5_m_and_only_for_its_type(self):
        table = [
            ("Backpack", 10, 0, 5.01, 0),   # too far
            ("Cell Phone", 10, 0, 0, 0),    # another type
            ("BACKPACK", 10, 0, 0, 1),
            ("backpack", 10, 0, 0, 1),      # the other one, 1 m away
            ("backpack", 10, 0, 0, 0),      # none left
            ("cell phone", 20, 5, -1, 1),
        ]
        with CommandPost(artifacts=ARTIFACTS) as post:
            for kind, x, y, z, change in table:
                with self.subTest(kind=kind, z=z):
                    body = post.report({"x": x, "y": y, "z": z, "type": kind}).json()
                    self.assertEqual((body["report_status"], body["score_change"]), ("scored", change))
            status = post.status().json()
            self.assertEqual((status["score"], status["remaining_reports"]), (3, 45 - len(table)))

    def test_status_of_a_report_follows_the_run(self):
        with CommandPost("--not-started", "--reports", "2", artifacts=ARTIFACTS) as post:
            def submit():
                answer = post.report(REPORT)
                self.assertEqual(answer.status_code, 201)
                body = answer.json()
                return body["report_status"], body["score_change"], post.status().json()["remaining_reports"]

            self.assertEqual(submit(), ("run not started", 0, 2))
            self.assertEqual(post.status().json()["run_clock"], 0)
            self.assertEqual(post.tell("start").json(), {"state": "running"})
            self.assertEqual(submit(), ("scored", 1, 1))
            self.assertEqual(post.tell("stop").json(), {"state": "admin stop"})
            self.assertEqual(submit(), ("admin stop", 0, 1))
            self.assertEqual(post.tell("resume").json(), {"state": "running"})
            self.assertEqual(submit(), ("scored", 1, 0))
            self.assertEqual(submit(), ("report limit exceeded", 0, 0))
            self.assertEqual(post.tell("end").json(), {"state": "ended"})
            self.assertEqual(submit(), ("time limit exceeded", 0, 0))
            self.assertEqual([report["id"] for report in post.record()["reports"]], [1, 2, 3, 4, 5, 6])
            for action in ("start", "stop", "resume", "end"):
                self.assertEqual(post.tell(action).status_code, 409)

    def test_the_referee_grants_a_report_of_this_run(self):
        with CommandPost("--reports", "1") as post:
            self.assertEqual(post.report(REPORT).json()["report_status"], "scored")
            self.assertEqual(post.tell("grant").json(), {"remaining_reports": 1})
            self.assertEqual(post.report({**REPORT, "x": 9.0}).json()["report_status"], "scored")
            self.assertEqual(post.report({**REPORT, "x": 8.0}).json()["report_status"], "report limit exceeded")
            post.tell("new-run")
            self.assertEqual(post.status().json()["remaining_reports"], 1)

    def test_tells_the_same_report_twice_in_a_run(self):
        with CommandPost() as post:
            post.tell("stop")
            post.report(REPORT)  # not scored
            post.tell("resume")
            post.report(REPORT)
            post.report({**REPORT, "x": 9.0})
            self.assertEqual(post.record()["violation_count"], 0)
            self.assertEqual(post.report({**REPORT, "type": "BACKPACK"}).status_code, 201)
            self.assertEqual([each["sentence"] for each in post.record()["violations"]],
                             ["the same report as report 2 of this run"])
            post.tell("new-run")
            post.report(REPORT)
            self.assertEqual(post.record()["violation_count"], 1)

    def test_tells_a_status_right_behind_an_answered_report(self):
        for faults, told in (([], 1), (["record-then-drop"], 0)):
            with self.subTest(faults), CommandPost(rate=0.001) as post:
                post.faults(reports=faults)
                try:
                    post.report(REPORT)
                except Exception:  # pylint: disable=broad-exception-caught
                    self.assertTrue(faults)
                self.assertEqual(post.status().status_code, 200)
                self.assertEqual(post.record()["violation_count"], told)

    def test_a_run_ends_after_its_duration(self):
        with CommandPost("--duration", "0.2") as post:
            time.sleep(0.3)
            self.assertEqual(post.report(REPORT).json()["report_status"], "time limit exceeded")


class Refusals(unittest.TestCase):
    def test_each_has_its_status_and_a_json_string(self):
        bearer = f"Bearer {SCORING_TOKEN}"
        table = [
            (404, "GET", "/", None, {}),
            (404, "GET", "/api/status/", None, {}),
            (404, "POST", "/api/status", REPORT, {}),
            (404, "GET", "/api/artifact_reports", None, {}),
            (404, "OPTIONS", "/api/artifact_reports", None, {}),
            (404, "POST", "/map/update", REPORT, {}),
            (401, "GET", "/api/status", None, {"Authorization": None}),
            (401, "GET", "/api/status", None, {"Authorization": bearer.replace("Bearer", "bearer")}),
            (401, "GET", "/api/status", None, {"Authorization": bearer + "x"}),
            (401, "GET", "/api/status", None, {"Authorization": bearer[:-1]}),
            (401, "GET", "/api/status", None, {"Authorization": SCORING_TOKEN}),
            (422, "POST", "/api/artifact_reports", REPORT, {"Content-Type": "application/json; charset=utf-8"}),
            (422, "POST", "/api/artifact_reports", REPORT, {"Content-Type": "application/cbor"}),
            (422, "POST", "/api/artifact_reports", REPORT, {"Content-Type": None}),
            (422, "POST", "/api/artifact_reports", REPORT, {"Content-Encoding": "gzip"}),
            *((400, "POST", "/api/artifact_reports", body, {}) for body in (
                b"", b"{", b'{"x": 01}', b'{"x": 1}}', b'{"x": NaN}', b'{"x": 1e999}', b'\xef\xbb\xbf{"x": 1}',
                b'{"x": "\x01"}', b'{"x": "\\ud800"}', b'{"x": "\xff"}', b'{"x": 1}\0', b"[" * 65 + b"]" * 65,
                b"[" * 1_000_000)),
            *((422, "POST", "/api/artifact_reports", body, {}) for body in (
                [], "text", 7, changed(REPORT, x=DROP), changed(REPORT, type=DROP), changed(REPORT, y="3.0"),
                changed(REPORT, z=None), changed(REPORT, type=5), changed(REPORT, type="Test"),
                changed(REPORT, name=5), changed(REPORT, name="no robot"),
                b'{"x": 1, "x": 2, "y": 0, "z": 0, "type": "Drill"}')),
        ]
        with CommandPost(artifacts=ARTIFACTS) as post:
            for status, method, path, body, headers in table:
                with self.subTest(method=method, path=path, body=str(body)[:60], headers=headers):
                    answer = post.scoring_request(method, path, body, headers)
                    self.assertEqual(answer.status_code, status)
                    self.assertEqual(answer.headers["Content-Type"], "application/json")
                    self.assertNotIn("WWW-Authenticate", answer.headers)
                    self.assertIsInstance(answer.json(), str)
            self.assertEqual(post.report(changed(REPORT, y=DROP)).json(), "Missing field 'y'")
            record = post.record()
            self.assertEqual((record["report_count"], record["remaining_reports"]), (0, 45))
            self.assertLessEqual(len(table), record["violation_count"])

    def test_more_than_one_a_second_for_a_uri_is_429(self):
        with CommandPost(rate=None) as post:
            answers = []

            def report():
                answers.append(post.report(REPORT))
                return answers[-1]

            self.assertEqual(two_at_once(post.status), [200, 429])
            self.assertEqual(two_at_once(report), [201, 429], "each URI has its own timer")
            self.assertIsInstance(answers[-1].json(), str)
            time.sleep(1)
            self.assertEqual(report().status_code, 201, "one that was refused does not count")
            self.assertEqual(post.record()["report_count"], sum(answer.status_code == 201 for answer in answers))

    def test_common_limit_over_statuses_and_reports_is_429(self):
        def report():
            return post.report(REPORT)

        for manner in ((), ("--as-measured",)):
            with self.subTest(manner), CommandPost(*manner, rate="api") as post:
                self.assertEqual(two_at_once(post.status, report), [200, 429])
                time.sleep(1)
                self.assertEqual(two_at_once(report, post.status), [201, 429])
                time.sleep(1)
                self.assertEqual(two_at_once(post.status), [200, 429])
                time.sleep(1)
                self.assertEqual(two_at_once(report), [201, 429])

    def test_a_rate_is_a_number_or_api(self):
        for rate in ("apis", "-1", ""):
            with self.subTest(rate), self.assertRaisesRegex(RuntimeError, "--rate"), CommandPost(rate=rate):
                pass
