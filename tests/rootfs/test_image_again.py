"""The image of qemu-virt is built again in another directory and time zone, from the same parts."""
import datetime
import hashlib
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import IMAGES, TOP, built
from test_image import parts_of

BOARDS = built()


def digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class Again(unittest.TestCase):
    def test_the_same_packages_and_programs_give_the_same_bytes(self):
        board, debian = "qemu-virt", IMAGES / "debian-arm64"
        if board not in BOARDS or not (debian / "words").exists():
            self.skipTest("no image of qemu-virt was built here")
        there = IMAGES / board / "work"
        version = re.search(r"^VERSION_ID=(.*)$", (there / "root/etc/os-release").read_text(), re.M)[1]
        created = datetime.datetime.fromisoformat(parts_of(board)["creationInfo"]["created"])
        env = os.environ | {"SOURCE_DATE_EPOCH": str(int(created.timestamp())), "ADIT_KEYRING": str(there / "root/etc/rauc/keyring.pem"), "TZ": "XYZ-11"}
        with tempfile.TemporaryDirectory() as scratch:
            work = Path(scratch)
            for command in (["rootfs/slot", board, version, TOP / "build/arm64", debian, work], ["rootfs/disk", board, debian, work, work / "disk.img"]):
                subprocess.run(command, check=True, cwd=TOP, env=env, stdout=subprocess.DEVNULL)
            for name in "root.squashfs", "boot.vfat", "parts.spdx.json":
                self.assertEqual(digest(work / name), digest(there / name), name)
            self.assertEqual(digest(work / "disk.img"), digest(IMAGES / board / f"adit-{board}-{version}.img"))
