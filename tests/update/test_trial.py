"""What becomes of an update: on trial, good or left; cut off, or told by nobody."""

import shutil
import signal
import subprocess
import time

import raucs
from on_a_box import OnABox


class OnTrial(OnABox):
    def setUp(self):
        super().setUp()
        self.box.install(self.newer)
        self.box.began_before()
        (self.box.folder / "os-release").write_text("VERSION_ID=0.2.0\n")

    def watch(self, seconds, *words):
        """`adit-update good` for so long; whether it ended by itself."""
        with subprocess.Popen(self.box.command("good", *words), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            try:
                return process.wait(seconds) == 0
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGTERM)
                return False

    def ready_for(self, seconds):
        since = int((time.clock_gettime(time.CLOCK_MONOTONIC) - seconds) * 1e6)
        self.box.properties.write_text(f"ActiveState=active\nActiveEnterTimestampMonotonic={since}\n")

    def test_new_slot_is_good_after_a_minute_of_health(self):
        self.box.start("B")
        self.set("BOOT_B_LEFT", "2")  # the boot loader counts
        self.assertTrue(self.box.update()["trial"])
        self.ready_for(45)
        self.assertFalse(self.watch(1))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "2")
        self.ready_for(60)
        self.assertTrue(self.watch(60))
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": raucs.PROVEN, "BOOT_B_LEFT": raucs.PROVEN})
        self.assertIn("start --no-block adit-update.service", self.box.calls.read_text())
        status = self.box.update()
        self.assertEqual((status["trial"], status["last"]["stage"], status["last"]["version"]), (False, "good", "0.2.0"))
        self.assertNotIn("reboot", self.box.calls.read_text())

    def test_late_slot_ends_in_a_restart(self):
        self.box.start("B")
        self.ready_for(5)
        self.assertTrue(self.watch(60, "--within", "3"))
        self.assertEqual(self.box.calls.read_text().splitlines()[-1], "reboot")
        self.assertEqual(self.box.update()["last"]["stage"], "installed")

    def test_another_update_is_rejected_during_a_trial(self):
        self.box.start("B")
        status = self.box.install(self.bundles.make("0.3.0"))
        self.expect_refused(status, "0.2.0 is on trial")

    def is_left(self):
        self.set("BOOT_B_LEFT", "0")
        self.runs("A", "0.1.0")

    def test_left_slot_is_reported_and_not_tried_again(self):
        self.is_left()
        for _ in range(2):  # and says so from then on
            status = self.box.update()
            self.assertEqual((status["last"]["stage"], status["last"]["version"]), ("left", "0.2.0"))
        # Nor once all tries are used up, when the boot loader gives three again to each slot of its order.
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "A", "BOOT_A_LEFT": raucs.ON_TRIAL, "BOOT_B_LEFT": "0"})
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")  # the operator may try it again
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": raucs.ON_TRIAL, "BOOT_B_LEFT": raucs.ON_TRIAL})

    def test_left_slot_that_runs_is_on_trial_again(self):
        """The boot loader's counts were lost, or somebody at the console has it so."""
        self.is_left()
        self.assertEqual(self.box.update()["last"]["stage"], "left")
        self.set("BOOT_ORDER", "B A")
        self.set("BOOT_B_LEFT", raucs.PROVEN)
        self.runs("B", "0.2.0")
        status = self.box.update()
        self.assertEqual((status["trial"], status["last"]["stage"], status["last"]["why"]), (True, "installed", ""))
        self.assertTrue(self.watch(60, "--within", "2"))
        self.assertEqual(self.box.calls.read_text().splitlines()[-1], "reboot")
        self.is_left()
        self.assertEqual(self.box.update()["last"]["stage"], "left")
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "A")

    def test_proven_slot_is_good_once_the_service_is_ready(self):
        self.box.start("B")
        self.ready_for(60)
        self.assertTrue(self.watch(60))
        self.set("BOOT_B_LEFT", "1")
        self.box.properties.write_text("ActiveState=activating\n")
        self.assertFalse(self.watch(3, "--within", "1"))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "1")
        self.ready_for(0)
        self.assertTrue(self.watch(60))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], raucs.PROVEN)
        self.assertEqual(self.box.calls.read_text().splitlines()[-1], "start --no-block adit-update.service")  # which ends RAUC
        self.assertNotIn("reboot", self.box.calls.read_text())


