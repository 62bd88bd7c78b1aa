"""The one story of the page that needs no npm: in a browser, a user leads an empty box to its first report."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest
import urllib.request

from browser import CHROMIUM, Browser
from command_post import MAPPING_TOKEN, SCORING_TOKEN, CommandPost
from patience import wait_until

ARTIFACTS = pathlib.Path(__file__).parents[1] / "wire/artifacts.csv"
PASSWORD = "a long cave password"


class Box:
    """aditd with an empty state directory and no token, which does not know where the Command Post is."""

    def __init__(self, folder):
        self.state, self.log = folder / "state", folder / "log"
        (folder / "secrets").mkdir(mode=0o700)
        nowhere = {"address": "127.0.0.1", "port": 1}
        settings = {"version": 1, "command_post": {"scoring": nowhere, "mapping": nowhere},
                    "team": {"listen": [{"address": "127.0.0.1", "port": 0}]}}
        (folder / "settings.json").write_text(json.dumps(settings))
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen([pathlib.Path(os.environ["ADIT_BIN"], "aditd"), "--settings", folder / "settings.json",
                                             "--secrets", folder / "secrets", "--state", self.state], stdout=log, stderr=log)
        listening = wait_until(lambda: re.search(r"listening .*port=(\d+)", self.log.read_text()), "aditd to listen")
        self.url = f"http://127.0.0.1:{listening[1]}/"

    def end(self):
        self.process.terminate()
        self.process.wait()


@unittest.skipUnless(os.path.exists(CHROMIUM), f"{CHROMIUM} is not installed")
class FirstReport(unittest.TestCase):
    def test_an_empty_box_is_set_up_and_sends_its_first_report(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-page-")))
        post = self.enterContext(CommandPost(artifacts=ARTIFACTS.read_text()))
        box = Box(folder)
        self.addCleanup(box.end)
        page = self.enterContext(Browser())

        page.open(box.url)
        page.has("h2", "Set the operator’s password")
        page.type("Code", (box.state / "first-start.code").read_text().strip())
        page.type("New password", PASSWORD)
        page.type("Repeat the password", PASSWORD)
        page.press("Set the password")

        page.has("#missing", "the scoring and the mapping token are missing")
        page.has("h2", "Team network")
        page.press("Next")
        for name, at in (("Scoring", post.scoring), ("Mapping", post.mapping)):
            page.type(f"{name} port", at.rpartition(":")[2])
        page.press("Next")
        page.has("#review tbody tr", post.scoring.rpartition(":")[2])
        page.press("Apply")
        for name, token in (("Scoring", SCORING_TOKEN), ("Mapping", MAPPING_TOKEN)):
            page.type(f"{name} endpoint’s token", token)
        page.press("Next")
        page.has("h2", "Robots")
        page.press("Next")
        page.press("Run the test")
        page.has("#step-test .outcome", "All is well. No report was used up.")
        page.press("Go to the run")

        page.has("body[data-link=live]")
        page.press("New report")
        page.press("Drill")
        for axis, metres in (("x", "12.5"), ("y", "-3"), ("z", "0")):
            page.type(f"#compose input[name={axis}]", metres, "selector")
        self.assertEqual(self.recorded(post), [])
        page.press("#compose .go", "selector")
        page.press("Send Drill")
        page.has("#reports li", "answered")
        self.assertEqual(self.recorded(post), [("Drill", 12.5, -3.0, 0.0)])
        self.assertEqual([each for each in page.complaints if "401" not in each and "ERR_CONNECTION" not in each], [])

    @staticmethod
    def recorded(post):
        with urllib.request.urlopen(f"http://{post.control}/record") as answer:
            return [tuple(report[name] for name in ("type", "x", "y", "z")) for report in json.load(answer)["reports"]]
