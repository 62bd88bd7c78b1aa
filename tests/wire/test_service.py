"""aditd's interface to systemd: readiness, watchdog, status, failed starts, stop. On loopback."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import programs

NOBODY = {"address": "127.0.0.1", "port": 9}  # discard: nobody listens there


class Service(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-service-")))
        (self.folder / "state").mkdir()
        programs.secrets_folder(self.folder / "secrets")
        self.write_settings()
        self.notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.notify.close)
        self.notify.bind(str(self.folder / "notify"))
        self.notify.settimeout(30)

    def write_settings(self, **changes):
        document = {"version": 1, "command_post": {"scoring": NOBODY, "mapping": NOBODY},
                    "team": {"listen": [{"address": "127.0.0.1", "port": 0}]}, **changes}
        (self.folder / "settings.json").write_text(json.dumps(document))

    def start(self, **environment):
        process = subprocess.Popen(
            [programs.BIN / "aditd", "--settings", self.folder / "settings.json", "--secrets", self.folder / "secrets",
             "--state", self.folder / "state"], stderr=subprocess.PIPE, text=True,
            env={**os.environ, "NOTIFY_SOCKET": str(self.folder / "notify"), **environment})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def heard(self, word):
        """Waits for a notification that contains `word`."""
        while True:
            said = self.notify.recv(4096).decode()
            if word in said:
                return said

    def refuses(self, *words):
        process = self.start()
        _, said = process.communicate(timeout=programs.patient(30))
        self.assertEqual(process.returncode, 1, said)
        for word in words:
            self.assertIn(word, said)

    def test_notifies_systemd_of_start_state_and_stop(self):
        process = self.start()
        self.assertIn("STATUS=", self.heard("READY=1"))
        process.send_signal(signal.SIGTERM)
        self.heard("STOPPING=1")
        self.assertEqual(process.wait(programs.STOPS_WITHIN), 0)

    def test_feeds_the_watchdog_only_while_its_loop_turns(self):
        process = self.start(WATCHDOG_USEC="400000")
        self.heard("READY=1")
        for _ in range(3):
            self.heard("WATCHDOG=1")
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.1)
        self.notify.settimeout(0.01)
        with self.assertRaises(TimeoutError):
            while True:
                self.notify.recv(4096)
        self.notify.settimeout(0.8)
        with self.assertRaises(TimeoutError):
            self.heard("WATCHDOG=1")
        process.send_signal(signal.SIGCONT)
        self.notify.settimeout(30)
        self.heard("WATCHDOG=1")

    def test_names_every_fault_of_its_settings(self):
        self.write_settings(comand_post={}, team={"listen": [{"address": "nowhere", "port": 70000}]})
        self.refuses("comand_post", "team.listen[0].address", "team.listen[0].port")

    def test_starts_without_a_token_and_names_it(self):
        (self.folder / "secrets" / "scoring.token").unlink()
        self.start()
        self.assertIn("The scoring token is missing", self.heard("READY=1"))

    def test_replaces_a_damaged_ledger_and_shows_it(self):
        ledger = self.folder / "state" / "ledger"
        ledger.mkdir()
        (ledger / "log-00000001.0123456789abcdef").write_bytes(b"no ledger at all" * 100)
        self.start()
        self.assertIn("Reports are possibly missing: new reports are held until you Settle report 1000", self.heard("READY=1"))
        self.assertEqual([each.name for each in (ledger / "damaged-1").iterdir()], ["log-00000001.0123456789abcdef"])
