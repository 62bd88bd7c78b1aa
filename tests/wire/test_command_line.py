"""`adit` with a real aditd and a real Command Post: at a terminal, in a pipe, and in scripts. Single commands: tests/cli."""

import contextlib
import fcntl
import json
import os
import pty
import select
import signal
import subprocess
import termios
import time
import unittest

import programs
from programs import BIN, Stage, wait_until
from reporting import QUICK, REPORT, another, began, is_taken, sendings, submit

UTF8 = {**os.environ, "LC_ALL": "C.UTF-8", "TERM": "xterm"}
UTF8.pop("NO_COLOR", None)


def words(stage, *said):
    return [BIN / "adit", *said, "--at", f"{stage.network.box_address}:{programs.PORT}",
            "--token-file", stage.folder / "secrets" / "team.token"]


def adit(stage, *said):
    """Runs `adit` without a terminal, so that it cannot ask."""
    return subprocess.run(words(stage, *said), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, env=UTF8)


class Terminal:
    """`adit` at its own terminal, and its output there."""

    def __init__(self, stage, *said, env=UTF8):
        self.ours, theirs = pty.openpty()
        self.before = termios.tcgetattr(theirs)
        self.process = subprocess.Popen(words(stage, *said), stdin=theirs, stdout=theirs, stderr=theirs, env=env,
                                        start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        self.theirs, self.seen = theirs, ""

    def look(self):
        while select.select([self.ours], [], [], 0.01)[0]:
            self.seen += os.read(self.ours, 65536).decode()
        return self.seen

    def shows(self, text):
        wait_until(lambda: text in self.look(), f"{text!r} on the terminal")

    def type(self, keys):
        os.write(self.ours, keys.encode())

    def end(self):
        """Its exit status, once it has ended."""
        wait_until(lambda: self.look() is not None and self.process.poll() is not None, "it to end")
        self.look()
        return self.process.returncode

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.ours)
        os.close(self.theirs)


class Case(unittest.TestCase):
    @contextlib.contextmanager
    def stage(self, **overrides):
        with Stage(**{**QUICK, **overrides}) as stage:
            yield began(stage)

    def at_a_terminal(self, *said, **more):
        terminal = Terminal(*said, **more)
        self.addCleanup(terminal.close)
        return terminal


class InDoubt(Case):
    def in_doubt(self, stage, report=REPORT):
        """Makes a report that stays in doubt. Returns its number."""
        stage.post.will("other-sender,record-then-drop")
        number = int(submit(stage, report).headers["Adit-Report"])
        wait_until(lambda: f"report_in_doubt:{number}" in stage.box.alarms(), "the report to be in doubt")
        return number

    def test_is_resent_only_if_confirmed(self):
        with self.stage(reports__answer_within_ms=2000) as stage:
            number = self.in_doubt(stage)
            refused = adit(stage, "reports", "send", str(number))
            self.assertEqual((refused.returncode, refused.stdout), (1, ""))

            for answer in ("n\n", "\n", "maybe\n", "\x04"):
                terminal = self.at_a_terminal(stage, "reports", "send", str(number))
                terminal.shows("Send it again? [y/N] ")
                terminal.type(answer)
                self.assertEqual(terminal.end(), 1, answer)
            self.assertEqual(sendings(stage), 1, "all that was asked and refused sent nothing")

            terminal = self.at_a_terminal(stage, "reports", "send", str(number))
            terminal.shows("Send it again? [y/N] ")
            terminal.type("y\n")
            self.assertEqual(terminal.end(), 0)
            wait_until(lambda: sendings(stage) == 2, "it to be sent again")


class Secrets(Case):
    def test_a_signal_shows_typed_characters_again(self):
        with self.stage() as stage:
            terminal = self.at_a_terminal(stage, "tokens", "set", "scoring")
            wait_until(lambda: termios.tcgetattr(terminal.theirs) != terminal.before, "typed characters to be hidden")
            terminal.type("half a tok\x03")
            self.assertEqual(terminal.end(), -signal.SIGINT)
            self.assertEqual(termios.tcgetattr(terminal.theirs), terminal.before)
            self.assertNotIn("half", terminal.seen)


