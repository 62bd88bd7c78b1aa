"""Updates on USB sticks."""

import os
import shutil

import raucs
from on_a_box import OnABox


class AStick(OnABox):
    def put(self, name, *words, stick="sda1", **more):
        shutil.copy(self.bundles.make(*words, **more), self.box.folder / "sticks" / stick / name)

    def test_newest_fitting_update_is_offered(self):
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

    def test_newest_updates_of_this_board_are_read_first(self):
        for minor in range(2, 12):
            self.put(f"{raucs.BOARD}-0.{minor}.0.raucb", f"0.{minor}.0")
        for number in range(8):
            (self.box.folder / f"sticks/sda1/adit-a-board-9.{number}.0.raucb").write_bytes(b"of another board")
        self.assertEqual(self.box.update()["stick"], {"name": f"{raucs.BOARD}-0.11.0.raucb", "version": "0.11.0"})

    def test_several_sticks_and_partitions_are_read_like_one(self):
        for stick in ("sda2", "sdb1"):
            (self.box.folder / "sticks" / stick).mkdir()
        self.put("adit-one.raucb", "0.2.0")
        self.put("adit-one.raucb", "0.3.0", stick="sdb1")
        self.put("adit-two.raucb", "0.1.0", stick="sda2")
        self.assertEqual(self.box.update()["stick"], {"name": "adit-one.raucb", "version": "0.3.0"})
        self.box.ask("stick")
        self.assertEqual(self.box.update()["last"]["version"], "0.3.0", "of two files that are called alike, the one offered")

    def test_file_name_outside_ascii_is_reported(self):
        shutil.copy(self.newer, os.fsencode(self.box.folder / "sticks/sda1") + b"/adit-\xff.raucb")
        status = self.box.update()
        self.assertIsNone(status["stick"])
        self.assertEqual(status["stick_trouble"], "adit-\\xff.raucb: rename the file: only ASCII characters are allowed")
        self.put("adit-good.raucb", "0.3.0")
        self.assertEqual(self.box.update()["stick"]["version"], "0.3.0")

    def test_stick_full_of_files_is_reported(self):
        for number in range(4097):
            (self.box.folder / f"sticks/sda1/photo-{number}").touch()
        self.assertEqual(self.box.update()["stick_trouble"], "sda1: holds more than 4096 files")

    def test_stick_without_a_fitting_update_is_explained(self):
        self.put("adit-old.raucb", "0.0.1")
        status = self.box.update()
        self.assertIsNone(status["stick"])
        self.assertIn("adit-old.raucb: the update is older", status["stick_trouble"])
        self.box.ask("stick")
        self.expect_refused(self.box.update(), "the update is older")
        self.expect_untouched()

    def test_removed_stick_is_reported(self):
        self.box.ask("stick")
        self.expect_refused(self.box.update(), "no stick has an update")
