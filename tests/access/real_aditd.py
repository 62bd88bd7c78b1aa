"""The log-in of the real program: real_aditd.py ADITD. On loopback, without a Command Post."""

import contextlib
import http.client
import json
import os
import pathlib
import re
import signal
import stat
import subprocess
import sys
import tempfile
import unittest

import patience
from patience import patient  # noqa: E402

TOKENS = {"scoring": "scoring-token-1", "mapping": "mapping-token-1", "team": "team-token-1"}
OPERATOR, VIEWER = "correct horse battery", "look, do not touch"
NOWHERE = {"address": "127.0.0.1", "port": 9}
aditd = sys.argv[1]


def wait_until(condition, what, within=30.0):
    """As patience.wait_until, also while aditd restarts."""
    return patience.wait_until(condition, what, within, OSError)


class Box:
    """aditd with its own directories, which outlive a restart."""

    def __init__(self, folder, label=None, require_token=True):
        self.folder = pathlib.Path(folder)
        self.state, self.log = self.folder / "state", self.folder / "log"
        secrets = self.folder / "secrets"
        secrets.mkdir(mode=0o700)
        for name, text in {**{f"{name}.token": token for name, token in TOKENS.items()}, "label.code": label}.items():
            if text is not None:
                (secrets / name).write_text(text + "\n")
                (secrets / name).chmod(0o600)
        (self.folder / "settings.json").write_text(json.dumps({
            "version": 1,
            "command_post": {"scoring": NOWHERE, "mapping": NOWHERE},
            "team": {"listen": [{"address": "127.0.0.1", "port": 0}], "require_token": require_token}}))
        self.start()

    def start(self):
        with open(self.log, "ab") as log:
            begun = log.tell()
            self.process = subprocess.Popen([aditd, "--settings", self.folder / "settings.json", "--secrets",
                                             self.folder / "secrets", "--state", self.state],
                                            stdout=log, stderr=log)
        try:
            found = wait_until(lambda: re.search(r"listening .*port=(\d+)", self.output()[begun:]), "aditd to listen")
        except AssertionError as error:
            raise AssertionError(f"{error}:\n{self.output()}") from None
        self.port = int(found.group(1))

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(patient(30))

    def output(self):
        return self.log.read_text()

    def code(self):
        return (self.state / "first-start.code").read_text().strip()

    def ask(self, request, body=None, whence="127.0.0.1", **headers):
        """ask("GET /adit/run", Cookie="adit=..."): status, JSON, headers. `_` in a header's name stands for `-`."""
        method, _, path = request.partition(" ")
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=patient(30), source_address=(whence, 0))
        with contextlib.closing(connection):
            sent = {"Content-Type": "application/json"} if body is not None else {}
            sent.update({name.replace("_", "-"): value for name, value in headers.items()})
            connection.request(method, path, None if body is None else json.dumps(body), sent)
            answer = connection.getresponse()
            text = answer.read()
            is_json = answer.headers["Content-Type"] == "application/json"
            return answer.status, json.loads(text) if is_json else text, answer.headers

    def set_first(self, code=None, password=OPERATOR):
        return self.ask("POST /adit/password", {"role": "operator", "code": code or self.code(), "password": password})

    def log_in(self, password=OPERATOR):
        """Logs in and returns the headers that a browser then sends."""
        status, said, headers = self.ask("POST /adit/login", {"password": password})
        assert status == 200, (status, said)
        return {"Cookie": headers["Set-Cookie"].partition(";")[0], "Adit_CSRF": said["csrf"]}


