"""One run is one run: a report is recorded once in it, wherever the settings named the Command Post meanwhile. What tells runs apart, and
other courses, are in dispatch/reports_identity_test, reports_move_test and another_post_test."""

import contextlib
import signal
import unittest

from programs import PORT, Stage, wait_until
from reporting import QUICK, REPORT, another, began, left_unanswered, sendings, submit

OTHER_PORT = 8100  # nobody listens there
# The organiser's test server: each status says 25.98 s, each answer to a report 3.14 s, and every run is "1".
MEASURED = ("--as-measured", "--rate", "0", "--reports", "20")


def save_scoring_port(stage, port):
    def elsewhere(settings):
        settings["command_post"]["scoring"]["port"] = port

    stage.box.save(elsewhere)


def kill(stage):
    stage.box.stop(signal.SIGKILL)
    stage.restart_box()


def states(stage, report):
    """The states of the rows that the box has of `report`, oldest first."""
    return [row["state"] for row in stage.box.reports() if row["position"]["x"] == report["x"]]


@contextlib.contextmanager
def measured():
    with Stage(post_options=MEASURED, **QUICK) as stage:
        yield began(stage)


class OneRun(unittest.TestCase):
    def is_recorded_once(self, stage, first):
        again = submit(stage)
        self.assertEqual((again.status_code, again.content), (201, first.content))
        self.assertEqual((len(stage.post.recorded(REPORT)), sendings(stage)), (1, 1))

    def test_a_mistyped_address_put_right(self):
        for end in (lambda stage: None, kill):
            with self.subTest(end), measured() as stage:
                first = submit(stage)
                save_scoring_port(stage, OTHER_PORT)
                for report in (REPORT, another(2)):
                    left_unanswered(stage, report)
                self.assertIn("has answered", stage.box.reports()[1]["note"])
                end(stage)
                save_scoring_port(stage, PORT)
                end(stage)
                wait_until(lambda stage=stage: stage.post.recorded(another(2)), "what is new")
                self.is_recorded_once(stage, first)
                over = ("answered", "in doubt") if end is kill else ("answered",)  # for it may be killed as its answer comes
                wait_until(lambda stage=stage, over=over: states(stage, another(2))[0] in over, "what is new to be over")
                self.assertEqual(len(states(stage, another(2))), 1)
                # A report that is posted before the run is known has a row of its own, until it is compared with the first.
                answered, *repeats = states(stage, REPORT)
                self.assertEqual((answered, set(repeats)), ("answered", {"withdrawn"}))
                self.assertEqual(len(stage.post.recorded(another(2))), 1)

