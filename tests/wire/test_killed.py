"""200 times kill -9 at random moments, while clients report through a Command Post that loses what it can: each report
that any client was told is taken or kept is recorded exactly once, or waits where the operator sees it; none is there
twice."""

import collections
import dataclasses
import random
import re
import signal
import threading
import time
import unittest

import requests

import hosts
from programs import Stage, wait_until
from reporting import QUICK, began, submit

KILLS = 200
SEED = 20210924
# How often what befalls a request to the Command Post.
FAULTS = {
    "reports:record-then-drop": 0.06, "reports:drop": 0.06, "reports:reset": 0.03, "reports:reset-unrecorded": 0.03,
    "reports:half-answer": 0.03, "reports:garbage": 0.02, "reports:500": 0.03, "reports:500-recorded": 0.03,
    "reports:429": 0.03, "reports:401": 0.01, "reports:answer-after=0.1": 0.3, "reports:record-after=0.05": 0.1,
    "reports:record-after=0.05,reset": 0.02, "reports:answer-after=1": 0.02,
    "status:500": 0.02, "status:drop": 0.02, "status:half-answer": 0.01,
}
LIFE, LONG_LIFE = (0.1, 0.6), (0.8, 1.4)  # seconds from a start to its kill; every fifth is long enough to find out
PATIENCES = (0.3, 0.3, 0.3, 1.0, 5.0)  # seconds after which each client hangs up and tries again
# Given up by its client after this long; what it was told by then must be true all the same.
GIVES_UP = 15.0
DOUBTED = 1.0  # seconds after which the operator looks at a report in doubt
ENDS = {"answered", "settled", "refused", "withdrawn"}


def setUpModule():
    hosts.needs_namespaces()


@dataclasses.dataclass
class Posted:
    """A report, and what its client was told of it."""

    report: dict
    kept: bool = False
    answer: requests.Response | None = None  # the last one: 201, or 409 where the operator had called it done

    @property
    def at(self):
        return self.report["x"], self.report["y"]

    def is_recorded(self):
        return self.answer is not None and self.answer.status_code == 201


def at_of(row):
    return row["position"]["x"], row["position"]["y"]


class Client(threading.Thread):
    """Reports one thing after another, each again and again until it is answered 201, or given up."""

    def __init__(self, stage, number, patience):
        super().__init__(daemon=True)
        self.stage, self.number, self.patience = stage, number, patience
        self.posted, self.ending, self.odd = [], threading.Event(), []

    def run(self):
        while not self.ending.is_set():
            report = {"x": 100.0 * self.number, "y": float(len(self.posted)), "z": 0.5, "type": "Drill"}
            self.posted.append(Posted(report))
            end = time.monotonic() + GIVES_UP
            while time.monotonic() < end and not self.once(self.posted[-1]):
                time.sleep(0.02)

    def once(self, posted):
        try:
            answer = submit(self.stage, posted.report, self.patience)
        except requests.RequestException:
            return False  # the box is away, or too late
        if answer.status_code == 201 or "called done by the operator" in answer.text:
            posted.answer = answer
        elif answer.status_code in (503, 504):
            posted.kept = posted.kept or "Adit-Report" in answer.headers
        else:
            self.odd.append(f"{answer.status_code} {answer.text}")
        return posted.answer is not None


