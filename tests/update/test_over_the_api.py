"""An update as an operator makes it: uploaded to a real aditd, installed by adit-update with a real RAUC."""

import contextlib
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import raucs

TOKEN = "team-token-1"


class Aditd:
    def __init__(self, box):
        self.box, self.log = box, box.folder / "aditd.log"
        secrets = box.folder / "secrets"
        secrets.mkdir(mode=0o700)
        (secrets / "team.token").write_text(TOKEN)
        (secrets / "team.token").chmod(0o600)
        nowhere = {"address": "127.0.0.1", "port": 9}
        (box.folder / "settings.json").write_text(json.dumps({
            "version": 1, "command_post": {"scoring": nowhere, "mapping": nowhere},
            "team": {"listen": [{"address": "127.0.0.1", "port": 0}]}}))
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(
                [os.path.join(os.environ["ADIT_BIN"], "aditd"), "--settings", box.folder / "settings.json", "--secrets", secrets, "--state",
                 box.folder / "wanted", "--update", box.folder / "status"], stdout=log, stderr=log,
                env={**os.environ, "ASAN_OPTIONS": "quarantine_size_mb=1"})  # else what is freed stays resident there
        found = raucs.wait_until(lambda: re.search(r"listening .*port=(\d+)", self.log.read_text()), "aditd to listen")
        self.port = int(found.group(1))

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait()

    def ask(self, method, path, body=None, kind="application/octet-stream", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=raucs.patient(60))
        with contextlib.closing(connection):
            headers = {"Authorization": f"Bearer {TOKEN}", **({"Content-Type": kind} if method == "POST" else {}), **headers}
            connection.request(method, path, body, headers)
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read())

    def resident(self):
        return int(re.search(r"VmHWM:\s+(\d+)", pathlib.Path(f"/proc/{self.process.pid}/status").read_text()).group(1)) >> 10


HEAD = b"hsqs" + bytes(36) + (4096).to_bytes(8, "little")  # as a bundle begins: a squashfs of one page


class OverTheApi(unittest.TestCase):
    def setUp(self):
        raucs.needs_rauc()
        self.scratch = pathlib.Path(tempfile.mkdtemp(prefix="adit-update-api."))
        self.addCleanup(shutil.rmtree, self.scratch)
        self.bundles = raucs.Bundles(self.scratch)
        self.box = raucs.Box(self.bundles)
        self.addCleanup(self.box.stop)
        self.box.update()
        self.aditd = Aditd(self.box)
        self.addCleanup(self.aditd.stop)

    def left(self):
        return sorted(path.name for path in (self.box.folder / "wanted").iterdir() if "update" in path.name)

    def test_an_update_is_uploaded_installed_and_told(self):
        status, said = self.aditd.ask("GET", "/adit/update")
        self.assertEqual((status, said["managed"], said["version"], said["slot"]), (200, True, "0.1.0", "A"))
        status, said = self.aditd.ask("POST", "/adit/update", self.bundles.make().read_bytes())
        self.assertEqual((status, said["doing"]), (200, "checking"))
        self.assertEqual(self.left(), ["update.json", "update.raucb"])
        self.assertEqual(self.aditd.ask("POST", "/adit/update", b"more")[0], 409, "one at a time")
        self.box.update()  # adit-update.path does
        said = raucs.wait_until(lambda: (now := self.aditd.ask("GET", "/adit/update")[1])["doing"] is None and now, "its end")
        self.assertEqual((said["last"]["stage"], said["last"]["version"], said["refusal"]), ("installed", "0.2.0", None))
        self.assertEqual(self.left(), [])
        self.assertEqual(self.box.boot_loader()["BOOT_ORDER"], "B A")
        self.assertEqual(self.aditd.ask("POST", "/adit/update/restart", "{}", "application/json")[1]["doing"], "restarting")
        self.box.update()
        self.assertEqual(self.box.calls.read_text(), "reboot\n")

    def test_a_large_one_takes_no_memory_and_a_broken_off_one_leaves_nothing(self):
        before = self.aditd.resident()
        status, _ = self.aditd.ask("POST", "/adit/update", HEAD + os.urandom(60 << 20))
        self.assertEqual(status, 200)
        self.assertLess(self.aditd.resident() - before, 8, "MiB")
        self.box.update()
        raucs.wait_until(lambda: self.aditd.ask("GET", "/adit/update")[1]["doing"] is None, "its end")
        connection = http.client.HTTPConnection("127.0.0.1", self.aditd.port)
        connection.putrequest("POST", "/adit/update")
        for name, value in (("Authorization", f"Bearer {TOKEN}"), ("Content-Type", "application/octet-stream"),
                            ("Content-Length", "1000000")):
            connection.putheader(name, value)
        connection.endheaders(HEAD + bytes(1000))
        raucs.wait_until(lambda: self.left() == ["update.raucb.part"], "its beginning")
        connection.close()
        raucs.wait_until(lambda: self.left() == [], "nothing of it to be left")
