"""What a Command Post can be told to do wrong, request by request, over real sockets."""

import json
import select
import socket
import subprocess
import time
import unittest

import requests

from command_post import SCORING_TOKEN, CommandPost, connect, grid, read_answer

REPORT = {"x": 1.5, "y": -2.0, "z": 0.25, "type": "Drill"}
BODY = json.dumps(REPORT).encode()
REPORT_BYTES = (f"POST /api/artifact_reports HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {SCORING_TOKEN}\r\n"
                f"Content-Type: application/json\r\nContent-Length: {len(BODY)}\r\n\r\n").encode() + BODY
STATUS_BYTES = f"GET /api/status HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {SCORING_TOKEN}\r\n\r\n".encode()


def exchange(where, sent=REPORT_BYTES):
    """All the bytes that come back until the connection ends, and "closed" or "reset": how it ended."""
    received = b""
    with connect(where) as stream:
        stream.sendall(sent)
        try:
            while piece := stream.recv(65536):
                received += piece
        except ConnectionResetError:
            return received, "reset"
    return received, "closed"


def recorded(post, report=None):
    """How often the record has that report from the client."""
    report = report or REPORT
    return sum(1 for one in post.record()["reports"]
               if one["by"] == "client" and all(one[name] == value for name, value in report.items()))


