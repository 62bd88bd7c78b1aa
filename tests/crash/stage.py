"""One Command Post (adit-rehearsal), one box (aditd) and one client on this host, and what each says became of a
report."""

import contextlib
import http.client
import json
import os
import pathlib
import shutil
import signal
import socket
import sqlite3
import subprocess
import tempfile
import time

BIN = pathlib.Path(os.environ["ADIT_BIN"])
FAULT_POINTS = pathlib.Path(os.environ["ADIT_FAULT_POINTS"])
PORT = 8000
TOKEN = "token-of-the-team"
REPORT = {"x": 101.5, "y": -24.25, "z": -1.125, "type": "Backpack"}
DONE = {"answered", "settled"}


def wait_until(condition, what, within=60.0):
    """The first true value of `condition()`; an error that says `what` after `within` seconds."""
    end = time.monotonic() + within
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.01)
    raise AssertionError(f"waited {within:g} s in vain for {what}")


class CommandPost:
    def __init__(self, folder):
        command = [BIN / "adit-rehearsal", "--secrets", folder / "secrets", "--rate", "0"]
        for port in ("scoring", "mapping", "control"):
            command += [f"--{port}", "127.0.0.1:0"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        words = self.process.stdout.readline().split()  # adit-rehearsal: scoring A:P mapping A:P control A:P
        self.ports = {name: int(where.rpartition(":")[2]) for name, where in zip(words[1::2], words[2::2])}

    def recorded(self):
        """The reports that it recorded, each with its coordinates and its type."""
        _, body = request("127.0.0.1", self.ports["control"], "GET", "/record")
        return [{key: report[key] for key in REPORT} for report in json.loads(body)["reports"]]

    def stop(self):
        self.process.kill()
        self.process.communicate()


class Box:
    """aditd; killed at a point of a report's life where `faults` says so."""

    def __init__(self, address, folder, post):
        self.address, self.folder, self.scoring = address, folder, post.ports["scoring"]
        self.state, self.trace, self.process = folder / "state", folder / "trace", None
        self.state.mkdir()
        (folder / "settings.json").write_text(json.dumps(settings(address, post.ports)))

    def start(self, **faults):
        """Until it serves and knows the run. False: it was killed before that."""
        self.stop()
        environment = dict(os.environ)
        if faults:
            environment |= {"LD_PRELOAD": str(FAULT_POINTS), "FAULT_FOLDER": str(self.state),
                            "FAULT_SCORING": str(self.scoring), "FAULT_TEAM": str(PORT), "FAULT_TRACE": str(self.trace)}
            environment |= {f"FAULT_{name.upper()}": str(value) for name, value in faults.items()}
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen(
                [BIN / "aditd", "--settings", self.folder / "settings.json", "--secrets", self.folder / "secrets",
                 "--state", self.state], stdout=log, stderr=log, env=environment)
        wait_until(lambda: self.ended() or self.knows_the_run(), "aditd to know the run")
        if self.ended() and self.process.returncode != -signal.SIGKILL:
            raise AssertionError(f"aditd ended with {self.process.returncode}: {self.said()}")
        return not self.ended()

    def knows_the_run(self):
        try:
            return request(self.address, PORT, "GET", "/api/status")[0] == 200
        except (OSError, http.client.HTTPException):
            return False

    def ended(self):
        return self.process.poll() is not None

    def stop(self, how=signal.SIGTERM):
        if self.process is not None and not self.ended():
            self.process.send_signal(how)
        if self.process is not None:
            self.process.wait(60)

    def said(self):
        return (self.folder / "log").read_text(errors="replace")[-2000:]

    def points(self):
        """The calls that were points: "pwrite64 ledger.sqlite-wal 4096@32"..., and how it was killed and torn."""
        lines = self.trace.read_text().splitlines() if self.trace.exists() else []
        return [line.split(" ", 1)[1] for line in lines]

    def states(self):
        """The states of all reports on disk, oldest first. Read from a copy, and again where that was torn."""
        for _ in range(20):
            with tempfile.TemporaryDirectory(dir=self.folder) as copy, contextlib.suppress(sqlite3.Error, OSError):
                for file in self.state.glob("ledger.sqlite*"):
                    shutil.copy(file, copy)
                with contextlib.closing(sqlite3.connect(f"{copy}/ledger.sqlite")) as ledger:
                    return [state for state, in ledger.execute("SELECT state FROM report ORDER BY number")]
            time.sleep(0.02)
        raise AssertionError("the ledger cannot be read")


def settings(address, ports):
    """Fast rates and a quick end of doubts, so that a thousand lives take minutes."""
    return {
        "version": 1,
        "command_post": {
            "scoring": {"address": "127.0.0.1", "port": ports["scoring"]},
            "mapping": {"address": "127.0.0.1", "port": ports["mapping"]},
            "rates": {f"{kind}_hz": 200 for kind in ("reports", "status", "map", "state", "markers")},
        },
        "team": {"listen": [{"address": address, "port": PORT}]},
        "reports": {"doubt_for_ms": 200, "doubt_asks": 2},
    }


def request(address, port, method, path, body=b"", within=30.0):
    """One request on a connection of its own, sent at once; its status and body."""
    with socket.create_connection((address, port), within) as connection:
        head = [f"{method} {path} HTTP/1.1", f"Host: {address}", f"Authorization: Bearer {TOKEN}",
                "Content-Type: application/json", f"Content-Length: {len(body)}", "Connection: close"]
        connection.sendall("\r\n".join([*head, "", ""]).encode() + body)
        answer = http.client.HTTPResponse(connection, method=method)
        answer.begin()
        return answer.status, answer.read()


class Stage:
    """All three in a folder of their own. `address`: one of 127.0.0.0/8 for the team's side."""

    def __init__(self, address):
        self.temporary = tempfile.TemporaryDirectory(prefix="adit-crash-")
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "secrets").mkdir(mode=0o700)
        for name in ("scoring", "mapping"):
            path = self.folder / "secrets" / f"{name}.token"
            path.touch(0o600)
            path.write_text(TOKEN + "\n")
        self.post = CommandPost(self.folder)
        self.box = Box(address, self.folder, self.post)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.box.stop(signal.SIGKILL)
        self.post.stop()
        self.temporary.cleanup()

    def submit(self):
        """The client posts its report: the status of its answer, or 0 where none came."""
        try:
            status, body = request(self.box.address, PORT, "POST", "/api/artifact_reports", json.dumps(REPORT).encode())
        except (OSError, http.client.HTTPException):
            return 0
        if status == 201:
            answer = json.loads(body)
            assert {key: answer[key] for key in REPORT} == REPORT, answer
        return status

    def submit_until_taken(self, within=60.0):
        """As real clients do: again, until it is answered 201. The box is started again when it has died."""
        def taken():
            if self.box.ended():
                self.box.start()
            return self.submit() == 201
        wait_until(taken, "a 201", within)
