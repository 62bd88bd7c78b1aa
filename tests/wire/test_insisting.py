"""Tests of insisting.py's operator: the box classifies a report between his look and his decision."""

import time
import types
import unittest

from insisting import Operator, Posted, last_answers


class Box:
    """Has one report, in doubt at first and in state `then` from his decision on, which it answers with `answer`."""

    def __init__(self, then, answer):
        self.row = {"number": 1, "state": "in_doubt", "changed": 10.0, "position": {"x": 1.0, "y": 2.0}}
        self.then, self.answer = then, answer

    def reports(self):
        return [dict(self.row)]

    def judge(self, number, action):
        self.row.update(self.then)
        return self.answer


class TheOperator(unittest.TestCase):
    def operator(self, *box):
        post = types.SimpleNamespace(recorded=lambda: [{"x": 1.0, "y": 2.0}])
        return Operator(types.SimpleNamespace(box=Box(*box), post=post), looks_after=-1)

    def test_waits_by_his_own_clock(self):
        """The clock of a box with a hundred power cuts is minutes ahead."""
        box = Box({}, (409, "no"))
        box.row["changed"] = time.time() + 3600
        operator = Operator(types.SimpleNamespace(box=box), looks_after=0.05)
        self.assertEqual(operator.waiting(), {})
        time.sleep(0.1)
        self.assertEqual(list(operator.waiting()), [1])

    def test_accepts_that_the_box_found_out_first(self):
        for then in ({"state": "settled", "changed": 12.0}, {"changed": 12.0}):  # and in doubt again
            operator = self.operator(then, (409, "no"))
            operator.looks()
            self.assertEqual(operator.judged, {}, "that was not his word")

    def test_fails_if_the_box_rejects_the_shown_action(self):
        with self.assertRaisesRegex(AssertionError, "409"):
            self.operator({}, (409, "no")).looks()

    def test_fails_on_another_error(self):
        with self.assertRaisesRegex(AssertionError, "500"):
            self.operator({"state": "settled"}, (500, "no")).looks()

    def test_is_obeyed(self):
        operator = self.operator({"state": "settled"}, (200, {"report": 1}))
        operator.looks()
        self.assertEqual(operator.judged, {1: "settle"})


class TheLastAnswers(unittest.TestCase):
    """The state before power cuts."""

    @staticmethod
    def posted(x, life, status=201):
        answer = types.SimpleNamespace(status_code=status) if status else None
        return Posted({"x": x, "y": 0.0}, answer=answer, life=life)

    def test_are_one_per_process_in_order_of_sending(self):
        recorded = [{"x": x, "y": 0.0} for x in (1.0, 2.0, 4.0, 3.0, 5.0)]
        posted = [self.posted(1.0, 0), self.posted(2.0, 1), self.posted(3.0, 1), self.posted(4.0, 1), self.posted(5.0, 2)]
        self.assertEqual(last_answers(posted, recorded), [(1.0, 0.0), (3.0, 0.0), (5.0, 0.0)])

    def test_exclude_unanswered_reports(self):
        recorded = [{"x": x, "y": 0.0} for x in (1.0, 2.0, 3.0)]
        posted = [self.posted(1.0, 0), self.posted(2.0, 0, status=409), self.posted(3.0, 0, status=None)]
        self.assertEqual(last_answers(posted, recorded), [(1.0, 0.0)])
