"""A spare box takes over by a USB stick: from the press at the one to the press at the other, by `adit`, aditd and adit-spare."""

import os
import pathlib
import subprocess
import sys
import threading
import unittest

import programs
from programs import wait_until
from reporting import QUICK, another, began, submit
from test_spare import Swap

sys.path.insert(0, str(pathlib.Path(os.environ["ADIT_SOURCE"]) / "tests" / "applier"))
import mounting  # noqa: E402


def setUpModule():
    if not mounting.can_mount("ext4"):
        raise unittest.SkipTest("needs root and loop devices: it mounts ext4")


class Keeper:
    """adit-spare at one box, started as its path unit starts it, and with each stick."""

    def __init__(self, folder):
        self.folder, self.state = folder, folder / "state"
        (folder / "slots").mkdir()
        (folder / "spare-stick").mkdir()
        self.slots = mounting.Slots(folder / "slots")
        self.ends, self.changed = threading.Event(), threading.Event()
        self.changed.set()
        self.thread = threading.Thread(target=self._watch)
        self.thread.start()

    def _watch(self):
        while not self.ends.is_set():
            if self.changed.is_set() or (self.state / "stick.json").exists():
                self.changed.clear()
                subprocess.run([programs.BIN / "adit-spare", "--wanted", self.state, "--status", self.folder / "spare-stick",
                                *self.slots.options()], capture_output=True, check=True, timeout=60)
            self.ends.wait(0.02)

    def plug(self, image):
        self.slots.plug(image)
        self.changed.set()

    def pull(self):
        self.slots.pull()
        self.changed.set()

    def close(self):
        self.ends.set()
        self.thread.join()
        self.slots.unmount_all()


class ByStick(Swap):
    def __enter__(self):
        super().__enter__()
        self.image = self.folder / "stick.img"
        mounting.make("ext4", self.image)
        self.keepers = []
        self.keeper_of(self.folder)
        return self

    def keeper_of(self, folder):
        self.keepers.append(Keeper(folder))

    def __exit__(self, *why):
        for keeper in self.keepers:
            keeper.close()
        super().__exit__(*why)

    def stick(self):
        return self.box.ask("GET /adit/spare")[1]["stick"]


class Stick(unittest.TestCase):
    def by_stick(self):
        return began(self.enterContext(ByStick(**QUICK)))

    def test_carries_all_that_is_known_to_the_spare(self):
        stage = self.by_stick()
        answers = [submit(stage, another(number)) for number in range(1, 4)]
        said = stage.adit("export", "--stick", "--yes", check=False)
        self.assertIn("the box is not put to rest: there is no stick in the box", said)
        self.assertFalse(stage.box.ask("GET /adit/spare")[1]["rests"])
        stage.keepers[0].plug(stage.image)
        wait_until(lambda: not stage.stick()["hindrance"], "the stick to be found")
        said = stage.adit("export", "--stick", "--yes")
        self.assertIn("which may be unplugged", said)
        stage.keepers[0].pull()  # at the moment of the answer
        code = stage.box.ask("GET /adit/spare")[1]["code"]
        self.assertIn(code, said)
        stage.unplug()
        stage.plug_in_spare()
        stage.keeper_of(stage.spare_folder)
        stage.keepers[1].plug(stage.image)
        wait_until(lambda: stage.stick() and stage.stick()["exports"], "the export to be found")
        [offer] = stage.stick()["exports"]
        self.assertEqual(offer["box"], stage.network.box_address)
        self.assertIn(f"On the stick: {offer['name']}", stage.adit("show", check=False))
        self.assertIn("the code is not that of this export", stage.adit("take", "--stick", "--code", "0" * 16, "--yes", check=False))
        stage.adit("take", "--stick", "--code", code, "--yes")
        wait_until(stage.settled, "the spare to have taken over")
        began(stage)
        for number, answer in enumerate(answers, 1):
            again = submit(stage, another(number))
            self.assertEqual((again.status_code, again.content), (201, answer.content), "byte for byte")
        self.assertTrue(stage.all_recorded([another(number) for number in (1, 2, 3)]))

    def test_that_is_pulled_out_too_early_is_told_of_and_another_one_does(self):
        stage = self.by_stick()
        self.assertEqual(submit(stage, another(1)).status_code, 201)
        keeper = stage.keepers[0]
        keeper.plug(stage.image)
        wait_until(lambda: not stage.stick()["hindrance"], "the stick to be found")
        slots = keeper.slots
        hook = slots.folder / "hook"
        hook.write_text(f'rm -r {hook} {slots.folder}/block/sda1 {slots.folder}/dev/sda1; umount --lazy "$2"\n')
        said = stage.adit("export", "--stick", "--yes", check=False)
        self.assertIn("the box rests, and its export is not on the stick: the stick was pulled out", said)
        self.assertIn("there is no stick in the box", stage.adit("export", "--stick", "--yes", check=False))
        second = stage.folder / "second.img"
        mounting.make("ext4", second)
        keeper.plug(second)
        wait_until(lambda: not stage.stick()["hindrance"], "the second stick to be found")
        self.assertIn("which may be unplugged", stage.adit("export", "--stick", "--yes"))

    def test_with_what_is_no_export_changes_nothing(self):
        stage = self.by_stick()
        self.assertEqual(submit(stage, another(1)).status_code, 201)
        desk = stage.folder / "desk"  # where the stick was written to, before anybody looks at it
        desk.mkdir()
        mounting.run("mount", "-o", "loop", stage.image, desk)
        (desk / "a.adit-spare").write_bytes(b"PK\x03\x04 a zip file")
        (desk / "b.adit-spare").write_bytes(b"adit-spare\x07\x00 of a later Adit")
        mounting.run("umount", desk)
        stage.keepers[0].plug(stage.image)
        wait_until(lambda: len(stage.stick()["exports"]) == 2, "both to be found")
        for name, why in (("a", "it is no export of an Adit"), ("b", "a later Adit made this export")):
            self.assertIn(why, stage.adit("take", f"{name}.adit-spare", "--stick", "--code", "1" * 16, "--yes", check=False))
        self.assertIn("several exports", stage.adit("take", "--stick", "--code", "1" * 16, "--yes", check=False))
        self.assertIn("there is no such export on a stick",
                      stage.adit("take", "c.adit-spare", "--stick", "--code", "1" * 16, "--yes", check=False))
        self.assertEqual(submit(stage, another(2)).status_code, 201)
