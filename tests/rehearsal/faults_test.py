"""Faults that a Command Post can be ordered to make with a request, over real sockets."""

import json
import unittest
from concurrent.futures import ThreadPoolExecutor

import requests

from command_post import CommandPost, grid
from faulted import REPORT, REPORT_BYTES, OneRequest, exchange, recorded
from patience import wait_until


class OneFault(OneRequest):
    def test_faults_end_the_connection_and_record_or_not(self):
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

    def test_garbage_is_not_http(self):
        self.post.faults(reports=["garbage"])
        received, end = exchange(self.post.scoring)
        self.assertEqual((end, recorded(self.post)), ("closed", 1))
        self.assertGreater(len(received), 8)
        self.assertFalse(received.startswith(b"HTTP/"))

    def test_rejections_are_not_recorded(self):
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

    def test_html_pages_are_not_recorded(self):
        for status in (200, 302, 400, 422):
            with self.subTest(status):
                self.post.faults(reports=[f"html-{status}"])
                received, _ = exchange(self.post.scoring)
                self.assertTrue(received.startswith(f"HTTP/1.1 {status} ".encode()), received[:40])
                self.assertIn(b"Content-Type: text/html", received)
                self.assertIn(b"Log in to the network", received)
                self.assertEqual(recorded(self.post), 0)

    def test_answers_that_would_crash_a_client_are_sent_and_recorded(self):
        table = {"length-huge": b"Content-Length: 30000000000\r\n", "chunk-huge": b"\r\n6fc23ac00\r\n",
                 "header-flood": b"X-Flood: ", "endless-body": b"[0,0,", "1xx-flood": b"HTTP/1.1 100 Continue\r\n\r\nHTTP",
                 "json-deep": b"[[[["}
        for number, (fault, part) in enumerate(table.items(), 1):
            with self.subTest(fault):
                self.post.faults(reports=[fault])
                received, _ = exchange(self.post.scoring)
                self.assertIn(part, received)
                self.assertEqual(recorded(self.post), number)

    def test_record_and_transcript_have_each_counted_report(self):
        allotment = self.post.status().json()["remaining_reports"]
        for number in range(1, 6):
            self.post.faults(reports=["endless-body"])  # 4 MiB take a while to make
            with ThreadPoolExecutor(1) as pool:
                answer = pool.submit(exchange, self.post.scoring)
                left = allotment - number
                wait_until(lambda: self.post.status().json()["remaining_reports"] == left, "a status that counts it", every=0)
                record = self.post.record()
                self.assertEqual((record["remaining_reports"], record["report_count"]), (left, number))
                self.assertEqual(answer.result()[1], "closed")
        written = 0
        for line in self.post.lines():
            if line["uri"] == "/api/artifact_reports":
                written += 1
            else:
                self.assertEqual(json.loads(line["answer"])["remaining_reports"], allotment - written)

    def test_fault_may_be_limited_to_one_robot(self):
        self.post.faults(reports=["500,robot=Backpack"])
        self.assertEqual(self.post.report({**REPORT, "type": "Rope"}).status_code, 201)
        self.assertEqual(self.post.faults_left()["reports"], ["500,robot=Backpack"])
        self.assertEqual(self.post.report({**REPORT, "type": "Backpack"}).status_code, 500)
        self.assertEqual(self.post.faults_left()["reports"], [])

    def test_invalid_reports_are_not_recorded_with_any_fault(self):
        self.post.faults(reports=["record-then-drop"])
        self.assertEqual(exchange(self.post.scoring, REPORT_BYTES.replace(b"Drill", b"Spoon")), (b"", "closed"))
        record = self.post.record()
        self.assertEqual((record["report_count"], record["violation_count"]), (0, 1))

    def test_invalid_request_takes_no_fault(self):
        self.post.faults(reports=["drop"])
        exchange(self.post.scoring, b"hello\r\n\r\n")
        self.assertEqual(self.post.scoring_request("GET", "/nowhere").status_code, 404)
        self.assertEqual(self.post.faults_left()["reports"], ["drop"])


class Aims(unittest.TestCase):
    def test_each_aim_has_its_own_queue(self):
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

    def test_an_answer_is_repeated_and_nothing_is_recorded(self):
        with CommandPost("--fault", "reports:repeat-answer") as post:
            with self.assertRaises(requests.ConnectionError):
                post.report(REPORT)  # there is none before it
            first = post.report(REPORT)
            post.faults(reports=["repeat-answer", "ok"], mapping=["ok", "repeat-answer"])
            again, other = [post.report({**REPORT, "type": "Backpack"}) for _ in range(2)]
            self.assertEqual((again.status_code, again.json()), (201, first.json()))
            self.assertEqual(other.json()["type"], "Backpack")
            self.assertEqual([report["type"] for report in post.record()["reports"]], [REPORT["type"], "Backpack"])
            self.assertEqual([post.map(grid()).status_code for _ in range(2)], [200, 200])
            self.assertEqual([part["count"] for part in post.record()["accepted"] if part["kind"] == "grid"], [1])

    def test_rejections_as_measured_are_those_of_its_servers(self):
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
