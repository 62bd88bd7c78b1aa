"""Which signatures a box accepts: its keyring is that of an image, RAUC is real, and faketime gives signatures and images their time."""

import shutil
import subprocess
import unittest

import raucs
from on_a_box import OnABox

ACCEPTS_NOT = "the update is signed by a key that this box does not accept"
THEN = "700 days ago"  # a certificate of then has ended


class Accepted(OnABox):
    @classmethod
    def setUpClass(cls):
        if shutil.which("faketime") is None:
            raise unittest.SkipTest("a signature of another time needs faketime")
        super().setUpClass()
        cls.release, cls.standby, cls.next = (raucs.Keys(cls.scratch, name) for name in ("first", "standby", "next"))
        cls.old = raucs.Keys(cls.scratch, "old", at=THEN)

    def expect_installed(self, bundle, version):
        status = self.box.install(bundle)
        self.assertEqual((status["refusal"], status["last"]["stage"], status["last"]["version"]), ("", "installed", version))

    def test_a_box_accepts_the_release_key_and_the_standby_key(self):
        self.box.accept(self.release, self.standby)
        self.expect_refused(self.box.install(self.bundles.make("0.2.0", keys=self.next)), ACCEPTS_NOT)
        self.expect_untouched()
        self.expect_installed(self.bundles.make("0.2.0", keys=self.release), "0.2.0")
        self.expect_installed(self.bundles.make("0.3.0", keys=self.standby), "0.3.0")

    def test_an_update_by_the_standby_key_ends_a_stolen_release_key(self):
        self.box.accept(self.release, self.standby)
        self.expect_installed(self.bundles.make("0.2.0", keys=self.standby), "0.2.0")
        self.box.began_before()
        self.box.accept(self.standby, self.next)  # the keyring of the slot that runs now
        self.runs("B", "0.2.0")
        self.good()
        self.box.update()
        before = self.box.contents()
        self.expect_refused(self.box.install(self.bundles.make("0.3.0", keys=self.release)), ACCEPTS_NOT)
        self.assertEqual(self.box.contents(), before)
        self.expect_installed(self.bundles.make("0.3.0", keys=self.next), "0.3.0")

    def test_a_certificate_that_has_ended_counts_only_for_a_box_whose_image_is_older(self):
        self.box.accept(self.old, at=THEN)
        self.expect_refused(self.box.install(self.bundles.make(keys=self.old)), ACCEPTS_NOT)  # signed today
        self.expect_untouched()
        backdated = self.bundles.make(keys=self.old, at=THEN)
        with self.assertRaises(subprocess.CalledProcessError):
            self.box.accept(self.old)
        self.box.accept(self.release, self.standby)
        self.expect_refused(self.box.install(backdated), ACCEPTS_NOT)
        self.expect_untouched()
        self.box.accept(self.old, at=THEN)  # no clock tells this box
        self.expect_installed(backdated, "0.2.0")