class ACutOfThePower(OnABox):
    def test_cut_while_writing_keeps_the_running_and_the_next_slot(self):
        self.cut_off()
        self.box.start("A")
        status = self.box.update()
        self.assertEqual(status["last"]["stage"], "interrupted")
        self.assertEqual((self.box.contents()["root-a"], self.box.contents()["boot-a"]),
                         (self.before["root-a"], self.before["boot-a"]))
        loader = self.box.boot_loader()
        self.assertEqual((loader["BOOT_ORDER"].split()[0], loader["BOOT_A_LEFT"], loader["BOOT_B_LEFT"]), ("A", raucs.PROVEN, "0"))
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")

    def test_cut_before_the_record_leaves_the_slot_on_trial(self):
        self.box.install(self.newer)
        for stage, why in (("installing", ""), ("interrupted", "install it again"), ("failed", "took longer")):
            self.box.began_before(stage=stage, why=why)
            self.runs("B", "0.2.0")
            status = self.box.update()
            self.assertEqual((status["last"]["stage"], status["last"]["why"], status["trial"]), ("installed", "", True))
        self.expect_refused(self.box.install(self.bundles.make("0.3.0")), "is on trial")


class Busy(OnABox):
    def test_incomplete_answer_of_a_busy_rauc_is_ignored(self):
        """RAUC 1.8 ends well where it only warns: its work ended after it was asked what is next, and before it was asked for the slots."""
        self.box.install(self.newer)
        path = self.box.folder / "state/last.json"
        path.write_text(path.read_text().replace('"installed"', '"installing"'))
        rauc, real = self.box.folder / "bin/rauc", self.box.folder / "bin/real"
        rauc.rename(real)
        raucs.script(rauc, f"[ -e {self.box.folder}/asked ] || [ \"$1\" != status ] || {{ : >{self.box.folder}/asked; {real} \"$@\" | "
                           "sed 's/\"boot_primary\":\"[^\"]*\",//'; "
                           "printf '\\n(rauc:7): rauc-WARNING **: 12:00:00.000: already processing a different method\\n' >&2; exit; }\n"
                           f"exec {real} \"$@\"\n")
        self.assertEqual(self.box.update()["last"]["stage"], "installed")
        self.assertTrue((self.box.folder / "asked").exists())


class Killed(OnABox):
    """What waits for RAUC, in the midst of its work."""

    def setUp(self):
        super().setUp()
        self.hold = self.box.hold_the_boot_loader()
        shutil.copy(self.newer, self.box.folder / "wanted/update.raucb")
        self.box.ask("install")

    def begin(self):
        return subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL)

    def wait_for_rauc(self):
        raucs.wait_until(lambda: self.hold.with_name("held").exists(), "RAUC at work")

    def expect_it_waits_for_raucs_end_and_tells_it(self, process):
        time.sleep(2)
        self.assertIsNone(process.poll())
        self.assertEqual(self.box.status()["doing"], "installing")
        self.hold.unlink()
        self.assertEqual(process.wait(60), 0)
        status = self.box.status()
        self.assertEqual((status["doing"], status["progress"], status["trouble"], status["refusal"]), ("", None, "", ""))
        self.assertEqual((status["last"]["stage"], status["last"]["why"]), ("installed", ""))
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "B A")

    def test_restarted_adit_update_waits_for_rauc(self):
        with self.begin() as process:
            self.wait_for_rauc()
            process.kill()
        with self.begin() as process:
            self.expect_it_waits_for_raucs_end_and_tells_it(process)

    def test_end_of_the_rauc_client_is_not_the_end_of_rauc(self):
        with self.begin() as process:
            self.wait_for_rauc()
            subprocess.run(["pkill", "-KILL", "-P", str(process.pid)], check=True)
            self.expect_it_waits_for_raucs_end_and_tells_it(process)