class Login(unittest.TestCase):
    def box(self, first=True, **options):
        folder = tempfile.TemporaryDirectory(prefix="adit-login-")
        self.addCleanup(folder.cleanup)
        box = Box(folder.name, **options)
        self.addCleanup(lambda: box.process.wait())
        self.addCleanup(lambda: box.process.kill())
        if first:
            self.assertEqual(box.set_first()[0], 200)
        return box

    def test_first_start_requires_the_code_on_the_console(self):
        box = self.box(first=False)
        self.assertEqual(box.ask("GET /adit/session")[1], {"role": None, "csrf": None, "first_start": True,
                                                             "set_up_open": False, "secure": False, "https": False})
        self.assertRegex(box.code(), r"^\d{8}$")
        self.assertIn(f"code={box.code()}", box.output())
        self.assertEqual(stat.S_IMODE((box.state / "first-start.code").stat().st_mode), 0o600)
        wrong = "00000000" if box.code() != "00000000" else "11111111"
        self.assertEqual(box.set_first(code=wrong)[0], 403)
        code = box.code()
        box.stop()
        box.start()
        self.assertEqual(box.code(), code, "the same after a restart")
        self.assertEqual(box.set_first()[0], 200)
        self.assertFalse((box.state / "first-start.code").exists())
        self.assertEqual(box.set_first(code=code)[0], 401, "it has done its service")
        before = len(box.output())
        box.stop()
        box.start()
        self.assertNotIn("code=", box.output()[before:])
        self.assertEqual(box.ask("GET /adit/session")[1]["first_start"], False)
        self.assertEqual(box.ask("GET /adit/run", **box.log_in())[0], 200)

    def test_fifo_in_place_of_a_file_does_not_block_the_start(self):
        box = self.box(first=False)
        box.stop()
        for name in ("settings.json", "settings.json.before", "secrets/team.token", "access.json", "devices.json",
                     "sessions.json", "first-start.code", "acknowledged.json", "spare.json", "take-over", "stamps",
                     "ledger", "ledger/log-00000009.0123456789abcdef", "ledger/snapshot-00000009.0123456789abcdef.part",
                     "journal/journal-00000001", "journal/snapshot-00000001.part", "waiting/map-00000001.cbor",
                     "rejected/1.json", "runs/1/facts.json", "runs/1/map-00000001"):
            with self.subTest(name):
                file, elsewhere = box.state / name, box.state / "elsewhere"
                file.parent.mkdir(parents=True, exist_ok=True)
                if file.exists():
                    file.rename(elsewhere)
                os.mkfifo(file)
                box.start()
                self.assertEqual(box.ask("GET /adit/session")[0], 200)
                box.stop()
                file.unlink(missing_ok=True)
                if elsewhere.exists():
                    elsewhere.rename(file)

    def test_code_of_the_label_is_not_printed(self):
        box = self.box(first=False, label="31415926")
        self.assertFalse((box.state / "first-start.code").exists())
        self.assertNotIn("31415926", box.output())
        self.assertEqual(box.set_first(code="31415926")[0], 200)

    def test_passwords_are_hashed_private_and_not_logged(self):
        box = self.box()
        by_operator = box.log_in()
        box.ask("POST /adit/login", {"password": "an untrue password"})
        status, said, _ = box.ask("POST /adit/password", {"role": "viewer", "current": OPERATOR, "password": VIEWER},
                                  **by_operator)
        self.assertEqual((status, said), (200, {"role": "viewer"}))
        file = box.state / "access.json"
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        kept = json.loads(file.read_text().rpartition("crc32 ")[0])
        self.assertEqual(kept["version"], 1)
        for role in ("operator", "viewer"):
            self.assertTrue(kept[role].startswith("$y$j9T$"), role)
        secret = by_operator["Cookie"].partition("=")[2]
        for text in (OPERATOR, VIEWER, "an untrue password", secret, by_operator["Adit_CSRF"], "$y$"):
            self.assertNotIn(text, box.output())
        self.assertIn("login rejected: wrong password", box.output())
        self.assertEqual(box.ask("POST /adit/password", {"role": "viewer", "current": OPERATOR, "password": OPERATOR},
                                 **by_operator)[0], 422, "one password for two roles")
