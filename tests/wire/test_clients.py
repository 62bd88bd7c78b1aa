"""The example clients for teams (firmware/doors/intake/clients), in Python and C++, against the real programs. Whatever happens to an
answer, the service or the Command Post, each client ends with the truth, and no report is recorded twice."""

import json
import os
import pathlib
import signal
import subprocess
import time
import unittest
import unittest.mock

import hosts
import programs
from programs import CommandPost, Stage, wait_until
from reporting import QUICK, began

SHOWN = pathlib.Path(os.environ["ADIT_SOURCE"]) / "firmware/doors/intake/clients"
CLIENTS = {"Python": ["/usr/bin/python3", "-B", SHOWN / "example.py"], "C++": [programs.BIN / "adit_client_example"]}
UPDATES = ("map", "state", "markers")
ANSWERED, REFUSED, WRONG_WORDS, NOT_KNOWN = 0, 1, 2, 3  # exit status
NOT_RECORDED = ("drop", "html-200", "html-302")
BAD_DAY = ("--rate", "0", "--seed", "5", "--fault-rate", "reports:record-then-drop=0.3", "--fault-rate", "reports:drop=0.2",
           "--fault-rate", "reports:429=0.1", "--fault-rate", "mapping:drop=0.2")


def report(number):
    return {"x": 7.5 * number, "y": -1.25, "z": 0.5, "type": "Drill"}


def words(made):
    return ["report", made["x"], made["y"], made["z"], made["type"]]


