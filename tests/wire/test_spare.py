"""A spare box takes over: each report is recorded exactly once, whenever the first box was cut off. Other cases:
dispatch/merged_reports_test, admin/takeover_test and admin/spare_test."""

import subprocess
import time

import requests

import programs
from alarming import WithAlarms
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, began, left_unanswered, submit

FINISHED = ("answered", "settled", "withdrawn")


class Swap(Stage):
    """A stage whose box can be replaced by a spare with its own state."""

    def __enter__(self):
        super().__enter__()
        self.spare_folder = self.folder / "spare"
        self.spare_folder.mkdir()
        secrets = self.spare_folder / "secrets"
        secrets.mkdir(mode=0o700)
        token = secrets / "team.token"  # it knows none of the Command Post's
        token.write_text(programs.TEAM_TOKEN + "\n")
        token.chmod(0o600)
        self.export = self.folder / "box.adit-spare"
        return self

    def adit(self, *words, exits=0):
        """Runs `adit spare` and returns its output. `exits`: the expected exit status."""
        done = subprocess.run([programs.BIN / "adit", "spare", *words, "--at", f"{self.network.box_address}:{programs.PORT}",
                               "--token-file", self.spare_folder / "secrets/team.token"],
                              capture_output=True, text=True, check=False, timeout=120)
        if done.returncode != exits:
            raise AssertionError(f"adit spare {words}: {done.returncode} {done.stdout}{done.stderr}")
        return done.stdout

    def exported(self):
        """Puts the box on standby and returns the code of its export."""
        self.adit("export", self.export, "--yes")
        return self.box.ask("GET /adit/spare")[1]["code"]

    def unplug(self):
        self.box.stop(programs.signal.SIGKILL)

    def plug_in_spare(self):
        self.box = self.make_box(self.network, self.spare_folder, **{**self.overrides, "reports__near_metres": 9})

    def take_over(self, code):
        self.adit("take", self.export, "--code", code, "--yes")
        wait_until(lambda: self.settled(), "the spare to have taken over")

    def settled(self):
        try:
            view = self.box.ask("GET /adit/spare")[1]
            return not view["takes_over"] and not view["taken_in"] and not view["standby"]
        except OSError:
            return False

    def swap(self):
        code = self.exported()
        self.unplug()
        self.plug_in_spare()
        self.take_over(code)

    def all_recorded(self, reports):
        wait_until(lambda: len(self.post.recorded()) >= len(reports), "all to be recorded")
        wait_until(lambda: all(row["state"] in FINISHED for row in self.box.reports()), "all to be finished")
        time.sleep(0.5)  # what might still be sent would be by now
        return sorted(made["x"] for made in self.post.recorded()) == sorted(report["x"] for report in reports)


class Spare(WithAlarms):
    def swap(self, **overrides):
        return began(self.enterContext(Swap(**{**QUICK, **overrides})))

    def test_spare_knows_all_reports_of_the_first_box(self):
        stage = self.swap()
        answers = [submit(stage, another(number)) for number in range(1, 4)]
        at = [row["received"] for row in stage.box.reports()]
        stage.swap()
        for row, before in zip(stage.box.reports(), at, strict=True):
            self.assertAlmostEqual(row["received"], before, delta=1)
        began(stage)
        for number, answer in enumerate(answers, 1):
            again = submit(stage, another(number))
            self.assertEqual((again.status_code, again.content), (201, answer.content), "byte for byte")
        self.assertEqual(submit(stage, another(4)).status_code, 201)
        self.assertTrue(stage.all_recorded([another(number) for number in range(1, 5)]))
        self.assertEqual(stage.box.ask("GET /adit/settings")[1]["settings"]["reports"]["near_metres"], 5, "the first box's")
        self.assertEqual(stage.post.violations(), [])

    def test_first_box_is_cut_off_during_an_answer(self):
        for fault in ("record-then-drop", "drop"):
            with self.subTest(fault), Swap(**QUICK) as stage:
                began(stage)
                self.assertEqual(submit(stage, another(9)).status_code, 201)
                stage.post.will(fault)
                left_unanswered(stage, patience=0.05)
                stage.unplug()
                stage.restart_box()  # for its export alone
                stage.swap()
                self.assertIn(submit(stage).status_code, (201,))
                self.assertTrue(stage.all_recorded([REPORT, another(9)]))

    def test_standby_box_shows_it_and_accepts_and_sends_nothing(self):
        stage = self.swap()
        self.assertEqual(submit(stage).status_code, 201)
        asked = len(stage.post.requests())
        stage.exported()
        asked = max(asked, len(stage.post.requests()))
        self.sees(stage, "standby", "bad", "box")
        refused = submit(stage, another(1))
        self.assertEqual((refused.status_code, refused.json()),
                         (503, "this box is on standby: its spare takes over; it accepts and sends no messages"))
        self.assertEqual(self.send_map(stage, "r1").status_code, 503)
        self.assertEqual(stage.box.judge(1, "resubmit")[0], 409)
        stage.unplug()
        stage.restart_box()
        wait_until(lambda: self.alarm(stage, "standby"), "it to rest after a power cut, too")
        self.assertEqual(len(stage.post.requests()), asked, "nothing was asked of the Command Post")
        self.assertEqual(len(stage.box.reports()), 1, "nothing was kept")
        stage.adit("resume", "--yes")
        wait_until(lambda: self.view(stage)["lights"] and not self.alarm(stage, "standby"), "it to go on")
        began(stage)
        self.assertEqual(submit(stage, another(1)).status_code, 201)
