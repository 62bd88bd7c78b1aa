"""adit-spare and USB sticks: images of real file systems, mounted by a stand-in for systemd-mount that calls mount(8): real_stick.py
ADIT_SPARE. Skipped (77) if mounts are not possible; FAT is skipped if the kernel lacks it."""

import contextlib
import json
import os
import pathlib
import secrets
import shutil
import subprocess
import sys
import tempfile
import unittest

from mounting import Slots, be_alone, can_mount, make, run

NAME = "adit-10.0.0.1-20261123T231600Z.adit-spare"
EXPORT = b"adit-spare\x01\x00" + secrets.token_bytes(1 << 20)
PART = "adit-spare.part"
adit_spare = sys.argv[1]


def setUpModule():
    if os.geteuid() == 0:
        be_alone()
    if not can_mount("ext4"):
        raise unittest.SkipTest("no file system can be mounted here")


class Sticks(unittest.TestCase):
    kind = "ext4"

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-stick-")))
        for name in ("wanted", "status"):
            (self.folder / name).mkdir()
        self.slots = Slots(self.folder)
        self.calls, self.place, self.mount_stick = self.slots.calls, self.slots.place, self.slots.mount_stick
        self.addCleanup(self.slots.unmount_all)
        self.status = self.run_it()  # a machine that has just started

    def plug(self, name="sda1", size=16 << 20):
        image = self.folder / f"{name}.img"
        make(self.kind, image, size)
        self.slots.plug(image, name)
        return image

    def put(self, files, stick="sda1"):
        """Unmounts the stick as a user does at a PC."""
        run("umount", self.place(stick))
        run("mount", "-o", "loop", self.folder / "dev" / stick, self.place(stick))
        for name, data in files.items():
            (self.place(stick) / name).write_bytes(data)
        run("umount", self.place(stick))
        self.mount_stick(stick)

    def hook(self, script):
        (self.folder / "hook").write_text(script)

    def run_it(self):
        """Runs adit-spare to its end and returns its status."""
        done = subprocess.run([adit_spare, "--wanted", self.folder / "wanted", "--status", self.folder / "status",
                               *self.slots.options()], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.folder / "status/status.json").read_text())

    def ask(self, what, name=NAME, export=None):
        nonce = secrets.token_hex(16)
        if export is not None:
            (self.folder / "wanted/stick.adit-spare").write_bytes(export)
        (self.folder / "wanted/stick.json").write_text(json.dumps({"format": 1, "nonce": nonce, "what": what, "name": name}))
        status = self.run_it()
        self.assertEqual((status["nonce"], status["doing"]), (nonce, ""))
        self.assertEqual(list((self.folder / "wanted").iterdir()), [], "what was asked for is taken away")
        return status

    def write(self, export=EXPORT):
        return self.ask("write", export=export)

    def is_read_only(self, name="sda1"):
        return os.path.ismount(self.place(name)) and bool(os.statvfs(self.place(name)).f_flag & os.ST_RDONLY)

    def expect_refused(self, status, *words):
        for word in words:
            self.assertIn(word, status["refusal"])
        self.assertEqual(status["written"], "")


