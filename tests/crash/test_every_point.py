"""A report's life, with the box killed at every write, sync, send and receive of it: nothing lost, nothing doubled."""

import collections
import concurrent.futures
import os
import queue
import signal
import time
import unittest

from stage import DONE, REPORT, Stage, wait_until

AT_ONCE = 3
QUIET = 0.3  # seconds in which whatever is still to happen happens

# What a report's life consists of, at the least.
KINDS = {"recv team", "pwrite64 ledger.sqlite-wal", "fdatasync ledger.sqlite-wal", "sendmsg scoring", "recv scoring",
         "sendmsg team"}

# One for each life that goes on at the same time; others that run these tests have others.
addresses = queue.SimpleQueue()
for n in range(AT_ONCE):
    addresses.put(f"127.{os.getpid() >> 8 & 127}.{os.getpid() & 255}.{n + 2}")


def live(play):
    """What `play` gives for a stage of its own."""
    address = addresses.get()
    try:
        with Stage(address) as stage:
            return play(stage)
    finally:
        addresses.put(address)


def first_life(stage, first):
    """Where there is one: the box dies in it as `first` says, and leaves its ledger to the next life."""
    if not first:
        return "report"
    stage.box.start(**{"from": "report"}, **first)
    stage.submit()
    wait_until(stage.box.ended, "the first life to end")
    stage.box.trace.unlink()
    return "start"


def points_of(first=None):
    """The points of a life in which nothing (more) goes wrong."""
    def play(stage):
        stage.box.start(**{"from": first_life(stage, first)})
        stage.submit_until_taken()
        time.sleep(QUIET)
        return stage.box.points()
    return live(play)


Life = collections.namedtuple("Life", "killed_at torn problem")


def kind_of(line):
    """The call and where it goes: "pwrite64 ledger.sqlite-wal"."""
    return " ".join(line.split()[:2])


class EveryPoint(unittest.TestCase):
    def settled_once(self, stage):
        """What is true at the end of every life of a report that was taken."""
        self.assertEqual(stage.post.recorded(), [REPORT], "what the Command Post recorded")
        stage.box.stop()
        if stage.box.process.returncode == -signal.SIGKILL:  # its point was still to come
            stage.box.start()
            stage.box.stop()
        states = stage.box.states()
        self.assertEqual(sum(state in DONE for state in states), 1, states)
        self.assertLessEqual(set(states), DONE | {"withdrawn"}, "what became of the client's second try")

    def comes_back(self, stage):
        stage.submit_until_taken()
        time.sleep(QUIET)  # the point may be one that comes after the answer
        if stage.box.ended():
            stage.box.start()
        self.settled_once(stage)

    def is_gone(self, stage):
        answered = stage.submit()
        time.sleep(QUIET)
        on_disk = bool(stage.box.states())
        if answered == 201:
            self.assertTrue(on_disk, "an answered report is on disk")
        if stage.box.ended():
            stage.box.start()
        if on_disk:
            wait_until(lambda: set(stage.box.states()) & DONE, "the report to be settled")
            time.sleep(QUIET)
            return self.settled_once(stage)
        time.sleep(QUIET)
        self.assertEqual((stage.post.recorded(), stage.box.states()), ([], []), "a report that never was on disk")

    def one_life(self, what, client, first, faults):
        """The point at which the box was killed, what was torn, and a sentence where a promise was broken."""
        def play(stage):
            try:
                stage.box.start(**{"from": first_life(stage, first)}, **faults)
                client(stage)
                problem = ""
            except AssertionError as error:
                problem = f"{what}: {error}\n{stage.box.said()}"
            lines = stage.box.points()
            killed = next((number for number, line in enumerate(lines) if line.startswith("killed")), 0)
            return Life(lines[killed - 1] if killed else "", lines[killed + 1:] if killed else [], problem)
        return live(play)

    def at_every_point(self, client, torn, first=None):
        """One life for each point, killed before it, and one after it."""
        points = points_of(first)
        self.assertLessEqual(KINDS, {kind_of(line) for line in points})
        lives = []
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            for number, line in enumerate(points, 1):
                for when in ("before", "after"):
                    faults = {"kill": number, "when": when} | ({"tear": 2 * number + (when == "after")} if torn else {})
                    lives.append(pool.submit(self.one_life, f"{faults} ({line})", client, first, faults))
        lives = [life.result() for life in lives]
        reached = collections.Counter(kind_of(life.killed_at) for life in lives if life.killed_at)
        torn_ones = sum(bool(life.torn) for life in lives)
        print(f"\n{len(lives)} lives, {reached.total()} ended at their point, {torn_ones} of them torn:",
              dict(sorted(reached.items())), flush=True)
        problems = [life.problem for life in lives if life.problem]
        if problems:
            self.fail(f"{len(problems)} lives broke a promise:\n" + "\n".join(problems))
        self.assertGreaterEqual(reached.total(), 0.9 * len(lives), "lives that ended at their point")
        self.assertEqual(torn_ones > 0, torn, "something unsynced was lost")

    def test_a_client_that_comes_back(self):
        self.at_every_point(self.comes_back, torn=False)

    def test_a_client_that_comes_back_after_a_power_cut(self):
        self.at_every_point(self.comes_back, torn=True)

    def test_a_client_that_is_gone(self):
        self.at_every_point(self.is_gone, torn=False)

    def test_a_client_that_is_gone_after_a_power_cut(self):
        self.at_every_point(self.is_gone, torn=True)

    def test_the_recovery_of_a_report_that_was_recorded(self):
        self.at_every_point(self.comes_back, torn=True, first=self.at_the_sending("after"))

    def test_the_recovery_of_a_report_that_never_left(self):
        self.at_every_point(self.comes_back, torn=True, first=self.at_the_sending("before"))

    def at_the_sending(self, when):
        number = next(number for number, line in enumerate(points_of(), 1) if line.startswith("sendmsg scoring"))
        return {"kill": number, "when": when}


if __name__ == "__main__":
    unittest.main(verbosity=2)
