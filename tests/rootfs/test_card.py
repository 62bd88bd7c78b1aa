"""The cards that need adit-import: rootfs/initrd/card with directories as users leave them. A card that wrongly counts as empty would
never be imported; one that wrongly does not costs a second."""
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import TOP

CARD = TOP / "rootfs/initrd/card"


class Card(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def is_empty(self, *files):
        for file in files:
            path = self.folder / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        return not subprocess.run(["sh", "-euc", '. "$1"; card_is_empty "$2"', "sh", CARD, self.folder], check=False).returncode

    def test_empty_without_a_directory(self):
        self.assertTrue(self.is_empty())
        self.assertTrue(self.is_empty("EFI/BOOT/grub.cfg"))

    def test_empty_with_imported_files(self):
        (self.folder / "adit/secrets").mkdir(parents=True)
        self.assertTrue(self.is_empty("adit/boot.env", "adit/taken.txt", "adit/settings.json.taken", "adit/network.json.taken"))

    def test_not_empty_with_a_file_to_import(self):
        for file in ("settings.json", "network.json", "SETTINGS.JSON", "secrets/label.code", "secrets/scoring.token", "settings.json.txt"):
            with self.subTest(file):
                self.setUp()
                self.assertFalse(self.is_empty("adit/boot.env", f"adit/{file}"))

    def test_not_empty_with_a_token_to_wipe(self):
        self.assertFalse(self.is_empty("adit/secrets/scoring.token.taken"))
