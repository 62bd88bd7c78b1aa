"""adit-panel with a simulated panel, and its client: aditd, or a client of the test."""

import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import patience

NOWHERE = {"address": "127.0.0.1", "port": 9}
DARK = "0000"
PATIENCE = patience.patient(30.0)  # seconds for what takes much less on a machine that does nothing else
adit_panel, aditd = sys.argv[1:]


class Running(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-panel-")))
        self.socket, self.shown, self.log = (self.folder / name for name in ("socket", "lights", "log"))
        self.button = self.folder / "lights.button"

    def begin(self, *command):
        with self.log.open("ab") as log:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def begin_panel(self, *more):
        panel = self.begin(adit_panel, "--socket", self.socket, "--simulated", self.shown, *more)
        self.wait_until(lambda: panel.poll() is not None or self.connects(), "adit-panel to listen")
        return panel

    def connects(self):
        """Without a message; it listens once its socket exists."""
        listening = pathlib.Path("/proc/net/unix").read_text()
        return f" 00010000 0005 01 " in "".join(line for line in listening.splitlines() if line.endswith(str(self.socket)))

    def wait_until(self, condition, what, within=30.0):
        """As patience.wait_until; returns the time that it took."""
        began = time.monotonic()
        try:
            patience.wait_until(condition, what, within)
        except AssertionError as error:
            self.fail(f"{error}:\n{self.output()}")
        return time.monotonic() - began

    def output(self):
        return self.log.read_text(errors="replace")

    def lit(self):
        try:
            return "".join("1" if line.endswith(" on") else "0" for line in self.shown.read_text().splitlines())
        except FileNotFoundError:
            return ""

    def shows(self, lit):
        return self.wait_until(lambda: self.lit() == lit, f"the lights to be {lit}")

    def shows_fault(self):
        """Waits until health blinks twice with all others dark. Returns the time until the first."""
        took = self.wait_until(lambda: self.lit() in (DARK, "1000"), "the fault to begin")
        for lit in ("1000", DARK, "1000"):
            self.shows(lit)
        return took

    def connect(self, *told):
        client = self.enterContext(socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET))
        client.settimeout(PATIENCE)
        self.wait_until(lambda: self.has_room_for(client), "adit-panel to take one more")
        for message in ("panel " + json.dumps({"name": "s", "title": "S", "panel": {}}), *told):
            client.send(message.encode())
        return client

    def has_room_for(self, client):
        try:
            client.connect(str(self.socket))
        except BlockingIOError:  # so many wait to be taken
            return False
        return True

    def press(self, word):
        self.wait_until(self.button.exists, "the button")
        file = os.open(self.button, os.O_WRONLY | os.O_NONBLOCK)
        os.write(file, f"{word}\n".encode())
        os.close(file)

    def begin_aditd(self, port=0, post=NOWHERE):
        (self.folder / "secrets").mkdir(mode=0o700, exist_ok=True)
        settings = self.folder / "settings.json"
        settings.write_text(json.dumps({"version": 1, "command_post": {"scoring": post, "mapping": post},
                                        "team": {"listen": [{"address": "127.0.0.1", "port": port}]}}))
        return self.begin(aditd, "--settings", settings, "--secrets", self.folder / "secrets", "--state", self.folder / "state",
                          "--panel", self.socket)

    def is_at_work(self):
        """Health is steady while scoring blinks, because its Command Post does not answer. In a fault health is dark."""
        return self.wait_until(lambda: self.lit()[1:2] == "1", "the lights to be those of an aditd that is well")