class OneRequest(unittest.TestCase):
    def setUp(self):
        self.post = self.enterContext(CommandPost(transcript=True))

    def fault_of_last_line(self):
        return self.post.lines()[-1]["rehearsed_fault"]

    def expect_before(self, end, is_so, why):
        """Unless `end` has come: this machine may do much besides."""
        self.assertTrue(is_so() or time.monotonic() >= end, why)

    def wait_until_recorded(self):
        deadline = time.monotonic() + 30
        while not recorded(self.post):
            self.assertLess(time.monotonic(), deadline, "never recorded")
            time.sleep(0.02)

    def test_how_the_connection_ends_and_whether_the_report_is_recorded(self):
        table = [("record-then-drop", 1, "closed"), ("drop", 0, "closed"),
                 ("reset", 1, "reset"), ("reset-unrecorded", 0, "reset")]
        for fault, count, end in table:
            with self.subTest(fault):
                before = recorded(self.post)
                self.post.faults(reports=[fault])
                self.assertEqual(exchange(self.post.scoring), (b"", end))
                self.assertEqual(recorded(self.post) - before, count)
                line = self.post.lines()[-1]
                self.assertEqual((line["rehearsed_fault"], line["status"], line["answer"]), (fault, None, None))
                self.assertEqual(line["message"], REPORT, "which report it was can be seen all the same")

    def test_half_an_answer_is_the_first_half_of_the_true_one(self):
        self.post.faults(reports=["half-answer"])
        received, end = exchange(self.post.scoring)
        self.assertEqual(end, "closed")
        head, _, body = received.partition(b"\r\n\r\n")
        self.assertTrue(head.startswith(b"HTTP/1.1 201 Created\r\nContent-Length: "))
        length = int(head.split(b"Content-Length: ")[1].split(b"\r\n")[0])
        self.assertEqual(len(received), (len(head) + 4 + length) // 2)
        self.assertTrue(body.startswith(b'{"url":'))
        self.assertEqual(recorded(self.post), 1)

    def test_garbage_is_no_http(self):
        self.post.faults(reports=["garbage"])
        received, end = exchange(self.post.scoring)
        self.assertEqual((end, recorded(self.post)), ("closed", 1))
        self.assertGreater(len(received), 8)
        self.assertFalse(received.startswith(b"HTTP/"))

    def test_refusals_are_not_recorded(self):
        for fault, status in (("401", 401), ("429", 429)):
            with self.subTest(fault):
                self.post.faults(reports=[fault])
                answer = self.post.report(REPORT)
                self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (status, "application/json"))
                self.assertIsInstance(answer.json(), str)
                self.assertEqual((recorded(self.post), self.fault_of_last_line()), (0, fault))
        self.assertEqual(self.post.record()["violation_count"], 0)
        self.assertEqual(self.post.report(REPORT).status_code, 201)

    def test_500_is_html_recorded_or_not(self):
        for fault, count in (("500", 0), ("500-recorded", 1)):
            with self.subTest(fault):
                self.post.faults(reports=[fault])
                answer = self.post.report(REPORT)
                self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (500, "text/html"))
                self.assertIn("<html", answer.text)
                self.assertEqual((recorded(self.post), self.fault_of_last_line()), (count, fault))

    def test_a_storm_lasts_for_as_many_requests_as_were_said(self):
        self.post.faults(reports=["429=3,retry-after=2"])
        answers = []
        for left in (["429=2,retry-after=2"], ["429,retry-after=2"], [], []):
            answers.append(self.post.report(REPORT))
            self.assertEqual(self.post.faults_left()["reports"], left)
        self.assertEqual([answer.status_code for answer in answers], [429, 429, 429, 201])
        self.assertEqual([answer.headers.get("Retry-After") for answer in answers], ["2", "2", "2", None])
        self.assertEqual(recorded(self.post), 1)

    def test_answer_after_records_at_once_and_answers_late(self):
        self.post.faults(reports=["answer-after=1.5"])
        begun = time.monotonic()
        with connect(self.post.scoring) as stream:
            stream.sendall(REPORT_BYTES)
            self.wait_until_recorded()
            self.expect_before(begun + 1.5, lambda: not select.select([stream], [], [], 0)[0], "the client still waits")
            self.assertEqual(read_answer(stream)[0], 201)
        self.assertGreaterEqual(time.monotonic() - begun, 1.5)
        self.assertEqual(recorded(self.post), 1)

    def test_record_after_records_late_and_then_answers(self):
        self.post.faults(reports=["record-after=1.5"])
        begun = time.monotonic()
        with connect(self.post.scoring) as stream:
            stream.sendall(REPORT_BYTES)
            time.sleep(0.3)
            self.expect_before(begun + 1.5, lambda: not recorded(self.post), "it is recorded late")
            status, _, body = read_answer(stream)
        self.assertGreaterEqual(time.monotonic() - begun, 1.5)
        self.assertEqual((status, recorded(self.post)), (201, 1))
        self.assertIn(b'"report_status":"scored"', body)

    def test_record_after_records_though_the_client_is_gone(self):
        self.post.faults(reports=["record-after=1.5"])
        begun = time.monotonic()
        with connect(self.post.scoring) as stream:
            stream.sendall(REPORT_BYTES)
        time.sleep(0.2)
        self.expect_before(begun + 1.5, lambda: not recorded(self.post), "it is recorded late")
        self.wait_until_recorded()
        self.assertEqual(recorded(self.post), 1)
        self.assertEqual(self.fault_of_last_line(), "record-after=1.5")

    def test_a_wrong_count_lasts_and_is_wrong_in_the_answer_alone(self):
        self.post.faults(status=["ok", "remaining=+2"])
        seen = [self.post.status().json()["remaining_reports"] for _ in range(3)]
        self.assertEqual(seen, [45, 47, 47])
        self.post.report(REPORT)
        self.assertEqual(self.post.status().json()["remaining_reports"], 46)
        self.assertEqual(self.post.record()["remaining_reports"], 44)
        self.assertEqual([line["rehearsed_fault"] for line in self.post.lines()],
                         [None, "remaining=+2", "remaining=+2", None, "remaining=+2"])
        self.post.faults(reports=["remaining=-3"])
        self.post.report(REPORT)
        self.assertEqual(self.post.status().json()["remaining_reports"], 40)
        self.post.faults(status=["remaining=+0"])
        self.assertEqual([self.post.status().json()["remaining_reports"] for _ in range(2)], [43, 43])

    def test_another_sender_comes_just_before(self):
        self.post.faults(reports=["other-sender"], status=["other-sender"])
        self.assertEqual(self.post.report(REPORT).json()["id"], 2)
        self.assertEqual(self.post.status().json()["remaining_reports"], 42)
        reports = self.post.record()["reports"]
        self.assertEqual([(one["id"], one["by"], one["request"]) for one in reports],
                         [(1, "other sender", None), (2, "client", 1), (3, "other sender", None)])
        self.assertEqual([line["by"] for line in self.post.lines("reports.jsonl")],
                         ["other sender", "client", "other sender"])

    def test_faults_go_together(self):
        faults = ["other-sender,record-then-drop", "record-after=0.2,reset", "answer-after=0.2,half-answer"]
        self.post.faults(reports=faults)
        self.assertEqual(exchange(self.post.scoring), (b"", "closed"))
        for end in ("reset", "closed"):
            begun = time.monotonic()
            received, how = exchange(self.post.scoring)
            self.assertGreaterEqual(time.monotonic() - begun, 0.2)
            self.assertEqual((how, bool(received)), (end, end == "closed"))
        self.assertEqual((recorded(self.post), self.post.record()["remaining_reports"]), (3, 41))
        self.assertEqual([line["rehearsed_fault"] for line in self.post.lines()], faults)

    def test_what_the_judge_refuses_is_not_recorded_whatever_the_fault(self):
        self.post.faults(reports=["record-then-drop"])
        self.assertEqual(exchange(self.post.scoring, REPORT_BYTES.replace(b"Drill", b"Spoon")), (b"", "closed"))
        record = self.post.record()
        self.assertEqual((record["report_count"], record["violation_count"]), (0, 1))

    def test_a_request_that_is_none_takes_no_fault(self):
        self.post.faults(reports=["drop"])
        exchange(self.post.scoring, b"hello\r\n\r\n")
        self.assertEqual(self.post.scoring_request("GET", "/nowhere").status_code, 404)
        self.assertEqual(self.post.faults_left()["reports"], ["drop"])

    def test_requests_that_were_sent_at_once_meet_their_own_faults(self):
        self.post.faults(status=["500", "answer-after=0.1", "drop"])
        received, end = exchange(self.post.scoring, STATUS_BYTES * 4)
        self.assertEqual((received.count(b"HTTP/1.1 500"), received.count(b"HTTP/1.1 200"), end), (1, 1, "closed"))


