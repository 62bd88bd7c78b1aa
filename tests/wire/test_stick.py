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
        stage.adit("export", "--stick", "--yes", exits=1)  # there is no stick
        self.assertFalse(stage.box.ask("GET /adit/spare")[1]["standby"])
        stage.keepers[0].plug(stage.image)
        wait_until(lambda: not stage.stick()["hindrance"], "the stick to be found")
        said = stage.adit("export", "--stick", "--yes")
        self.assertIn("which you may now unplug", said)
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
        self.assertIn(f"On the stick: {offer['name']}", stage.adit("show"))
        stage.adit("take", "--stick", "--code", "0" * 16, "--yes", exits=1)
        stage.adit("take", "--stick", "--code", code, "--yes")
        wait_until(stage.settled, "the spare to have taken over")
        began(stage)
        for number, answer in enumerate(answers, 1):
            again = submit(stage, another(number))
            self.assertEqual((again.status_code, again.content), (201, answer.content), "byte for byte")
        self.assertTrue(stage.all_recorded([another(number) for number in (1, 2, 3)]))
