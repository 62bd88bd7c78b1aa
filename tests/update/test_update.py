"""adit-update with a real RAUC: what is installed and what is refused."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

import raucs
from on_a_box import OnABox


class Installed(OnABox):
    def test_status_shows_the_box_at_first(self):
        status = self.box.status()
        self.assertEqual(status["running"], {"compatible": raucs.BOARD, "version": "0.1.0", "slot": "A", "other": "B"})
        self.assertEqual((status["trouble"], status["last"]["stage"], status["stick"]), ("", "", None))

    def test_newer_version_goes_into_the_other_slot_and_is_next(self):
        status = self.box.install(self.newer)
        self.assertEqual((status["refusal"], status["last"]["stage"]), ("", "installed"), status)
        self.assertEqual((status["last"]["version"], status["last"]["slot"], status["trial"]), ("0.2.0", "B", False))
        now = self.box.contents()
        for name, part in (("root-b", "root.img"), ("boot-b", "boot.img")):
            image = (self.newer.parent / "in" / part).read_bytes()
            self.assertEqual(now[name][:len(image)], image, name)
        for name in ("root-a", "boot-a"):
            self.assertEqual(now[name], self.before[name], name)
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "B A", "BOOT_A_LEFT": raucs.PROVEN, "BOOT_B_LEFT": raucs.ON_TRIAL})
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])

    def test_same_version_only_if_confirmed(self):
        same = self.bundles.make("0.1.0")
        self.expect_refused(self.box.install(same), "0.1.0 is already running")
        self.expect_untouched()
        self.assertEqual(self.box.install(same, again=True)["last"]["stage"], "installed")

    def test_progress_is_shown(self):
        big = self.bundles.make("0.3.0", root_size=(4 << 20) - 4096)
        seen = set()

        def is_seen():
            return ("checking", None) in seen and len({progress for doing, progress in seen if doing == "installing"}) >= 2

        for _ in range(5):  # a machine that does much besides may let this test look too seldom
            seen.clear()
            shutil.copy(big, self.box.folder / "wanted/update.raucb")
            self.box.ask("install", again=True)
            with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
                while process.poll() is None:
                    status = self.box.status()
                    seen.add((status["doing"], status["progress"]))
                    time.sleep(0.002)
            if is_seen():
                break
        self.assertTrue(is_seen(), seen)
        self.assertEqual(self.box.status()["doing"], "")

    def test_restart_is_left_to_systemd(self):
        self.box.ask("restart")
        self.assertEqual(self.box.update()["doing"], "restarting")
        self.assertEqual(self.box.calls.read_text(), "reboot\n")


class Refused(OnABox):
    def test_restart_rejected_by_systemd(self):
        raucs.script(self.box.folder / "bin/systemctl", "echo no bus >&2; exit 1\n")
        self.box.ask("restart")
        self.expect_refused(self.box.update(), "cannot restart the machine: systemctl reboot: no bus (exit status 1)")

    def test_another_board(self):
        self.expect_refused(self.box.install(self.bundles.make(board="adit-other"), again=True), "another board")
        self.expect_untouched()

    def test_an_older_version(self):
        for version in ("0.0.9", "0.1.0-rc.1"):
            self.expect_refused(self.box.install(self.bundles.make(version), again=True), f"the update is older ({version})")
        self.expect_untouched()

    def test_invalid_version(self):
        self.expect_refused(self.box.install(self.bundles.make("newest")), "cannot read the update's version")
        self.expect_untouched()

    def test_a_signature_of_another_key(self):
        other = self.bundles.make(keys=raucs.Keys(self.scratch, "somebody"))
        self.expect_refused(self.box.install(other), "signature verification failed")
        self.expect_untouched()

    def test_incomplete_bundle(self):
        whole = self.newer.read_bytes()
        unsigned = self.scratch / "unsigned"
        subprocess.run(["mksquashfs", self.newer.parent / "in", unsigned, "-quiet", "-no-progress"], check=True,
                       stdout=subprocess.DEVNULL)
        for name, content, sentence in (("empty", b"", "got an empty file"),
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

    def test_changed_byte_keeps_the_running_and_the_next_slot(self):
        path = self.scratch / "changed"
        content = bytearray(self.newer.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        status = self.box.install(path)
        self.assertNotEqual(status["refusal"], "")
        now = self.box.contents()
        self.assertEqual((now["root-a"], now["boot-a"]), (self.before["root-a"], self.before["boot-a"]))
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "A B")

    def test_bundle_larger_than_the_slot(self):
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
        self.assertEqual((loader["BOOT_ORDER"].split()[0], loader["BOOT_A_LEFT"]), ("A", raucs.PROVEN))

    def test_other_than_a_regular_file_is_deleted(self):
        path = self.box.folder / "wanted/update.raucb"
        for make, sentence in ((lambda: path.symlink_to(self.newer), "Too many levels"),
                               (lambda: os.mkfifo(path), "is not a regular file"), (path.mkdir, "is not a regular file"),
                               (lambda: (path.touch(), os.truncate(path, (256 << 20) + 1)), "expected at most"),
                               (lambda: None, "No such file")):
            with self.subTest(sentence):
                make()
                self.box.ask("install")
                self.expect_refused(self.box.update(), sentence)
        self.expect_untouched()
        self.assertTrue(self.newer.exists())

    def test_file_still_being_written(self):
        path = self.box.folder / "wanted/update.raucb"
        shutil.copy(self.newer, path)
        with open(path, "ab"):
            self.box.ask("install")
            self.expect_refused(self.box.update(), "another program is writing to it")
        self.expect_untouched()

    def test_invalid_request(self):
        for text in ("", "{}", "[]", '{"format": 1, "nonce": "x", "what": "install", "again": false}', "x" * 100_000):
            (self.box.folder / "wanted/update.json").write_text(text)
            self.assertEqual(self.box.update()["nonce"], "")
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])

    def test_undeletable_request_ends_in_trouble_not_in_a_loop(self):
        request = self.box.folder / "wanted/update.json"
        request.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "none", request], check=True)
        try:
            done = subprocess.run(self.box.command(), env=self.box.environment, capture_output=True, timeout=120, check=False)
        finally:
            subprocess.run(["umount", request], check=True)
        self.assertEqual(done.returncode, 1, "systemd waits before it starts it again")
        self.assertIn("update.json: Device or resource busy", self.box.status()["trouble"])
        self.assertEqual(self.box.update()["trouble"], "", "once it can be taken away")
        self.assertEqual(self.box.install(self.newer)["last"]["stage"], "installed")

    def test_request_from_before_the_boot(self):
        shutil.rmtree(self.box.folder / "status")
        (self.box.folder / "status").mkdir()
        shutil.copy(self.newer, self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        self.assertEqual(self.box.update()["nonce"], "")
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])
        self.expect_untouched()

    def test_everything_if_rauc_does_not_run(self):
        self.box.halt()
        status = self.box.install(self.newer)
        self.assertIn("RAUC does not run here", status["trouble"])
        self.assertEqual(status["refusal"], status["trouble"])


class AHindrance(OnABox):
    def test_is_shown_and_prevents_updates_until_it_is_gone(self):
        hindrance = self.box.folder / "hindrance"
        hindrance.write_text("2 disks hold an Adit: take one out\nmore\n")
        self.assertEqual(self.box.install(self.bundles.make())["refusal"], "2 disks hold an Adit: take one out")
        self.expect_untouched()
        hindrance.unlink()
        hindrance.mkdir()  # it cannot be read
        self.assertIn(str(hindrance), self.box.install(self.bundles.make())["refusal"])
        self.expect_untouched()
        hindrance.rmdir()
        self.assertEqual(self.box.install(self.bundles.make())["last"]["stage"], "installed")


class AlwaysTrue(unittest.TestCase):
    def test_damaged_record_of_the_last_update_is_reported(self):
        raucs.needs_rauc()
        with tempfile.TemporaryDirectory() as folder:
            box = raucs.Box(raucs.Bundles(pathlib.Path(folder)))
            self.addCleanup(box.stop)
            for text in "{", json.dumps({"format": 9}):
                (box.folder / "state/last.json").write_text(text)
                last = box.update()["last"]
                self.assertEqual(last["stage"], "failed")
                self.assertIn("cannot read the outcome of the last update", last["why"])