class Aims(unittest.TestCase):
    def test_each_aim_has_a_queue_of_its_own(self):
        with CommandPost() as post:
            post.faults(reports=["ok", "429"], status=["500"], mapping=["401", "500-recorded"])
            self.assertEqual(post.status().status_code, 500)
            self.assertEqual([post.report(REPORT).status_code for _ in range(3)], [201, 429, 201])
            self.assertEqual([post.map(grid()).status_code for _ in range(3)], [401, 500, 200])
            self.assertEqual(post.status().status_code, 200)
            record = post.record()
            self.assertEqual(record["faults"], [
                {"uri": "/api/artifact_reports", "fault": "429", "count": 1},
                {"uri": "/api/status", "fault": "500", "count": 1},
                {"uri": "/map/update", "fault": "401", "count": 1},
                {"uri": "/map/update", "fault": "500-recorded", "count": 1}])
            self.assertEqual([(part["kind"], part["count"]) for part in record["accepted"]],
                             [("report", 2), ("grid", 2)])

    def test_maps_are_cut_off_as_reports_are(self):
        with CommandPost() as post:
            post.faults(mapping=["drop", "record-then-drop", "reset"])
            for taken in (0, 1, 2):
                with self.assertRaises(requests.ConnectionError):
                    post.map(grid())
                self.assertEqual(sum(part["count"] for part in post.record()["accepted"]), taken)

    def test_as_measured_the_refusals_are_those_of_its_servers(self):
        with CommandPost("--as-measured") as post:
            post.faults(reports=["401", "429"], mapping=["401", "429"])
            answer = post.scoring_request("POST", "/api/artifact_reports/", REPORT)
            self.assertEqual((answer.status_code, list(answer.json())), (401, ["detail"]))
            self.assertIn("WWW-Authenticate", answer.headers)
            answer = post.report(REPORT)
            self.assertEqual((answer.status_code, list(answer.json())), (429, ["detail"]))
            self.assertEqual(post.map(grid()).status_code, 401)
            answer = post.map(grid())
            self.assertEqual((answer.status_code, answer.json()),
                             (429, "Cloud updates too frequent. Reduce to <1Hz."))
            self.assertEqual(post.record()["accepted"], [])


