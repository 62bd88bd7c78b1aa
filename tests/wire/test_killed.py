"""200 times kill -9 at random moments, while clients report through a Command Post that loses what it can: each report
that any client was told is taken or kept is recorded exactly once, or waits where the operator sees it; none is there
twice."""

import collections
import random
import re
import signal
import time
import unittest

import hosts
from insisting import Client, Operator, end, judge
from programs import Stage, wait_until
from reporting import QUICK, began

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


def setUpModule():
    hosts.needs_namespaces()


class Killed(unittest.TestCase):
    def setUp(self):
        options = ["--rate", "0", "--reports", "100000", "--seed", str(SEED)]
        for fault, rate in FAULTS.items():
            options += ["--fault-rate", f"{fault}={rate}"]
        self.stage = self.enterContext(Stage(post_options=options, **{
            **QUICK, "command_post__timeouts__scoring_answer_ms": 500, "reports__doubt_for_ms": 500}))

    def kill_again_and_again(self):
        chance = random.Random(SEED)
        for number in range(1, KILLS + 1):
            time.sleep(chance.uniform(*(LIFE if number % 5 else LONG_LIFE)))
            self.stage.box.stop(signal.SIGKILL)
            self.stage.restart_box()
            if number % 5 == 0:
                self.operator.looks()

    def test_random_kills(self):
        self.operator = Operator(self.stage)
        clients = [Client(self.stage, number, patience) for number, patience in enumerate(PATIENCES, 1)]
        began(self.stage)
        for client in clients:
            client.start()
        self.kill_again_and_again()
        end(clients)
        self.stage.post.control("DELETE /faults")
        wait_until(self.operator.sees_all_at_rest, "all to come to rest")
        self.assertEqual([client.odd for client in clients], [[]] * len(clients), "what no client should be told")
        all_posted = [posted for client in clients for posted in client.posted]
        self.show(all_posted, *judge(self, self.stage, self.operator, all_posted))

    def show(self, all_posted, recorded, waiting):
        histories = "".join(self.stage.box.on_disk("SELECT history FROM report"))
        steps = re.findall(r"^\S+ \d+:[a-z ]+ \d+:(.*)$", histories, re.MULTILINE)
        found = sum(note.startswith("found recorded") for note in steps)
        again = sum(note.startswith("not recorded") for note in steps)
        cut_off = steps.count("the gateway stopped while it was being sent")
        print(f"\n{KILLS} kills, {cut_off} of them with a report on its way; {len(all_posted)} reports posted,",
              f"{sum(posted.is_recorded() for posted in all_posted)} answered 201, {recorded.total()} recorded,",
              f"{found} of them found out from the status; {again} times found not recorded and sent again;",
              f"judged by the operator: {dict(collections.Counter(self.operator.judged.values()))}, {waiting} wait for him",
              flush=True)
        self.assertGreater(min(found + again, cut_off), KILLS // 40, "faults that befell")
        self.assertGreater(recorded.total(), KILLS // 2)


if __name__ == "__main__":
    unittest.main()