class Stick(Sticks):
    def test_export_is_complete_and_the_stick_may_be_removed(self):
        image = self.plug()
        self.put({"photo": b"of a cave"})
        status = self.write()
        self.assertEqual((status["refusal"], status["written"], status["exports"]), ("", NAME, [NAME]))
        self.assertEqual(self.calls.read_text().splitlines(), ["umount sda1", "mount rw sda1", "umount sda1", "mount ro sda1"])
        self.assertTrue(self.is_read_only())
        run("umount", self.place())
        shutil.copy(image, self.folder / "pulled")  # as it was at that instant
        run("mount", "-o", "loop,ro", self.folder / "pulled", self.place())
        self.assertEqual((self.place() / NAME).read_bytes(), EXPORT)
        self.assertEqual({each.name for each in self.place().iterdir()} - {"lost+found"}, {NAME, "photo"})

    def test_export_replaces_one_of_the_same_name(self):
        self.plug()
        self.write()
        later = EXPORT[:-4] + b"last"
        self.assertEqual(self.write(later)["written"], NAME)
        self.assertEqual((self.place() / NAME).read_bytes(), later)

    def test_stick_without_room_is_unchanged(self):
        self.plug(size=3 << 20)
        self.put({"photo": bytes(1 << 20)})
        before = set(os.listdir(self.place()))
        self.expect_refused(self.write(EXPORT + bytes(4 << 20)), "the stick has room for", "but the export has")
        self.assertEqual((self.calls.read_text(), set(os.listdir(self.place()))), ("", before))

    def test_stick_that_fills_up_is_unchanged(self):
        self.plug(size=8 << 20)
        self.hook('[ "$1" != rw ] || dd if=/dev/zero of="$2/filler" bs=64k 2>/dev/null || true\n')
        self.expect_refused(self.write(), "the stick is full")
        self.assertTrue(self.is_read_only())
        self.assertFalse({NAME, PART} & set(os.listdir(self.place())))

    def test_write_protected_stick_is_reported(self):
        self.plug()
        (self.folder / "block/sda1/ro").write_text("1\n")
        self.assertEqual(self.run_it()["hindrance"], "the stick is write-protected")
        self.expect_refused(self.write(), "the stick is write-protected")
        self.assertEqual(self.calls.read_text(), "")

    def test_stick_that_turns_read_only_is_reported(self):
        self.plug()
        self.hook('[ "$1" != rw ] || mount -o remount,ro "$2"\n')
        self.expect_refused(self.write(), "the stick is write-protected, or its file system is damaged")
        self.assertTrue(self.is_read_only())

    def test_unreadable_file_system_is_reported_with_the_expected_ones(self):
        self.plug()
        run("umount", self.place())
        (self.folder / "sda1.img").write_bytes(bytes(1 << 20))
        self.mount_stick()
        status = self.run_it()
        self.assertIn("expected FAT32, exFAT or ext4", status["hindrance"])
        self.assertIn("expected FAT32, exFAT or ext4", status["unreadable"], "of a spare that is not on standby")
        self.expect_refused(self.write(), "the box cannot read the stick's file system")

    def test_stick_with_too_many_names_is_not_taken_for_an_empty_one(self):
        self.plug(size=32 << 20)
        self.put({f"photo{i}": b"" for i in range(4097)})
        status = self.run_it()
        self.assertEqual((status["exports"], status["unreadable"]), ([], "cannot read the stick sda1: holds more than 4096 files"))
        self.assertEqual(status["hindrance"], "")

    def test_missing_stick_is_reported(self):
        self.expect_refused(self.write(), "there is no stick in the box")
        self.expect_refused(self.ask("take"), "no stick has this export")

    def test_export_beyond_the_list_is_found(self):
        for i in range(257):
            self.place(f"old{i}").mkdir(parents=True)
        why = "cannot list the sticks"
        self.expect_refused(self.write(), why)
        self.expect_refused(self.ask("take"), why)
        self.assertIn(why, self.run_it()["hindrance"])

    def test_several_sticks_are_rejected(self):
        self.plug()
        self.plug("sdb1")
        self.expect_refused(self.write(), "more than one stick")
        self.assertEqual(self.calls.read_text(), "")

    def test_stick_in_use_is_reported_and_unchanged(self):
        self.plug()
        self.put({"adit-box-1.0.0.raucb": bytes(100)})
        with open(self.place() / "adit-box-1.0.0.raucb", "rb"):  # as adit-update reads it
            self.expect_refused(self.write(), "the stick is in use")
        self.assertTrue(self.is_read_only())
        self.assertEqual(self.write()["written"], NAME)
        self.assertTrue((self.place() / "adit-box-1.0.0.raucb").exists())

    def test_stick_removed_at_any_time_is_reported(self):
        out = f"rm -r {self.folder}/block/sda1 {self.folder}/dev/sda1; umount --lazy"
        for moment in ("rw", "ro"):
            with self.subTest(moment):
                self.plug()
                self.hook(f'[ "$1" != {moment} ] || {{ {out} "$2"; }}\n')
                self.expect_refused(self.write(), "the stick was removed before")
                self.assertEqual(self.run_it()["hindrance"], "there is no stick in the box")
                (self.folder / "hook").unlink()

    def test_stick_that_stores_other_bytes_is_detected(self):
        """A stick that loses writes: adit-spare checks by reading back."""
        self.plug()
        lies = f'[ "$1" != ro ] || {{ umount "$2"; mount -o loop,rw {self.folder}/dev/sda1 "$2"; printf x >>"$2/{NAME}"; mount -o remount,ro "$2"; }}\n'
        self.hook(lies)
        self.expect_refused(self.write(), "the export on the stick differs from the written bytes")

    def test_write_error_is_reported(self):
        """Writes beyond the medium's size are lost, as on a failing stick."""
        small = self.folder / "small"
        small.mkdir()
        run("mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", small)
        self.addCleanup(lambda: subprocess.run(["umount", "--lazy", small], check=False))
        self.plug()
        run("umount", self.place())
        run("cp", "--sparse=always", self.folder / "dev/sda1", small / "image")
        (self.folder / "dev/sda1").unlink()
        (self.folder / "dev/sda1").symlink_to(small / "image")
        self.mount_stick()
        self.assertNotEqual(self.write(EXPORT + EXPORT)["refusal"], "")

    def test_stick_is_read_only_again_after_a_kill(self):
        self.plug()
        self.hook(f'[ "$1" != rw ] || {{ rm {self.folder}/hook; kill -9 $(ps -o ppid= $PPID); }}\n')
        (self.folder / "wanted/stick.adit-spare").write_bytes(EXPORT)
        (self.folder / "wanted/stick.json").write_text(
            json.dumps({"format": 1, "nonce": secrets.token_hex(16), "what": "write", "name": NAME}))
        with contextlib.suppress(AssertionError):
            self.run_it()
        self.assertFalse(self.is_read_only(), "it was killed there")
        status = self.run_it()
        self.assertEqual((status["doing"], status["refusal"]), ("", "the last action was interrupted: try again"))
        self.assertTrue(self.is_read_only())
        self.assertEqual(self.write()["written"], NAME)

    def test_requested_export_is_read(self):
        self.plug()
        other = "export (1).adit-spare"
        self.put({NAME: EXPORT, other: EXPORT + b"other", "._" + NAME: b"of a Mac", "adit-spare.txt": b"a note"})
        self.assertEqual(self.run_it()["exports"], [NAME, other], "the latest first")
        self.assertEqual(self.ask("take", other)["refusal"], "")
        self.assertEqual((self.folder / "status/export.adit-spare").read_bytes(), EXPORT + b"other")

    def test_hostile_stick_leads_nowhere(self):
        self.plug()
        secret = self.folder / "secret"
        secret.write_bytes(EXPORT)
        run("umount", self.place())
        run("mount", "-o", "loop", self.folder / "dev/sda1", self.place())
        top = self.place()
        (top / "link.adit-spare").symlink_to(secret)
        os.mkfifo(top / "pipe.adit-spare")
        (top / "folder.adit-spare").mkdir()
        (top / "none.adit-spare").write_bytes(b"PK\x03\x04 a zip file")
        (top / "empty.adit-spare").touch()
        with open(top / "large.adit-spare", "wb") as large:
            large.write(EXPORT)
            large.truncate(1 << 33)
        (top / b"\xff\x1b[2J.adit-spare".decode("utf-8", "surrogateescape")).write_bytes(EXPORT)
        run("umount", top)
        self.mount_stick()
        self.assertEqual(self.run_it()["exports"], [f"{name}.adit-spare" for name in ("empty", "large", "none")], "files only")
        for name, why in (("link", "link.adit-spare"), ("pipe", "is not a regular file"), ("folder", "is not a regular file"),
                          ("none", "the file is not an export from Adit"), ("empty", "the file is not an export from Adit"),
                          ("large", "larger than an export may be")):
            with self.subTest(name):
                self.expect_refused(self.ask("take", f"{name}.adit-spare"), why)
        self.assertFalse((self.folder / "status/export.adit-spare").exists())

    def test_at_most_eight_exports_are_listed(self):
        self.plug()
        self.put({f"adit-10.0.0.1-202611{day}T000000Z.adit-spare": EXPORT[:100] for day in range(10, 22)})
        self.assertEqual(self.run_it()["exports"][::7], [f"adit-10.0.0.1-202611{day}T000000Z.adit-spare" for day in (21, 14)])

    def test_other_files_are_not_written(self):
        self.plug()
        for export, why in ((b"#!/bin/sh", "the file is not an export from Adit"), (EXPORT + bytes(9 << 20), "larger than an export may be")):
            self.expect_refused(self.write(export), why)
        target = self.folder / "secret"
        target.write_bytes(EXPORT)
        (self.folder / "wanted/stick.adit-spare").symlink_to(target)
        self.expect_refused(self.ask("write"), "stick.adit-spare")
        self.expect_refused(self.ask("write"), "stick.adit-spare")  # there is none
        self.assertEqual(self.calls.read_text(), "")

    def test_request_from_before_the_boot_is_dropped(self):
        self.plug()
        (self.folder / "status/status.json").unlink()
        (self.folder / "wanted/stick.adit-spare").write_bytes(EXPORT)
        (self.folder / "wanted/stick.json").write_text(
            json.dumps({"format": 1, "nonce": secrets.token_hex(16), "what": "write", "name": NAME}))
        self.assertEqual((self.run_it()["written"], list((self.folder / "wanted").iterdir())), ("", []))


class HostileFileSystem(Sticks):
    def test_stick_cannot_ask_for_a_panic(self):
        image = self.folder / "sda1.img"
        make(self.kind, image)
        run("tune2fs", "-e", "panic", image, env={**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"})
        self.hook(f'grep -F " $2 " /proc/mounts >>{self.folder}/mounts')
        self.slots.plug(image)
        self.assertEqual(self.write()["written"], NAME)
        mounts = (self.folder / "mounts").read_text().splitlines()
        self.assertEqual([line.split()[3].split(",")[0] for line in mounts], ["ro", "rw", "ro"])
        for line in mounts:
            self.assertIn("errors=remount-ro", line)


class FatStick(Stick):
    """The usual file systems of sticks. Tests that need a Linux file system, or many names at the top, are left out."""

    kind = "vfat"
    test_hostile_stick_leads_nowhere = test_write_error_is_reported = test_stick_with_too_many_names_is_not_taken_for_an_empty_one = None

    @classmethod
    def setUpClass(cls):
        if not can_mount("vfat"):
            raise unittest.SkipTest("this kernel mounts no FAT")
