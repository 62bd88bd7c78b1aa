"""A repeated report is the same report."""

import signal
import unittest

from programs import Stage
from reporting import QUICK, REPORT, at_once, began, sendings, submit


class SameReport(unittest.TestCase):
    def test_clients_that_post_it_at_once_get_one_answer(self):
        with Stage(**QUICK) as stage:
            began(stage).post.will("answer-after=0.3")
            spelled = {**REPORT, "type": "BACKPACK", "name": "robot2"}  # ICD 5.2: any letter case
            answers = at_once(*[lambda: submit(stage)] * 5, lambda: submit(stage, spelled))
            self.assertEqual([answer.status_code for answer in answers], [201] * 6)
            self.assertEqual({answer.content for answer in answers}, {answers[0].content})
            self.assertEqual((len(stage.post.recorded()), sendings(stage)), (1, 1))

    def test_it_is_the_same_after_a_restart(self):
        with Stage(**QUICK) as stage:
            first = submit(began(stage))
            stage.box.stop(signal.SIGKILL)
            stage.restart_box()
            again = submit(stage)  # before the run is known
            self.assertEqual((again.status_code, again.content), (201, first.content))
            self.assertEqual(len(stage.post.recorded()), 1)
