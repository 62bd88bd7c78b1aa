"""Clients that report artifacts while the box dies again and again, and a check of the result: each report that any client was told
is accepted or kept is recorded exactly once, or is shown to the operator. No report is recorded twice."""

import collections
import dataclasses
import threading
import time

import requests

from programs import patient
from reporting import submit

# Seconds until a client gives up. Answers until then must still be true.
GIVES_UP = patient(15.0)
DOUBTED = patient(1.0)  # seconds after which the operator looks at a report in doubt
ENDS = {"answered", "settled", "rejected", "withdrawn"}


@dataclasses.dataclass
class Posted:
    """A report and the answers to it."""

    report: dict
    kept: bool = False
    answer: requests.Response | None = None  # the last one: 201, or 409 where the operator had called it done
    life: int = 0  # of the box, in which that answer came

    @property
    def at(self):
        return self.report["x"], self.report["y"]

    def is_recorded(self):
        return self.answer is not None and self.answer.status_code == 201


def at_of(row):
    return row["position"]["x"], row["position"]["y"]


class Client(threading.Thread):
    """Posts reports one after the other, each until it is answered 201 or given up. Begins a new one at most every `pause` seconds.
    `life`: the number of the box's current process."""

    def __init__(self, stage, number, patience, pause=0.0, life=lambda: 0):
        super().__init__(daemon=True)
        self.stage, self.number, self.patience, self.pause, self.life = stage, number, patience, pause, life
        self.posted, self.ending, self.odd = [], threading.Event(), []

    def run(self):
        while not self.ending.wait(self.pause):
            report = {"x": 100.0 * self.number, "y": float(len(self.posted)), "z": 0.5, "type": "Drill"}
            self.posted.append(Posted(report))
            end = time.monotonic() + GIVES_UP
            while time.monotonic() < end and not self.once(self.posted[-1]):
                time.sleep(0.02)

    def once(self, posted):
        life = self.life()  # a connection outlives no cut
        try:
            answer = submit(self.stage, posted.report, self.patience)
        except requests.RequestException:
            return False  # the box is away, or too late
        if answer.status_code in (201, 409):
            posted.answer, posted.life = answer, life
        elif answer.status_code in (503, 504):
            posted.kept = posted.kept or "Adit-Report" in answer.headers
        else:
            self.odd.append(f"{answer.status_code} {answer.text}")
        return posted.answer is not None


class Operator:
    """An operator. He compares reports in doubt with the Command Post's record and decides about them."""

    def __init__(self, stage, looks_after=DOUBTED):
        self.stage, self.looks_after = stage, looks_after
        self.judged = {}  # the action by the report's number
        self.doubted = {}  # by the number and time of each doubt: when it was first seen, by this machine's clock

    def waiting(self):
        """The held reports, and those in doubt for a while, by number. The box's clock may be ahead of this machine's, because it
        never goes back over a power cut."""
        now = time.monotonic()
        return {
            row["number"]: row
            for row in self.stage.box.reports()
            if row["state"] == "held" or (row["state"] == "in_doubt" and now - self.seen(row, now) > self.looks_after)
        }

    def seen(self, row, now):
        return self.doubted.setdefault((row["number"], row["changed"]), now)

    def looks(self):
        waiting = self.waiting()
        recorded = {(made["x"], made["y"]) for made in self.stage.post.recorded()}
        for number, row in waiting.items():
            done = row["state"] == "in_doubt" and at_of(row) in recorded
            self.judges(row, "settle" if done else "send")

    def judges(self, row, action):
        """The view may be outdated: if the box has classified a report meanwhile, he leaves it alone."""
        number = row["number"]
        status, said = self.stage.box.judge(number, action)
        if status == 200:
            self.judged[number] = action
            return
        now = next(each for each in self.stage.box.reports() if each["number"] == number)
        if status != 409 or (now["state"], now["changed"]) == (row["state"], row["changed"]):
            raise AssertionError(f"report {number}, {action}: {status} {said}; it is {now['state']}")

    def sees_all_at_rest(self):
        """Waits until no report changes by itself."""
        waiting = self.waiting()
        return all(row["state"] in ENDS or row["number"] in waiting for row in self.stage.box.reports())


def end(clients):
    for client in clients:
        client.ending.set()
    for client in clients:
        client.join(GIVES_UP + 10)


def last_answers(all_posted, recorded):
    """For each process of the box, the report that was sent last of those answered 201 by it. All data is synced before each sending,
    so the power cut that ended the process can have lost no other answer. `recorded`: the Command Post's reports in their order,
    which is the order of the sendings."""
    place = {(made["x"], made["y"]): number for number, made in enumerate(recorded)}
    last = {}
    for posted in all_posted:
        if posted.is_recorded() and place.get(posted.at, -1) >= place.get(last.get(posted.life, posted).at, -1):
            last[posted.life] = posted
    return [posted.at for posted in last.values()]


def judge(test, stage, operator, all_posted, cuts=False):
    """Checks `all_posted` at rest. Returns the recorded reports as a Counter by (x, y), and the number of waiting ones. `cuts`: a
    power cut may lose the bytes of the last answer before it, but not the outcome of the report (dispatch/README). Every other answer
    is repeated byte for byte."""
    all_recorded = stage.post.recorded()
    recorded = collections.Counter((made["x"], made["y"]) for made in all_recorded)
    found_out = last_answers(all_posted, all_recorded) if cuts else []
    waiting = operator.waiting()
    alarms = stage.box.alarms()
    for number, row in waiting.items():
        test.assertTrue(alarms & {f"report_{row['state']}:{each}" for each in (number, "more")}, "the operator sees it")
    places = {at_of(row) for row in waiting.values()}
    for posted in all_posted:
        with test.subTest(report=posted.report):
            test.assertLessEqual(recorded[posted.at], 1, "recorded twice")
            if posted.answer is not None:
                test.assertEqual(recorded[posted.at], 1, "answered, or settled")
                again = submit(stage, posted.report)
                if posted.at not in found_out or again.headers.get("Adit-Reconciled") != "yes":
                    test.assertEqual(again.content, posted.answer.content)
                test.assertEqual(again.status_code, posted.answer.status_code)
            if posted.kept:
                test.assertTrue(recorded[posted.at] == 1 or posted.at in places, "told that it is kept")
    test.assertEqual(recorded.total(), len(stage.post.recorded()), "nothing was recorded since")
    return recorded, len(waiting)
