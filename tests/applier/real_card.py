"""A card as somebody prepares it on a PC: a FAT image, mounted as boot.mount has it: real_card.py ADIT_IMPORT SOURCE. Skipped
(77) where nothing can be mounted."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TOKEN = "a-token-of-the-card-0123456789"
SETTINGS = {"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000},
                                           "mapping": {"address": "10.100.1.201", "port": 8000}},
            "team": {"listen": [{"address": "0.0.0.0", "port": 8000}], "connections": 40}}
adit_import, source = sys.argv[1], pathlib.Path(sys.argv[2])


def setUpModule():
    if not can_mount():
        raise unittest.SkipTest("no FAT image can be mounted here")


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options)


def mount_options():
    text = (source / "services/boot.mount").read_text()
    return re.search(r"^Options=(.*)$", text, re.M).group(1)


class Card(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-card-")))
        self.image, self.boot = self.folder / "card.img", self.folder / "boot"
        self.boot.mkdir()
        with open(self.image, "wb") as image:
            image.truncate(16 << 20)
        run("mformat", "-i", self.image, "-v", "ADIT", "::")
        run("mmd", "-i", self.image, "::/adit", "::/adit/secrets")
        (self.folder / "given.json").write_text(json.dumps(SETTINGS))

    def put(self, name, text):
        run("mcopy", "-i", self.image, "-", f"::/adit/{name}", input=text)

    def start(self):
        """What adit-import does at one start of the box; its exit status."""
        run("mount", "-o", f"loop,{mount_options()}", self.image, self.boot)
        try:
            done = subprocess.run([adit_import, "--card", self.boot / "adit", "--state", self.folder / "private/adit",
                                   "--network", self.folder / "network", "--given", self.folder / "given.json"],
                                  capture_output=True, text=True, check=False)
            self.said = done.stderr
            return done.returncode
        finally:
            run("umount", self.boot)

    def read(self, name):
        return run("mtype", "-i", self.image, f"::/adit/{name}").stdout

    def names(self, folder=""):
        return set(run("mdir", "-b", "-i", self.image, f"::/adit/{folder}").stdout.split())

    def test_is_taken_and_keeps_no_token(self):
        self.put("settings.json", json.dumps(SETTINGS))
        self.put("secrets/scoring.token", TOKEN)
        self.assertIn(TOKEN.encode(), self.image.read_bytes())
        self.assertEqual(self.start(), 0, self.said)
        self.assertIn("adit/secrets/scoring.token: accepted", self.read("taken.txt"))
        self.assertNotIn(TOKEN.encode(), self.image.read_bytes(), "it can still be read from the card")
        self.assertEqual(self.names(), {"::/adit/secrets/", "::/adit/settings.json.taken", "::/adit/taken.txt"})
        self.assertEqual((self.folder / "private/adit/secrets/scoring.token").read_text().strip(), TOKEN)
        saved = json.loads((self.folder / "private/adit/settings.json").read_text())
        self.assertEqual(saved["team"]["connections"], 40)

    def test_is_taken_again_once_something_is_put_there_again(self):
        for connections in (41, 42):
            document = {**SETTINGS, "team": {**SETTINGS["team"], "connections": connections}}
            self.put("settings.json", json.dumps(document))
            self.assertEqual(self.start(), 0, self.said)
            saved = json.loads((self.folder / "private/adit/settings.json").read_text())
            self.assertEqual(saved["team"]["connections"], connections)
        before = self.image.read_bytes()
        self.assertEqual(self.start(), 0)
        self.assertEqual(self.image.read_bytes()[1024:], before[1024:], "a start without anything new wears the card")

    def test_says_by_its_path_what_is_wrong(self):
        self.put("SETTINGS.JSON", json.dumps({**SETTINGS, "tem": {}}))
        self.put("secrets/scoring.token", TOKEN)
        self.assertEqual(self.start(), 0, self.said)
        self.assertIn("adit/settings.json: tem: no such key", self.read("taken.txt"))
        self.assertFalse((self.folder / "private").exists())
        self.assertEqual(self.read("secrets/scoring.token"), TOKEN)

    def test_that_is_full_is_not_taken(self):
        self.put("settings.json", json.dumps(SETTINGS))
        with open(self.folder / "filler", "wb") as filler:
            filler.truncate(20 << 20)
        subprocess.run(["mcopy", "-i", self.image, self.folder / "filler", "::/filler"], check=False,
                       capture_output=True)
        run("mount", "-o", "loop", self.image, self.boot)
        with open(self.boot / "rest", "wb") as rest:
            try:
                while True:
                    rest.write(bytes(512))
                    rest.flush()
            except OSError:
                pass
        run("umount", self.boot)
        self.assertEqual(self.start(), 1)
        self.assertIn("cannot be written", self.said)
        self.assertFalse((self.folder / "private").exists())


def can_mount():
    if not shutil.which("mformat"):
        return False
    with tempfile.TemporaryDirectory() as folder:
        image, place = pathlib.Path(folder) / "image", pathlib.Path(folder) / "place"
        place.mkdir()
        with open(image, "wb") as file:
            file.truncate(1 << 20)
        run("mformat", "-i", image, "::")
        if subprocess.run(["mount", "-o", "loop", image, place], capture_output=True, check=False).returncode != 0:
            return False
        run("umount", place)
        return True
