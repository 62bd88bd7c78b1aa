"""Ways to order faults of a Command Post: control port, command line, at random; and their end."""

import itertools
import socket
import subprocess
import time
import unittest

from command_post import CommandPost, connect, state
from faulted import REPORT, REPORT_BYTES, recorded


class Telling(unittest.TestCase):
    def test_faults_are_queued_in_order_until_cleared(self):
        with CommandPost("--fault", "reports:ok", "--fault", "status:remaining=-1", "--fault-rate",
                         "mapping:answer-after=2.5=0.25") as post:
            post.faults(reports=["record-then-drop", "429=3"], mapping=[])
            self.assertEqual(post.faults_left(), {
                "reports": ["ok", "record-then-drop", "429=3"], "status": ["remaining=-1"], "mapping": [],
                "rates": [{"aim": "mapping", "fault": "answer-after=2.5", "rate": 0.25}], "remaining_offset": 0,
                "clock": "running"})
            self.assertEqual(post.status().json()["remaining_reports"], 44)
            self.assertEqual(post.faults_left()["remaining_offset"], -1)
            answer = post.request(post.control, "DELETE", "/faults", None, {})
            self.assertEqual(answer.json(), {"reports": [], "status": [], "mapping": [], "rates": [],
                                             "remaining_offset": 0, "clock": "running"})
            self.assertEqual(post.status().json()["remaining_reports"], 45)
            self.assertEqual(post.report(REPORT).status_code, 201)

    def test_invalid_orders_are_named_and_queue_nothing(self):
        table = [
            ({"reports": ["drop", "record-then-dorp"]}, "reports[1]: no such fault: 'record-then-dorp'"),
            ({"report": ["drop"]}, "no such aim: 'report'; there are reports, status, mapping, clock"),
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
            ({"clock": ["standing"]}, "clock[0]: expected constant or running, got 'standing'"),
            ({"clock": "constant"}, "clock: expected an array"),
            ({"reports": ["drop"] * 10_001}, "at most 10000 faults can be queued"),
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

    def test_command_line_is_as_strict(self):
        table = [
            (["--fault", "reports:dorp"], "--fault: reports: no such fault: 'dorp'"),
            (["--fault", "drop"], "--fault: expected an aim and a fault"),
            (["--fault", "maps:drop"], "--fault: no such aim: 'maps'"),
            (["--fault", "clock:"], "--fault: clock: expected constant or running, got ''"),
            (["--fault-rate", "clock:constant=0.5"], "--fault-rate: no such aim: 'clock'"),
            (["--fault-rate", "reports:drop"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=1.5"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=nan"], "--fault-rate: expected a rate from 0 to 1"),
            (["--fault-rate", "reports:drop=0.6", "--fault-rate", "reports:reset=0.6"],
             "--fault-rate: reports: the rates come to more than 1"),
            (["--seed", "x"], "--seed: expected 0 to 18446744073709551615, got 'x'"),
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

    def test_random_faults_last_as_long_as_ordered_ones(self):
        with CommandPost("--fault-rate", "reports:429=3=0.2", "--seed", "5", "--reports", "200") as post:
            statuses = [post.report(REPORT).status_code for _ in range(60)]
        while statuses[-1] == 429:
            statuses.pop()
        lengths = [len(list(run)) for status, run in itertools.groupby(statuses) if status == 429]
        self.assertGreater(len(lengths), 2)
        self.assertEqual([length % 3 for length in lengths], [0] * len(lengths), lengths)
        with CommandPost("--fault-rate", "status:500,for=3600=0.3", "--seed", "5") as post:
            statuses = [post.status().status_code for _ in range(40)]
        self.assertIn(500, statuses)
        self.assertEqual(set(statuses[statuses.index(500):]), {500})

    def test_random_faults_of_a_robot_spare_the_others(self):
        with CommandPost("--fault-rate", "mapping:500,robot=ugv1=1") as post:
            statuses = [post.mapping_request("POST", "/state/update", state(name)).status_code
                        for name in ("uav1", "ugv1", "uav1", "ugv1")]
        self.assertEqual(statuses, [200, 500, 200, 500])

    def test_ordered_faults_come_before_random_ones(self):
        with CommandPost("--fault-rate", "status:500=1", "--fault", "status:ok") as post:
            self.assertEqual([post.status().status_code for _ in range(3)], [200, 500, 500])


class Process(unittest.TestCase):
    def test_delayed_answer_does_not_delay_a_stop(self):
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

    def test_faults_are_printed(self):
        with CommandPost("--verbose", "--fault", "reports:other-sender,500") as post:
            post.report(REPORT)
            post.report(REPORT)
            _, out, _ = post.stop()
            self.assertIn('"POST /api/artifact_reports": 500 [other-sender,500]\n', out)
            self.assertIn('"POST /api/artifact_reports report ": 201\n', out)
            self.assertIn("  /api/artifact_reports: other-sender,500 (1 times)\n", out)
            self.assertIn("scored, 0, by another sender\n", out)