class Telling(unittest.TestCase):
    def test_faults_wait_in_the_order_they_were_told_until_they_are_cleared(self):
        with CommandPost("--fault", "reports:ok", "--fault", "status:remaining=-1", "--fault-rate",
                         "mapping:answer-after=2.5=0.25") as post:
            post.faults(reports=["record-then-drop", "429=3"], mapping=[])
            self.assertEqual(post.faults_left(), {
                "reports": ["ok", "record-then-drop", "429=3"], "status": ["remaining=-1"], "mapping": [],
                "rates": [{"aim": "mapping", "fault": "answer-after=2.5", "rate": 0.25}], "remaining_offset": 0})
            self.assertEqual(post.status().json()["remaining_reports"], 44)
            self.assertEqual(post.faults_left()["remaining_offset"], -1)
            answer = post.request(post.control, "DELETE", "/faults", None, {})
            self.assertEqual(answer.json(), {"reports": [], "status": [], "mapping": [], "rates": [],
                                             "remaining_offset": 0})
            self.assertEqual(post.status().json()["remaining_reports"], 45)
            self.assertEqual(post.report(REPORT).status_code, 201)

    def test_what_is_not_understood_is_named_and_nothing_of_it_waits(self):
        table = [
            ({"reports": ["drop", "record-then-dorp"]}, "reports[1]: no such fault: 'record-then-dorp'"),
            ({"report": ["drop"]}, "no such aim: 'report'; there are reports, status, mapping"),
            ({"status": "500"}, "status: expected an array"),
            ({"status": [500]}, "status[0]: expected a text"),
            (["drop"], "expected an object"),
            (None, "expected an object"),
            ({"reports": [""]}, "no such fault: ''"),
            ({"reports": ["drop,"]}, "no such fault: ''"),
            ({"reports": ["ok,drop"]}, "no such fault: 'ok'"),
            ({"reports": ["drop,reset"]}, "'reset' cannot happen to a request together with 'drop'"),
            ({"reports": ["drop=1"]}, "'drop' takes no '='"),
            ({"reports": ["other-sender=2"]}, "'other-sender' takes no '='"),
            ({"reports": ["429=0"]}, "429: expected how many requests, from 1 to 10000, as in 429=3, got '0'"),
            ({"reports": ["429=x"]}, "got 'x'"),
            ({"reports": ["answer-after"]}, "answer-after: expected seconds from 0 to 3600"),
            ({"reports": ["record-after=nan"]}, "record-after: expected seconds from 0 to 3600"),
            ({"reports": ["record-after=-1"]}, "got '-1'"),
            ({"reports": ["answer-after=1,answer-after=2"]}, "'answer-after' is given twice"),
            ({"status": ["remaining=2"]}, "remaining: expected an offset with its sign"),
            ({"status": ["remaining=+"]}, "remaining: expected an offset with its sign"),
            ({"status": ["remaining=+-2"]}, "remaining: expected an offset with its sign"),
            ({"status": ["retry-after=1.5"]}, "retry-after: expected whole seconds"),
            ({"reports": ["drop"] * 10_001}, "no more than 10000 faults can wait"),
        ]
        with CommandPost() as post:
            for told, sentence in table:
                with self.subTest(told=str(told)[:60]):
                    answer = post.request(post.control, "POST", "/faults", told, {})
                    self.assertEqual(answer.status_code, 422)
                    self.assertIn(sentence, answer.json())
                    self.assertEqual(post.faults_left()["reports"], [])
            self.assertEqual(post.request(post.control, "POST", "/faults", b"{", {}).status_code, 400)
            self.assertEqual(post.request(post.control, "PUT", "/faults", {}, {}).status_code, 404)

    def test_the_command_line_is_read_as_strictly(self):
        table = [
            (["--fault", "reports:dorp"], "--fault: reports: no such fault: 'dorp'"),
            (["--fault", "drop"], "--fault: expected an aim and a fault"),
            (["--fault", "maps:drop"], "--fault: no such aim: 'maps'"),
            (["--fault-rate", "reports:drop"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=1.5"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=nan"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=0.6", "--fault-rate", "reports:reset=0.6"],
             "--fault-rate: reports: the rates come to more than 1"),
            (["--seed", "x"], "--seed: cannot take 'x'"),
        ]
        with CommandPost() as post:
            for more, sentence in table:
                with self.subTest(more=more):
                    done = subprocess.run([*post.command, *more], capture_output=True, text=True, timeout=30,
                                          check=False)
                    self.assertEqual(done.returncode, 2)
                    self.assertIn(sentence, done.stderr)

    def test_at_random_by_rate_and_the_same_again_by_seed(self):
        def pattern(seed):
            with CommandPost("--fault-rate", "reports:500=0.3", "--fault-rate", "reports:429=0.3", "--seed",
                             seed, "--reports", "200") as post:
                statuses = [post.report(REPORT).status_code for _ in range(80)]
                self.assertEqual(post.status().status_code, 200, "status was not aimed at")
                self.assertEqual(recorded(post), statuses.count(201))
                return statuses

        first = pattern("7")
        self.assertEqual(pattern("7"), first)
        self.assertNotEqual(pattern("8"), first)
        for status, least, most in ((500, 10, 40), (429, 10, 40), (201, 15, 50)):
            self.assertTrue(least <= first.count(status) <= most, f"{status} x {first.count(status)}")

    def test_what_was_told_comes_before_what_is_random(self):
        with CommandPost("--fault-rate", "status:500=1", "--fault", "status:ok") as post:
            self.assertEqual([post.status().status_code for _ in range(3)], [200, 500, 500])


class Process(unittest.TestCase):
    def test_one_that_waits_does_not_hold_up_a_stop(self):
        with CommandPost() as post:
            post.faults(reports=["record-after=60", "answer-after=60"])
            streams = [connect(post.scoring) for _ in range(2)]
            for stream in streams:
                stream.sendall(REPORT_BYTES)
                stream.shutdown(socket.SHUT_WR)
            while not recorded(post):
                time.sleep(0.01)
            begun = time.monotonic()
            code, out, _ = post.stop()
            self.assertEqual(code, 0)
            self.assertLess(time.monotonic() - begun, 30)
            self.assertIn("reports: 1, ", out)
            for stream in streams:
                stream.close()

    def test_faults_are_in_what_is_printed(self):
        with CommandPost("--verbose", "--fault", "reports:other-sender,500") as post:
            post.report(REPORT)
            post.report(REPORT)
            _, out, _ = post.stop()
            self.assertIn('"POST /api/artifact_reports": 500 [other-sender,500]\n', out)
            self.assertIn('"POST /api/artifact_reports report ": 201\n', out)
            self.assertIn("  /api/artifact_reports: other-sender,500 (1 times)\n", out)
            self.assertIn("scored, 0, by another sender\n", out)


if __name__ == "__main__":
    unittest.main()