def refused_connections(stage):
    """The number of resets by the Command Post's host because no program listened."""
    lines = subprocess.run(["ip", "netns", "exec", stage.network.post, "cat", "/proc/net/snmp"], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    names, counts = (line.split() for line in lines if line.startswith("Tcp:"))
    return int(counts[names.index("AttemptFails")])


class Run(programs.Program):
    """A client on the host `at`, which ends with the test."""

    def __init__(self, test, stage, name, given, at=None, url=None, token=programs.TEAM_TOKEN):
        command = ["env", f"ADIT_TOKEN={token}", *CLIENTS[name], url or stage.box.url, *given]
        log = stage.folder / f"{name}-{time.monotonic_ns()}.log"
        super().__init__(stage.network, at or stage.network.team, log, command)
        test.addCleanup(self.stop, signal.SIGKILL)

    def ended(self):
        """Its exit status and its output."""
        return self.process.wait(120), self.output()


class Clients(unittest.TestCase):
    def test_reports_on_a_bad_day_with_a_kill_in_the_middle(self):
        for name in CLIENTS:
            with self.subTest(name), Stage(post_options=BAD_DAY, **QUICK) as stage:
                began(stage)
                runs = [Run(self, stage, name, words(report(number))) for number in range(1, 9)]
                wait_until(lambda stage=stage: len(stage.post.recorded()) >= 2, "some of them")
                stage.box.stop(signal.SIGKILL)
                stage.restart_box()
                answers = [run.ended() for run in runs]
                self.assertEqual([status for status, _ in answers], [ANSWERED] * 8, answers)
                recorded = {made["x"]: made for made in stage.post.recorded()}
                self.assertEqual((len(recorded), len(stage.post.recorded())), (8, 8), "each once")
                for _, said in answers:
                    told = json.loads(said)
                    made = recorded[told["x"]]
                    for member in ("y", "z", "type", "run", "team", "report_status", "score_change"):
                        self.assertEqual(told[member], made[member])
                self.assertEqual(stage.post.violations(), [])

    def test_updates_and_the_status(self):
        for name in CLIENTS:
            with self.subTest(name), Stage(post_options=BAD_DAY, **QUICK) as stage:
                began(stage)
                for what in UPDATES:
                    self.assertEqual(Run(self, stage, name, [what]).ended(), (ANSWERED, "null\n"))
                for what in UPDATES:
                    wait_until(lambda stage=stage, what=what: any(request["status"] == 200 for request
                               in stage.post.requests(f"/{what}/update")), f"the {what} to arrive")
                status, said = Run(self, stage, name, ["status"]).ended()
                self.assertEqual((status, json.loads(said)["current_team"]), (ANSWERED, "adit"))
                self.assertEqual(stage.post.violations(), [])

    def test_rejected_report_is_not_retried(self):
        with Stage(**QUICK) as stage:
            for name in CLIENTS:
                with self.subTest(name):
                    status, said = Run(self, stage, name, ["report", 1, 2, 3, "Dril"]).ended()
                    self.assertEqual(status, REFUSED)
                    self.assertIn("type: ", said)
                    self.assertEqual(Run(self, stage, name, ["report", "nan", 2, 3, "Drill"]).ended()[0], REFUSED)
            self.assertEqual(stage.post.recorded(), [])

    def test_wrong_words_are_named(self):
        with Stage(**QUICK) as stage:
            for name in CLIENTS:
                for given, why in ((["report", 1, 2, 3], "expected"), (["report", 1, 2, "north", "Drill"], ""),
                                   (["report", 1, 2, 3, "Cell", "Phone"], "expected"), (["maps"], "expected"), ([], "expected")):
                    with self.subTest(name, given=given):
                        status, said = Run(self, stage, name, given).ended()
                        self.assertEqual(status, WRONG_WORDS, said)
                        self.assertIn("usage: ", said)
                        self.assertIn(why, said)
                        self.assertNotIn("Traceback", said)

    def test_a_proxy_of_the_environment_is_not_asked(self):
        with Stage(**QUICK) as stage, unittest.mock.patch.dict(os.environ, http_proxy="http://127.0.0.1:9"):
            for name in CLIENTS:
                self.assertEqual(Run(self, stage, name, ["state"]).ended(), (ANSWERED, "null\n"), name)

    def test_operator_withdraws_a_report(self):
        for name in CLIENTS:
            with self.subTest(name), Stage(**QUICK, reports__review="all") as stage:
                began(stage)
                run = Run(self, stage, name, words(report(1)))
                wait_until(lambda stage=stage: [made["state"] for made in stage.box.reports()] == ["held"], "it to be held")
                self.assertEqual(stage.box.judge(1, "withdraw")[0], 200)
                self.assertEqual(run.ended()[0], NOT_KNOWN)
                self.assertEqual(stage.post.recorded(), [])


class Bare(unittest.TestCase):
    """The same clients directly at the Command Post, on its host."""

    def run_there(self, stage, name, given, at="scoring", port=programs.PORT):
        address, token = {"scoring": (hosts.SCORING, programs.SCORING_TOKEN),
                          "mapping": (hosts.MAPPING, programs.MAPPING_TOKEN)}[at]
        return Run(self, stage, name, [*given, "--bare"], stage.network.post, f"http://{address}:{port}", token)

    def test_report_with_a_lost_answer_is_not_resent(self):
        with Stage(post_options=("--rate", "0")) as stage:
            for number, fault in enumerate(("record-then-drop", "drop", "500-recorded", "half-answer", "garbage", "html-200", "html-302"), 1):
                for offset, name in enumerate(CLIENTS):
                    with self.subTest(fault, client=name):
                        made = report(2 * number + offset)
                        stage.post.will(fault)
                        status, said = self.run_there(stage, name, words(made)).ended()
                        self.assertEqual(status, NOT_KNOWN)
                        self.assertIn("remaining_reports", said)
                        self.assertEqual(len(stage.post.recorded(made)), 0 if fault in NOT_RECORDED else 1)
            self.assertEqual(len([1 for each in stage.post.requests("/api/artifact_reports") if each["message"]]), 14)

    def test_unsent_and_throttled_reports_are_resent(self):
        for at, name in enumerate(CLIENTS):
            with self.subTest(name), Stage() as stage:
                run = self.run_there(stage, name, words(report(1)), port=9000 + at)
                wait_until(lambda stage=stage: refused_connections(stage) > 0, "it to try")
                post = CommandPost(stage.network, stage.folder, "--fault", "reports:429=2", name="late", port=9000 + at,
                                   control_port=9100 + at)
                try:
                    self.assertEqual(run.ended()[0], ANSWERED)
                    self.assertEqual(len(post.recorded(report(1))), 1)
                finally:
                    post.stop()

    def test_updates_follow_the_rate_limit(self):
        with Stage(post_options=("--rate", "1")) as stage:
            for name in CLIENTS:
                for what in UPDATES:
                    with self.subTest(name, what=what):
                        self.assertEqual(self.run_there(stage, name, [what], "mapping").ended(), (ANSWERED, "null\n"))
            self.assertEqual(stage.post.violations(), [])