class Watching(Case):
    def test_at_a_terminal(self):
        with self.stage() as stage:
            for end in ("q", "\x03", "\x1c"):
                terminal = self.at_a_terminal(stage, "watch")
                terminal.shows("\x1b[?1049h")
                terminal.shows("reports left")
                is_taken(stage, another(ord(end)))
                terminal.shows("answered")
                self.assertNotEqual(termios.tcgetattr(terminal.theirs)[3], terminal.before[3], "keys are not shown")
                terminal.type(end)
                self.assertEqual(terminal.end(), 0, terminal.seen[-300:])
                self.assertTrue(terminal.seen.endswith("\x1b[?25h\x1b[?1049l"), "what was there before is there again")
                self.assertEqual(termios.tcgetattr(terminal.theirs), terminal.before)

    def test_in_a_pipe(self):
        with self.stage() as stage:
            said = stage.folder / "watched"
            with open(said, "wb") as output:
                watch = subprocess.Popen(words(stage, "watch"), stdin=subprocess.DEVNULL, stdout=output, stderr=output, env=UTF8)
            self.addCleanup(watch.wait)
            self.addCleanup(watch.kill)
            wait_until(lambda: "reports left" in said.read_text(), "all of it once")
            is_taken(stage, REPORT)
            wait_until(lambda: "  report 1 Backpack: answered" in said.read_text(), "a line of the report")
            stage.box.stop()
            wait_until(lambda: "cannot reach Adit" in said.read_text(), "the end of aditd to be told")
            stage.restart_box()
            wait_until(lambda: "Adit answers again\n" in said.read_text(), "its return to be told")
            self.assertNotIn("\x1b", said.read_text())
            watch.send_signal(signal.SIGTERM)
            self.assertEqual(watch.wait(programs.patient(30)), 0)

class ForScripts(Case):
    def test_everything_shown_is_also_json(self):
        with self.stage() as stage:
            is_taken(stage, REPORT)
            file = str(stage.box.settings)
            for said in (["status"], ["reports"], ["reports", "show", "1"], ["reports", "export"], ["rejected"], ["settings"],
                         ["settings", "show", "reports"], ["settings", "check", file], ["settings", "export"], ["network"],
                         ["test"], ["update"], ["identify", "1"], ["complete", "reports"], ["complete", "keys"],
                         ["complete", "rejected"], ["complete", "courses"], ["course"], ["run"], ["runs"], ["complete", "runs"],
                         ["run", "new", "--yes"]):
                with self.subTest(said):
                    json.loads(adit(stage, *said, "--json").stdout)
            checked = subprocess.run([BIN / "adit", "check", file, "--json"], capture_output=True, text=True)
            self.assertTrue(json.loads(checked.stdout)["good"])
            status = json.loads(adit(stage, "status", "--json").stdout)
            self.assertEqual(set(status), set(stage.box.ask("GET /adit/run")[1]), "what GET /adit/run says")


class Letters(Case):
    """A non-ASCII name, from a robot's message to the log and to `adit`."""

    def test_read_back_the_same(self):
        with self.stage() as stage:
            name = "Höhle-洞"
            status, _ = stage.box.ask("POST /state/update", {"Content-Type": "application/json"}, body={
                "header": {"stamp": time.time(), "frame_id": "darpa"},
                "poses": [{"name": name, "position": {"x": 1, "y": 0, "z": 0},
                           "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}]})
            self.assertEqual(status, 422)
            self.assertIn(name, adit(stage, "status").stdout)
            wait_until(lambda: name in stage.box.output(), "the log to have it")
            terminal = self.at_a_terminal(stage, "status", env={**UTF8, "LC_ALL": "C"})
            terminal.end()
            self.assertIn("H\\xc3\\xb6hle", terminal.seen, "a terminal without UTF-8 gets ASCII")
