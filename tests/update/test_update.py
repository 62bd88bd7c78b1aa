#!/usr/bin/python3
"""adit-update with a real RAUC: what is installed, what is refused, and what becomes of it."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import raucs


class OnABox(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        raucs.needs_rauc()
        cls.scratch = pathlib.Path(tempfile.mkdtemp(prefix="adit-update-bundles."))
        cls.addClassCleanup(shutil.rmtree, cls.scratch)
        cls.bundles = raucs.Bundles(cls.scratch)
        cls.newer = cls.bundles.make()

    def setUp(self):
        self.box = raucs.Box(self.bundles)
        self.addCleanup(self.box.stop)
        self.box.update()  # as at each start of the machine
        self.before = self.box.contents()

    def expect_untouched(self):
        self.assertEqual(self.box.contents(), self.before)
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "A B", "BOOT_A_LEFT": "3", "BOOT_B_LEFT": "3"})

    def expect_refused(self, status, sentence):
        self.assertIn(sentence, status["refusal"])
        self.assertEqual((status["doing"], status["progress"]), ("", None))
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])


class Installed(OnABox):
    def test_at_first_it_tells_what_the_box_is(self):
        status = self.box.status()
        self.assertEqual(status["running"], {"compatible": raucs.BOARD, "version": "0.1.0", "slot": "A", "other": "B"})
        self.assertEqual((status["trouble"], status["last"]["stage"], status["stick"]), ("", "", None))

    def test_a_newer_version_goes_into_the_other_slot_and_is_next(self):
        status = self.box.install(self.newer)
        self.assertEqual((status["refusal"], status["last"]["stage"]), ("", "installed"), status)
        self.assertEqual((status["last"]["version"], status["last"]["slot"], status["trial"]), ("0.2.0", "B", False))
        now = self.box.contents()
        for name, part in (("root-b", "root.img"), ("boot-b", "boot.img")):
            image = (self.newer.parent / "in" / part).read_bytes()
            self.assertEqual(now[name][:len(image)], image, name)
        for name in ("root-a", "boot-a"):
            self.assertEqual(now[name], self.before[name], name)
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": "3", "BOOT_B_LEFT": "3"})
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])

    def test_the_same_version_only_where_that_is_said(self):
        same = self.bundles.make("0.1.0")
        self.expect_refused(self.box.install(same), "0.1.0 runs already")
        self.expect_untouched()
        self.assertEqual(self.box.install(same, again=True)["last"]["stage"], "installed")

    def test_progress_is_told_while_it_goes(self):
        big = self.bundles.make("0.3.0", root_size=(4 << 20) - 4096)
        shutil.copy(big, self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        seen = set()
        with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None:
                status = self.box.status()
                seen.add((status["doing"], status["progress"]))
                time.sleep(0.002)
        self.assertIn(("checking", None), seen)
        self.assertGreaterEqual(len({progress for doing, progress in seen if doing == "installing"}), 2, seen)
        self.assertEqual(self.box.status()["doing"], "")

    def test_a_restart_is_systemds(self):
        self.box.ask("restart")
        self.assertEqual(self.box.update()["doing"], "restarting")
        self.assertEqual(self.box.calls.read_text(), "reboot\n")


class Refused(OnABox):
    def test_a_restart_that_systemd_refuses(self):
        raucs.script(self.box.folder / "bin/systemctl", "echo no bus >&2; exit 1\n")
        self.box.ask("restart")
        self.expect_refused(self.box.update(), "it cannot be started anew: systemctl reboot: no bus (exit status 1)")

    def test_another_board(self):
        self.expect_refused(self.box.install(self.bundles.make(board="adit-other"), again=True), "another board")
        self.expect_untouched()

    def test_an_older_version(self):
        for version in ("0.0.9", "0.1.0-rc.1"):
            self.expect_refused(self.box.install(self.bundles.make(version), again=True), "older than what runs: " + version)
        self.expect_untouched()

    def test_a_version_that_is_none(self):
        self.expect_refused(self.box.install(self.bundles.make("newest")), "cannot be read")
        self.expect_untouched()

    def test_a_signature_of_another_key(self):
        other = self.bundles.make(keys=raucs.Keys(self.scratch, "somebody"))
        self.expect_refused(self.box.install(other), "signature verification failed")
        self.expect_untouched()

    def test_what_is_no_whole_bundle(self):
        whole = self.newer.read_bytes()
        unsigned = self.scratch / "unsigned"
        subprocess.run(["mksquashfs", self.newer.parent / "in", unsigned, "-quiet", "-no-progress"], check=True,
                       stdout=subprocess.DEVNULL)
        for name, content, sentence in (("empty", b"", "it is empty"),
                                        ("truncated", whole[:len(whole) // 2], "Invalid bundle format"),
                                        ("without its end", whole[:-1], "Invalid bundle format"),
                                        ("noise", os.urandom(100_000), "Invalid bundle format"),
                                        ("unsigned", unsigned.read_bytes(), "Invalid bundle format"),
                                        ("a changed signature", whole[:-200] + b"XXXX" + whole[-196:], "")):
            with self.subTest(name):
                path = self.scratch / "broken"
                path.write_bytes(content)
                status = self.box.install(path)
                self.assertNotEqual(status["refusal"], "")
                self.expect_refused(status, sentence)
                self.expect_untouched()

    def test_a_changed_byte_leaves_what_runs_and_what_is_next_alone(self):
        path = self.scratch / "changed"
        content = bytearray(self.newer.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        status = self.box.install(path)
        self.assertNotEqual(status["refusal"], "")
        now = self.box.contents()
        self.assertEqual((now["root-a"], now["boot-a"]), (self.before["root-a"], self.before["boot-a"]))
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "A B")

    def test_what_does_not_fit_the_slot(self):
        path = self.box.slots["root-b"]
        device = subprocess.run(["losetup", "--show", "-f", path], check=True, capture_output=True).stdout.decode().strip()
        self.addCleanup(subprocess.run, ["losetup", "-d", device], check=True)
        path.rename(path.with_suffix(".file"))
        path.symlink_to(device)
        status = self.box.install(self.bundles.make(root_size=5 << 20))
        self.assertEqual(status["last"]["stage"], "failed")
        self.assertNotEqual(status["last"]["why"], "")
        now = self.box.contents()
        self.assertEqual((now["root-a"], now["boot-a"]), (self.before["root-a"], self.before["boot-a"]))
        loader = self.box.boot_loader()
        self.assertEqual((loader["BOOT_ORDER"].split()[0], loader["BOOT_A_LEFT"]), ("A", "3"))

    def test_what_is_no_plain_file_is_taken_away(self):
        path = self.box.folder / "wanted/update.raucb"
        for make, sentence in ((lambda: path.symlink_to(self.newer), "Too many levels"),
                               (lambda: os.mkfifo(path), "expected a plain file"), (path.mkdir, "expected a plain file"),
                               (lambda: (path.touch(), os.truncate(path, (256 << 20) + 1)), "were expected"),
                               (lambda: None, "No such file")):
            with self.subTest(sentence):
                make()
                self.box.ask("install")
                self.expect_refused(self.box.update(), sentence)
        self.expect_untouched()
        self.assertTrue(self.newer.exists())

    def test_a_file_that_somebody_still_writes_to(self):
        path = self.box.folder / "wanted/update.raucb"
        shutil.copy(self.newer, path)
        with open(path, "ab"):
            self.box.ask("install")
            self.expect_refused(self.box.update(), "somebody writes to it")
        self.expect_untouched()

    def test_a_request_that_is_none(self):
        for text in ("", "{}", "[]", '{"format": 1, "nonce": "x", "what": "install", "again": false}', "x" * 100_000):
            (self.box.folder / "wanted/update.json").write_text(text)
            self.assertEqual(self.box.update()["nonce"], "")
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])

    def test_a_request_that_cannot_be_taken_away_ends_in_trouble_and_not_in_a_circle(self):
        request = self.box.folder / "wanted/update.json"
        request.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "none", request], check=True)
        try:
            done = subprocess.run(self.box.command(), env=self.box.environment, capture_output=True, timeout=30, check=False)
        finally:
            subprocess.run(["umount", request], check=True)
        self.assertEqual(done.returncode, 1, "systemd waits before it starts it again")
        self.assertIn("update.json: Device or resource busy", self.box.status()["trouble"])
        self.assertEqual(self.box.update()["trouble"], "", "once it can be taken away")
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")

    def test_what_was_asked_before_the_machine_was_started_anew(self):
        shutil.rmtree(self.box.folder / "status")
        (self.box.folder / "status").mkdir()
        shutil.copy(self.newer, self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        self.assertEqual(self.box.update()["nonce"], "")
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])
        self.expect_untouched()

    def test_all_where_rauc_does_not_run(self):
        self.box.halt()
        status = self.box.install(self.newer)
        self.assertIn("RAUC does not run here", status["trouble"])
        self.assertEqual(status["refusal"], status["trouble"])


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

    def test_the_new_slot_is_good_after_a_minute_of_health(self):
        self.box.start("B")
        subprocess.run([self.box.folder / "bin/fw_setenv", "BOOT_B_LEFT", "2"], check=True)  # the boot loader counts
        self.assertTrue(self.box.update()["trial"])
        self.ready_for(57)
        self.assertFalse(self.watch(1))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "2")
        self.ready_for(60)
        self.assertTrue(self.watch(20))
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": "3", "BOOT_B_LEFT": "3"})
        self.assertIn("start --no-block adit-update.service", self.box.calls.read_text())
        status = self.box.update()
        self.assertEqual((status["trial"], status["last"]["stage"], status["last"]["version"]), (False, "good", "0.2.0"))
        self.assertNotIn("reboot", self.box.calls.read_text())

    def test_a_slot_that_does_not_come_up_healthy_in_time_ends_in_a_restart(self):
        self.box.start("B")
        self.ready_for(5)
        self.assertTrue(self.watch(20, "--within", "3"))
        self.assertEqual(self.box.calls.read_text().splitlines()[-1], "reboot")
        self.assertEqual(self.box.update()["last"]["stage"], "installed")

    def test_nothing_else_is_installed_meanwhile(self):
        self.box.start("B")
        status = self.box.install(self.bundles.make("0.3.0"))
        self.expect_refused(status, "0.2.0 is on trial")

    def test_a_slot_that_was_left_is_not_tried_again_and_says_so(self):
        subprocess.run([self.box.folder / "bin/fw_setenv", "BOOT_B_LEFT", "0"], check=True)
        (self.box.folder / "os-release").write_text("VERSION_ID=0.1.0\n")
        self.box.start("A")
        for _ in range(2):  # and says so from then on
            status = self.box.update()
            self.assertEqual((status["last"]["stage"], status["last"]["version"]), ("left", "0.2.0"))
            self.assertIn("0.1.0 runs again", status["last"]["why"])
        # Nor once all tries are used up, when the boot loader gives three again to each slot of its order.
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "A", "BOOT_A_LEFT": "3", "BOOT_B_LEFT": "0"})
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")  # the operator may try it again
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": "3", "BOOT_B_LEFT": "3"})

    def test_a_slot_that_was_good_once_is_good_as_soon_as_the_service_is_ready(self):
        self.box.start("B")
        self.ready_for(60)
        self.assertTrue(self.watch(20))
        subprocess.run([self.box.folder / "bin/fw_setenv", "BOOT_B_LEFT", "1"], check=True)
        self.box.properties.write_text("ActiveState=activating\n")
        self.assertFalse(self.watch(3, "--within", "1"))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "1")
        self.ready_for(0)
        self.assertTrue(self.watch(20))
        self.assertEqual(self.box.boot_loader()["BOOT_B_LEFT"], "3")
        self.assertNotIn("reboot", self.box.calls.read_text())


class ACutOfThePower(OnABox):
    def test_in_the_middle_of_the_writing_leaves_what_runs_and_what_is_next(self):
        shutil.copy(self.bundles.make(root_size=(4 << 20) - 4096), self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        # The other slot's new content does not come to its end: the process that writes it is stopped where it begins.
        os.remove(self.box.slots["root-b"])
        os.mkfifo(self.box.slots["root-b"])
        with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            raucs.wait_until(lambda: self.box.boot_loader()["BOOT_B_LEFT"] == "0", "the other slot marked bad")
            self.box.halt()
            process.kill()
        os.remove(self.box.slots["root-b"])
        self.box.slots["root-b"].write_bytes(bytes(4 << 20))
        self.box.start("A")
        status = self.box.update()
        self.assertEqual(status["last"]["stage"], "interrupted")
        self.assertEqual((self.box.contents()["root-a"], self.box.contents()["boot-a"]),
                         (self.before["root-a"], self.before["boot-a"]))
        loader = self.box.boot_loader()
        self.assertEqual((loader["BOOT_ORDER"].split()[0], loader["BOOT_A_LEFT"], loader["BOOT_B_LEFT"]), ("A", "3", "0"))
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")


    def test_after_its_end_and_before_the_note_of_it_leaves_the_slot_on_trial(self):
        self.box.install(self.newer)
        for stage, why in (("installing", ""), ("interrupted", "install it again"), ("failed", "took longer")):
            self.box.began_before(stage=stage, why=why)
            self.box.start("B")
            status = self.box.update()
            self.assertEqual((status["last"]["stage"], status["last"]["why"], status["trial"]), ("installed", "", True))
        self.expect_refused(self.box.install(self.bundles.make("0.3.0")), "is on trial")


class Killed(OnABox):
    def test_while_rauc_works_waits_for_its_end_once_it_is_started_anew_and_tells_it(self):
        hold = self.box.hold_the_boot_loader()
        shutil.copy(self.newer, self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            raucs.wait_until(lambda: hold.with_name("held").exists(), "RAUC at work")
            process.kill()
        with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            time.sleep(2)
            self.assertIsNone(process.poll())
            self.assertEqual(self.box.status()["doing"], "installing")
            hold.unlink()
            self.assertEqual(process.wait(60), 0)
        status = self.box.status()
        self.assertEqual((status["doing"], status["progress"], status["trouble"]), ("", None, ""))
        self.assertEqual((status["last"]["stage"], status["last"]["why"]), ("installed", ""))
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "B A")


class AHindrance(OnABox):
    def test_is_told_as_it_stands_and_nothing_is_installed_until_it_is_gone(self):
        hindrance = self.box.folder / "hindrance"
        hindrance.write_text("2 disks hold an Adit: take one out\nmore\n")
        self.assertEqual(self.box.install(self.bundles.make())["refusal"], "2 disks hold an Adit: take one out")
        self.expect_untouched()
        hindrance.unlink()
        self.assertEqual(self.box.install(self.bundles.make())["last"]["stage"], "installed")


class AStick(OnABox):
    def put(self, name, *words, stick="sda1", **more):
        shutil.copy(self.bundles.make(*words, **more), self.box.folder / "sticks" / stick / name)

    def test_with_updates_offers_the_newest_that_fits(self):
        self.put("adit-one.raucb", "0.2.0")
        self.put("adit-two.raucb", "0.10.0")
        self.put("adit-three.raucb", "9.0.0", board="adit-other")
        (self.box.folder / "sticks/sda1/adit-four.raucb").write_bytes(b"no bundle")
        (self.box.folder / "sticks/sda1/other.raucb").write_bytes(b"not looked at")
        status = self.box.update()
        self.assertEqual((status["stick"], status["stick_trouble"]), ({"name": "adit-two.raucb", "version": "0.10.0"}, ""))
        self.expect_untouched()  # nothing happens by itself
        self.box.ask("stick")
        status = self.box.update()
        self.assertEqual((status["last"]["stage"], status["last"]["version"], status["refusal"]), ("installed", "0.10.0", ""))
        self.assertTrue((self.box.folder / "sticks/sda1/adit-two.raucb").exists())

    def test_with_many_is_read_from_the_newest_of_this_board_on(self):
        for minor in range(2, 12):
            self.put(f"{raucs.BOARD}-0.{minor}.0.raucb", f"0.{minor}.0")
        for number in range(8):
            (self.box.folder / f"sticks/sda1/adit-a-board-9.{number}.0.raucb").write_bytes(b"of another board")
        self.assertEqual(self.box.update()["stick"], {"name": f"{raucs.BOARD}-0.11.0.raucb", "version": "0.11.0"})

    def test_beside_another_and_with_two_partitions_is_looked_at_like_one(self):
        for stick in ("sda2", "sdb1"):
            (self.box.folder / "sticks" / stick).mkdir()
        self.put("adit-one.raucb", "0.2.0")
        self.put("adit-one.raucb", "0.3.0", stick="sdb1")
        self.put("adit-two.raucb", "0.1.0", stick="sda2")
        self.assertEqual(self.box.update()["stick"], {"name": "adit-one.raucb", "version": "0.3.0"})
        self.box.ask("stick")
        self.assertEqual(self.box.update()["last"]["version"], "0.3.0", "of two files that are called alike, the one offered")

    def test_with_a_name_that_is_no_text_says_so(self):
        shutil.copy(self.newer, os.fsencode(self.box.folder / "sticks/sda1") + b"/adit-\xff.raucb")
        status = self.box.update()
        self.assertIsNone(status["stick"])
        self.assertEqual(status["stick_trouble"], "adit-\\xff.raucb: call it by letters of ASCII alone")
        self.put("adit-good.raucb", "0.3.0")
        self.assertEqual(self.box.update()["stick"]["version"], "0.3.0")

    def test_that_is_full_of_files_says_so(self):
        for number in range(4097):
            (self.box.folder / f"sticks/sda1/photo-{number}").touch()
        self.assertEqual(self.box.update()["stick_trouble"], "sda1: holds more than 4096 files")

    def test_without_one_that_fits_says_why(self):
        self.put("adit-old.raucb", "0.0.1")
        status = self.box.update()
        self.assertIsNone(status["stick"])
        self.assertIn("adit-old.raucb: it is older", status["stick_trouble"])
        self.box.ask("stick")
        self.expect_refused(self.box.update(), "it is older")
        self.expect_untouched()

    def test_that_is_gone_is_said(self):
        self.box.ask("stick")
        self.expect_refused(self.box.update(), "there is no update on a stick")


class AlwaysTrue(unittest.TestCase):
    def test_the_stories_of_a_damaged_file_are_none(self):
        raucs.needs_rauc()
        with tempfile.TemporaryDirectory() as folder:
            box = raucs.Box(raucs.Bundles(pathlib.Path(folder)))
            self.addCleanup(box.stop)
            (box.folder / "state/last.json").write_text("{")
            self.assertEqual(box.update()["last"]["stage"], "")
            (box.folder / "state/last.json").write_text(json.dumps({"format": 9}))
            self.assertEqual(box.update()["last"]["stage"], "")


if __name__ == "__main__":
    unittest.main()
