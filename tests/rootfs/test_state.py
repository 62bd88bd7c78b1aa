#!/usr/bin/env python3
"""Which partition becomes the box's state: usr/lib/adit/state, with a disk's folder of sysfs and programs that are made here. tests/boot
starts it from a real disk; but QEMU has no eMMC, whose boot areas lie in that folder too."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import TOP, skip

SCRIPT = TOP / "rootfs/overlay/usr/lib/adit/state"
SECTORS = {"env": 2048, "boot": 81920, "boot-a": 131072, "boot-b": 131072, "root-a": 262144, "root-b": 262144}
OWN = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount"]
# It writes to /run and to the console: those of a mount namespace of its own.
CALL = """mount -t tmpfs tmpfs /run && { [ ! -e /dev/console ] || mount --bind "$1/console" /dev/console; } || exit 99
PATH="$1/bin:$PATH" sh "$2" "$1/mmcblk0"; cat /run/adit-notices/state 2>/dev/null"""
RECORD = 'echo "${0##*/} $*" >>"${0%/*}/../called"\n'
if subprocess.run([*OWN, "mount", "-t", "tmpfs", "tmpfs", "/run"], capture_output=True).returncode:
    skip("this machine gives nobody a mount namespace")


class State(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.disk = self.folder / "mmcblk0"
        (self.folder / "bin").mkdir()
        (self.folder / "console").touch()
        self.disk.mkdir()
        self.end = 32768
        for number, (name, sectors) in enumerate(SECTORS.items(), 1):
            self.partition(number, sectors, f"adit-{name}")
        for area in "mmcblk0boot0", "mmcblk0boot1", "mmcblk0rpmb":
            self.area(area, size="8192\n", uevent=f"MAJOR=179\nDEVNAME={area}\nDEVTYPE=disk\n")
        self.room(2_000_000)
        for name in "modprobe", "mount", "systemd-growfs":
            self.program(name)
        self.program("e2fsck", 'for last; do :; done; [ "$last" = /dev/mmcblk0p7 ] || exit 8\n')
        self.makes(7)

    def area(self, name, **files):
        (self.disk / name).mkdir()
        for file, text in files.items():
            (self.disk / name / file).write_text(text)

    def partition(self, number, sectors, label=None):
        name = f"mmcblk0p{number}"
        event = f"DEVNAME={name}\nDEVTYPE=partition\nPARTN={number}\n" + (f"PARTNAME={label}\n" if label else "")
        self.area(name, partition=f"{number}\n", start=f"{self.end}\n", size=f"{sectors}\n", uevent=event)
        self.end += sectors

    def room(self, sectors):
        (self.disk / "size").write_text(f"{self.end + sectors + 34}\n")

    def program(self, name, does=""):
        path = self.folder / "bin" / name
        path.write_text("#!/bin/sh\n" + RECORD + does)
        path.chmod(0o755)

    def makes(self, number):
        """What systemd-repart does: the kernel does not hear the label from it."""
        new = f"{self.disk}/mmcblk0p{number}"
        lines = [f"mkdir {new}"] + [f"echo {text} >{new}/{file}" for file, text in
                                    (("partition", number), ("start", self.end), ("size", 1_000_000), ("uevent", f"PARTN={number}"))]
        self.program("systemd-repart", "\n".join(lines) + "\n")

    def run_it(self):
        """The notice that it leaves."""
        done = subprocess.run([*OWN, "sh", "-c", CALL, "state", self.folder, SCRIPT], capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def called(self, name):
        lines = (self.folder / "called").read_text().splitlines()
        return [line for line in lines if line.split()[0] == name]

    def is_state(self, device):
        self.assertEqual({line.split()[-1] for line in self.called("e2fsck")}, {device})
        self.assertEqual([line.split()[-2:] for line in self.called("mount")], [[device, "/var"]])

    def test_the_first_start_takes_what_it_made_and_no_boot_area_of_an_emmc(self):
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(self.called("systemd-growfs"), ["systemd-growfs /var"])

    def test_a_later_start_takes_the_one_of_its_label_and_makes_none(self):
        self.partition(7, 1_000_000, "adit-state")
        self.room(0)
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(self.called("systemd-repart") + self.called("systemd-growfs"), [])

    def test_on_a_larger_disk_it_grows(self):
        self.partition(7, 1_000_000, "adit-state")
        self.room(131_073)
        self.program("systemd-repart")
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(len(self.called("systemd-repart") + self.called("systemd-growfs")), 2)

    def test_somebodys_partition_without_a_label_is_not_touched(self):
        self.partition(8, 1_000_000)
        self.room(2_000_000)
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")

    def test_without_room_it_works_from_memory_and_says_so(self):
        self.partition(8, 1_000_000)
        self.room(0)
        self.program("systemd-repart", "exit 1\n")
        self.assertIn("the disk has no room for it", self.run_it())
        self.assertEqual(self.called("e2fsck"), [])
        self.assertTrue(self.called("mount")[0].endswith("tmpfs /var"))

    def test_one_beyond_repair_is_left_as_it_is(self):
        self.program("e2fsck", "exit 8\n")
        self.assertIn("it cannot be repaired", self.run_it())
        self.assertTrue(self.called("mount")[0].endswith("tmpfs /var"))


if __name__ == "__main__":
    unittest.main()
