"""Another slot runs than the one that was good last: the boot loader went to it without a word."""

import json

import raucs
from on_a_box import OnABox


class OnB(OnABox):
    def setUp(self):
        """0.1.0 was good in A, 0.2.0 came and was good in B."""
        super().setUp()
        self.good()
        self.box.install(self.newer)
        self.box.began_before()
        self.runs("B", "0.2.0")
        self.good()
        self.assertEqual(self.box.update()["stray"], "")

    def back_to_a(self):
        """B's starts were used up."""
        self.set("BOOT_B_LEFT", "0")
        self.runs("A", "0.1.0")

    def proven(self):
        return json.loads((self.box.folder / "state/proven.json").read_text())["slot"]


class Stray(OnB):
    def setUp(self):
        super().setUp()
        self.back_to_a()

    def test_unexpected_slot_is_reported_at_each_start_until_the_operator_decides(self):
        for _ in range(2):
            status = self.box.update()
            self.assertTrue(status["stray"])
            self.assertEqual((status["trial"], status["last"]["stage"]), (False, "good"))
            self.good()  # this slot is healthy too, and its tries are counted from none again

    def test_going_back_gives_the_slot_all_its_tries(self):
        self.box.ask("back")
        self.assertEqual(self.box.update()["refusal"], "")
        self.assertEqual(self.box.calls.read_text().splitlines()[-1], "reboot")
        loader = self.box.boot_loader()
        self.assertEqual((loader["BOOT_ORDER"], loader["BOOT_B_LEFT"]), ("B A", raucs.PROVEN))
        self.runs("B", "0.2.0")
        self.assertEqual(self.box.update()["stray"], "")

    def test_staying_ends_the_report(self):
        self.box.ask("stay")
        status = self.box.update()
        self.assertEqual((status["stray"], status["refusal"]), ("", ""))
        self.assertEqual(self.box.update()["stray"], "")
        self.assertNotIn("reboot", self.box.calls.read_text())
        self.set("BOOT_B_LEFT", raucs.PROVEN)
        self.runs("B", "0.2.0")  # and now that one is the stray
        self.assertTrue(self.box.update()["stray"])

    def test_expected_slot_cannot_go_back(self):
        self.runs("B", "0.2.0")
        for what in "back", "stay":
            self.box.ask(what)
            self.assertIn("no unexpected slot", self.box.update()["refusal"])
        self.assertNotIn("reboot", self.box.calls.read_text())

    def test_unreadable_record_is_reported_until_the_operator_decides(self):
        (self.box.folder / "state/proven.json").write_text('{"format": 1, "slot": 7')
        self.good()  # which does not make it the good one
        self.assertIn("may not be the last good one: cannot read the slot that was good last", self.box.update()["stray"])
        self.box.ask("stay")
        self.assertEqual(self.box.update()["stray"], "")
        self.assertEqual(self.proven(), "A")


class Overwritten(OnB):
    """An update goes into the slot that was good last and is not now."""

    def setUp(self):
        super().setUp()
        self.back_to_a()
        self.assertTrue(self.box.update()["stray"])

    def expect_nowhere_to_go_back_to(self):
        self.assertEqual(self.box.status()["stray"], "")
        self.box.ask("back")
        self.assertTrue(self.box.update()["refusal"])
        self.assertNotIn("reboot", self.box.calls.read_text())
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "0")
        self.good()
        self.assertEqual((self.proven(), self.box.update()["stray"]), ("A", ""))

    def test_update_that_is_left(self):
        self.assertEqual(self.box.install(self.bundles.make("0.3.0"))["stray"], "")
        self.box.began_before()
        self.back_to_a()
        self.assertEqual(self.box.update()["last"]["stage"], "left")
        self.expect_nowhere_to_go_back_to()

    def test_update_cut_off_by_power(self):
        self.cut_off()
        self.runs("A", "0.1.0")
        self.assertEqual(self.box.update()["last"]["stage"], "interrupted")
        self.expect_nowhere_to_go_back_to()

    def test_update_that_proves_good(self):
        self.box.install(self.bundles.make("0.3.0"))
        self.box.began_before()
        self.runs("B", "0.3.0")
        self.assertTrue(self.box.update()["trial"])
        self.good()
        self.assertEqual((self.proven(), self.box.update()["stray"]), ("B", ""))


class NeverWritten(OnB):
    def refuse_all(self):
        configuration, no = self.box.folder / "system.conf", self.box.folder / "no"
        raucs.script(no, "exit 1\n")
        configuration.write_text(f"{configuration.read_text()}\n[handlers]\npre-install={no}\n")
        self.box.start("B")

    def test_slot_that_an_update_did_not_reach_is_not_on_trial(self):
        self.refuse_all()
        self.assertEqual(self.box.install(self.bundles.make("0.3.0"))["last"]["stage"], "failed")
        self.box.began_before()
        self.back_to_a()
        for _ in range(2):
            status = self.box.update()
            self.assertEqual((status["trial"], status["last"]["stage"]), (False, "failed"))
            self.assertTrue(status["stray"])
            self.good()
            self.assertEqual(self.proven(), "B")

    def test_earlier_update_awaiting_a_restart_is_not_taken_for_a_failed_one(self):
        self.assertEqual(self.box.install(self.bundles.make("0.3.0"))["last"]["stage"], "installed")
        self.refuse_all()
        refused = self.box.install(self.bundles.make("0.4.0"))
        self.assertIn("Pre-install", refused["refusal"])
        for status in refused, self.box.update():
            self.assertEqual((status["last"]["stage"], status["last"]["version"]), ("failed", "0.4.0"))
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"].split()[0], "B", "what runs, not what nothing is told of")