class Killed(unittest.TestCase):
    def setUp(self):
        options = ["--rate", "0", "--reports", "100000", "--seed", str(SEED)]
        for fault, rate in FAULTS.items():
            options += ["--fault-rate", f"{fault}={rate}"]
        self.stage = self.enterContext(Stage(post_options=options, **{
            **QUICK, "command_post__timeouts__scoring_answer_ms": 500, "reports__doubt_for_ms": 500}))
        self.record = self.stage.post.recorded

    def kill_again_and_again(self):
        chance = random.Random(SEED)
        for number in range(1, KILLS + 1):
            time.sleep(chance.uniform(*(LIFE if number % 5 else LONG_LIFE)))
            self.stage.box.stop(signal.SIGKILL)
            self.stage.restart_box()
            if number % 5 == 0:
                self.operator()

    def waiting_for_the_operator(self):
        """Those held, and those in doubt of which nothing was found out for a while, by their numbers."""
        return {row["number"]: row for row in self.stage.box.reports()
                if row["state"] == "received"
                or (row["state"] == "in doubt" and time.time() - row["changed"] > DOUBTED)}

    def operator(self):
        """Looks at what the Command Post shows as recorded, and judges what waits for him by that."""
        waiting = self.waiting_for_the_operator()
        recorded = {(made["x"], made["y"]) for made in self.record()}
        for number, row in waiting.items():
            done = row["state"] == "in doubt" and at_of(row) in recorded
            self.judged[number] = "done" if done else "send"
            self.assertEqual(self.stage.box.judge(number, self.judged[number])[0], 200)

    def comes_to_rest(self):
        """Nothing moves any more by itself."""
        waiting = self.waiting_for_the_operator()
        return all(row["state"] in ENDS or row["number"] in waiting for row in self.stage.box.reports())

    def test_random_kills(self):
        self.judged = {}
        clients = [Client(self.stage, number, patience) for number, patience in enumerate(PATIENCES, 1)]
        began(self.stage)
        for client in clients:
            client.start()
        self.kill_again_and_again()
        for client in clients:
            client.ending.set()
        for client in clients:
            client.join(GIVES_UP + 10)
        self.stage.post.control("DELETE /faults")
        wait_until(self.comes_to_rest, "all to come to rest", 30)
        self.assertEqual([client.odd for client in clients], [[]] * len(clients), "what no client should be told")
        self.judge([posted for client in clients for posted in client.posted])

    def judge(self, all_posted):
        recorded = collections.Counter((made["x"], made["y"]) for made in self.record())
        waiting = self.waiting_for_the_operator()
        said = self.stage.box.attention()
        self.show(all_posted, recorded, waiting)
        for number in waiting:
            self.assertIn(f"report {number} is ", said, "the operator sees it")
        waiting = {at_of(row) for row in waiting.values()}
        for posted in all_posted:
            with self.subTest(report=posted.report):
                self.assertLessEqual(recorded[posted.at], 1, "recorded twice")
                if posted.answer is not None:
                    self.assertEqual(recorded[posted.at], 1, "answered, or called done")
                    self.assertEqual(submit(self.stage, posted.report).content, posted.answer.content)
                if posted.kept:
                    self.assertTrue(recorded[posted.at] == 1 or posted.at in waiting, "told that it is kept")
        self.assertEqual(recorded.total(), len(self.record()), "nothing was recorded since")

    def show(self, all_posted, recorded, waiting):
        histories = "".join(self.stage.box.on_disk("SELECT history FROM report"))
        steps = re.findall(r"^\S+ \d+:[a-z ]+ \d+:(.*)$", histories, re.MULTILINE)
        found = sum(note.startswith("found recorded") for note in steps)
        again = sum(note.startswith("not recorded") for note in steps)
        cut_off = steps.count("the gateway stopped while it was being sent")
        print(f"\n{KILLS} kills, {cut_off} of them with a report on its way; {len(all_posted)} reports posted,",
              f"{sum(posted.is_recorded() for posted in all_posted)} answered 201, {recorded.total()} recorded,",
              f"{found} of them found out from the status; {again} times found not recorded and sent again;",
              f"judged by the operator: {dict(collections.Counter(self.judged.values()))}, {len(waiting)} wait for him",
              flush=True)
        self.assertGreater(min(found + again, cut_off), KILLS // 40, "faults that befell")
        self.assertGreater(recorded.total(), KILLS // 2)


if __name__ == "__main__":
    unittest.main()
