"""A box of an earlier release is brought to this one: what that left in its folders is taken up, and nothing of it is lost.
That it can go back afterwards is seen by the formats' own rules."""

import json
import pathlib
import shutil
import tarfile
import unittest

import requests

import left_behind
from programs import Stage, wait_until

ARCHIVES = sorted(pathlib.Path(__file__).parent.glob("left_by_*.tar.xz"))
TABLES_THEN = 3  # the version of the ledger's tables that the earliest of them can work with
KEPT = "SELECT number, type, x, y, z, sender, received, status, content_type, answer FROM report WHERE status = 201"


class Upgrade(unittest.TestCase):
    def test_takes_up_all_that_an_earlier_release_left(self):
        self.assertTrue(ARCHIVES)
        for archive in ARCHIVES:
            with self.subTest(archive.name), Stage() as stage:
                self.assertEqual(stage.box.stop(), 0)
                (stage.folder / "secrets" / "mapping.token").unlink()  # the saved one counts
                shutil.rmtree(stage.box.state)
                with tarfile.open(archive) as tar:
                    tar.extractall(stage.box.state)
                answered = stage.box.on_disk(KEPT)
                self.assertEqual(len(answered), 2)
                stage.restart_box()
                self.has_what_was_set_up(stage)
                self.has_the_reports(stage, answered)
                self.has_sent_what_waited(stage)
                self.assertEqual(stage.box.stop(), 0)
                self.can_go_back(stage)

    def has_what_was_set_up(self, stage):
        settings = stage.box.ask("GET /adit/settings")[1]["settings"]
        self.assertEqual(settings["reports"]["near_metres"], left_behind.NEAR_METRES)
        shown = requests.post(stage.box.url + "/adit/login", json={"password": left_behind.PASSWORD}, timeout=30)
        self.assertEqual(shown.status_code, 200, shown.text)

    def has_the_reports(self, stage, answered):
        self.assertEqual(stage.box.on_disk(KEPT)[:2], answered, "byte for byte")
        third = stage.box.on_disk("SELECT type, x, state FROM report WHERE number = 3")[0]
        self.assertEqual(third[:2], tuple(left_behind.another(2)[name] for name in ("type", "x")))
        self.assertIn(third[2], ("received", "waiting", "sending", "answered"), "it had never left")

    def has_sent_what_waited(self, stage):
        def arrived(uri):
            return [request["message"] for request in stage.post.requests(uri) if request["status"] == 200]

        wait_until(lambda: len(arrived("/map/update")) == 2 and arrived("/state/update") and arrived("/markers/update"),
                   "all that waited")
        sizes = {message["name"]: message["msg"]["data"]["bytes"] for message in arrived("/map/update")}
        self.assertEqual(sizes, {"r1": len(left_behind.GRID.data), "r2": len(left_behind.CLOUD.data)})
        pose, marker = arrived("/state/update")[-1]["poses"][0], arrived("/markers/update")[-1]["markers"][0]
        self.assertEqual((pose["name"], pose["position"]["x"], marker["ns"], marker["text"]), ("r3", 4.0, "a", "kept"))
        wait_until(lambda: not list((stage.box.state / "waiting").glob("*.cbor")), "its files to be removed")
        self.assertEqual(stage.post.violations(), [])

    def can_go_back(self, stage):
        """The ledger's upper 16 bits name the oldest version that can work with its tables; saved settings have the
        version that they had, and an earlier release passes over what it does not know in them."""
        version = stage.box.on_disk("PRAGMA user_version")[0]
        self.assertLessEqual(version >> 16 or version, TABLES_THEN)
        self.assertEqual(json.loads((stage.box.state / "settings.json").read_text())["version"], 1)
