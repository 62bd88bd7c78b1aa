"""A box of files with a real RAUC, for each test of adit-update."""

import pathlib
import shutil
import tempfile
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
        self.assertEqual(self.box.boot_loader(), {"BOOT_ORDER": "A B", "BOOT_A_LEFT": raucs.PROVEN, "BOOT_B_LEFT": raucs.PROVEN})

    def expect_refused(self, status, sentence):
        self.assertIn(sentence, status["refusal"])
        self.assertEqual((status["doing"], status["progress"]), ("", None))
        self.assertEqual(list((self.box.folder / "wanted").iterdir()), [])
