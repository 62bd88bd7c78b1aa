"""Faults that last, that come late, and that are combined; faults of the run itself."""

import select
import time

from command_post import connect, read_answer
from faulted import REPORT, REPORT_BYTES, STATUS_BYTES, OneRequest, exchange, recorded


class Times(OneRequest):
    def test_a_fault_may_last_for_a_time(self):
        self.post.faults(reports=["429,for=1.5"])
        begun = time.monotonic()
        statuses = []
        while not statuses or statuses[-1] != 201:
            statuses.append(self.post.report(REPORT).status_code)
            time.sleep(0.1)
        self.assertGreaterEqual(time.monotonic() - begun, 1.5)
        self.assertEqual(set(statuses[:-1]), {429})
        self.assertEqual(self.post.faults_left()["reports"], [])

    def test_storm_lasts_for_its_number_of_requests(self):
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

    def test_record_after_records_even_if_the_client_is_gone(self):
        self.post.faults(reports=["record-after=1.5"])
        begun = time.monotonic()
        with connect(self.post.scoring) as stream:
            stream.sendall(REPORT_BYTES)
        time.sleep(0.2)
        self.expect_before(begun + 1.5, lambda: not recorded(self.post), "it is recorded late")
        self.wait_until_recorded()
        self.assertEqual(recorded(self.post), 1)
        self.assertEqual(self.fault_of_last_line(), "record-after=1.5")

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

    def test_pipelined_requests_meet_their_own_faults(self):
        self.post.faults(status=["500", "answer-after=0.1", "drop"])
        received, end = exchange(self.post.scoring, STATUS_BYTES * 4)
        self.assertEqual((received.count(b"HTTP/1.1 500"), received.count(b"HTTP/1.1 200"), end), (1, 1, "closed"))


class TheRun(OneRequest):
    def test_wrong_count_lasts_and_is_only_in_answers(self):
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

    def test_constant_clocks_last_and_are_only_in_answers(self):
        self.post.faults(clock=["constant"])
        for _ in range(2):
            self.assertEqual(self.post.status().json()["run_clock"], 25.98)
            self.assertEqual(self.post.report(REPORT).json()["run_clock"], 3.14)
        self.assertEqual(self.post.faults_left()["clock"], "constant")
        self.assertEqual(self.fault_of_last_line(), "clock:constant")
        self.assertLess(self.post.record()["reports"][0]["run_clock"], 3.14)
        self.post.faults(clock=["running"], reports=["ok"])
        self.assertLess(self.post.status().json()["run_clock"], 25.98)
        self.assertEqual(self.post.faults_left()["clock"], "running")

    def test_another_sender_comes_just_before(self):
        self.post.faults(reports=["other-sender"], status=["other-sender"])
        self.assertEqual(self.post.report(REPORT).json()["id"], 2)
        self.assertEqual(self.post.status().json()["remaining_reports"], 42)
        reports = self.post.record()["reports"]
        self.assertEqual([(one["id"], one["by"], one["request"]) for one in reports],
                         [(1, "other sender", None), (2, "client", 1), (3, "other sender", None)])
        self.assertEqual([line["by"] for line in self.post.lines("reports.jsonl")],
                         ["other sender", "client", "other sender"])
