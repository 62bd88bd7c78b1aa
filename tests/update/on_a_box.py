"""A box of plain files with a real RAUC, for each test of adit-update."""

import os
import pathlib
import shutil
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

    def good(self):
        """Runs `adit-update good` as on a box that was healthy for long."""
        since = int((time.clock_gettime(time.CLOCK_MONOTONIC) - 100) * 1e6)
        self.box.properties.write_text(f"ActiveState=active\nActiveEnterTimestampMonotonic={since}\n")
        subprocess.run(self.box.command("good"), env=self.box.environment, stderr=subprocess.DEVNULL, timeout=raucs.patient(60), check=True)

    def runs(self, slot, version):
        self.box.start(slot)
        (self.box.folder / "os-release").write_text(f"VERSION_ID={version}\n")

    def set(self, name, value):
        subprocess.run([self.box.folder / "bin/fw_setenv", name, value], check=True)

    def cut_off(self):
        """Cuts the power while slot B is written."""
        shutil.copy(self.bundles.make("0.3.0", root_size=(4 << 20) - 4096), self.box.folder / "wanted/update.raucb")
        self.box.ask("install")
        # Its new content stays incomplete: the writing process is stopped at its begin.
        os.remove(self.box.slots["root-b"])
        os.mkfifo(self.box.slots["root-b"])
        with subprocess.Popen(self.box.command(), env=self.box.environment, stderr=subprocess.DEVNULL) as process:
            raucs.wait_until(lambda: self.box.status()["doing"] == "installing" and self.box.boot_loader()["BOOT_B_LEFT"] == "0",
                             "the other slot marked bad")
            process.kill()  # before RAUC, whose end it would note
            process.wait()
            self.box.halt()
        os.remove(self.box.slots["root-b"])
        self.box.slots["root-b"].write_bytes(bytes(4 << 20))
        self.box.began_before()

    def expect_untouched(self):
        self.assertEqual(self.box.contents(), self.before)
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "A B", "BOOT_A_LEFT": raucs.PROVEN, "BOOT_B_LEFT": raucs.PROVEN})

    def expect_refused(self, status, sentence):
        self.assertIn(sentence, status["refusal"])
        self.assertEqual((status["doing"], status["progress"]), ("", None))
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])
