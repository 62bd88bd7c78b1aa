"""One run is one run: a report is recorded once in it, whatever the Command Post's clocks say and wherever the settings
named it meanwhile."""

import contextlib
import signal
import unittest

import hosts
from programs import PORT, CommandPost, Stage, wait_until
from reporting import QUICK, REPORT, another, began, left_unanswered, sendings, submit

OTHER_PORT = 8100  # of the second Command Post, or of none
# The organiser's test server: each status says 25.98 s, each answer to a report 3.14 s, and every run is "1".
MEASURED = ("--as-measured", "--rate", "0", "--reports", "20")


def setUpModule():
    hosts.needs_namespaces()


def endpoints(port):
    return {"scoring": {"address": hosts.SCORING, "port": port}, "mapping": {"address": hosts.MAPPING, "port": port}}


def switch(stage, course):
    return stage.box.apply("POST /adit/course", {"name": course})


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


def runs(stage):
    return stage.box.on_disk("SELECT number FROM run")


@contextlib.contextmanager
def measured(**overrides):
    with Stage(post_options=MEASURED, **{**QUICK, **overrides}) as stage:
        yield began(stage)


class OneRun(unittest.TestCase):
    def is_recorded_once(self, stage, first):
        again = submit(stage)
        self.assertEqual((again.status_code, again.content), (201, first.content))
        self.assertEqual((len(stage.post.recorded(REPORT)), sendings(stage)), (1, 1))

    def test_clocks_that_stand_and_differ(self):
        with measured() as stage:
            first = submit(stage)
            self.assertEqual((first.status_code, first.json()["run_clock"], first.json()["run"]), (201, 3.14, "1"))
            for number in range(1, 4):
                status, said = stage.box.ask("GET /api/status")
                self.assertEqual((status, said["run_clock"]), (200, 25.98))
                self.assertEqual(submit(stage, another(number)).status_code, 201)
                self.is_recorded_once(stage, first)
            kill(stage)
            self.is_recorded_once(stage, first)
            self.assertEqual(runs(stage), [1])
            self.assertEqual(len(stage.post.recorded()), 4)

    def test_another_course_and_back(self):
        for end in (lambda stage: None, kill):
            with self.subTest(end), measured(courses=[{"name": "A", **endpoints(PORT)},
                                                      {"name": "B", **endpoints(OTHER_PORT)}],
                                             command_post__course="A") as stage:
                other = CommandPost(stage.network, stage.folder, *MEASURED, name="other", port=OTHER_PORT,
                                    control_port=8003)
                self.addCleanup(other.process.kill)
                first = submit(stage)
                switch(stage, "B")
                end(stage)
                wait_until(stage.box.knows_the_run, "the other run")
                there = submit(stage)
                self.assertEqual(there.status_code, 201)
                self.assertEqual(len(other.recorded(REPORT)), 1, "another Command Post, another run")
                switch(stage, "A")
                end(stage)
                self.is_recorded_once(stage, first)
                switch(stage, "B")
                self.assertEqual(submit(stage).content, there.content)
                self.assertEqual(len(other.recorded(REPORT)), 1)
                self.assertEqual(runs(stage), [1, 2])

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

    def test_what_waits_is_kept_for_its_own_command_post(self):
        with measured(courses=[{"name": "A", **endpoints(PORT)}, {"name": "B", **endpoints(OTHER_PORT)}],
                      command_post__course="A") as stage:
            stage.post.will("429=100,retry-after=8")  # so that it waits when the course is switched, and is not under way
            left_unanswered(stage)
            wait_until(lambda: stage.box.reports()[0]["state"] == "waiting", "the answer that it is to wait")
            other = CommandPost(stage.network, stage.folder, *MEASURED, name="other", port=OTHER_PORT, control_port=8003)
            self.addCleanup(other.process.kill)
            said = switch(stage, "B")
            self.assertIn("1 report waits", "\n".join(said["warnings"]))
            wait_until(stage.box.knows_the_run, "the other run")
            self.assertEqual(submit(stage, another(5)).status_code, 201)
            self.assertEqual(other.recorded(REPORT), [], "it was meant for the first")
            self.assertEqual(stage.box.reports()[0]["state"], "waiting")
            stage.post.control("DELETE /faults")
            switch(stage, "A")
            wait_until(lambda: stage.post.recorded(REPORT), "what waited")
            self.assertEqual(len(stage.post.recorded(REPORT)), 1)


if __name__ == "__main__":
    unittest.main()
