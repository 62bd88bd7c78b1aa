"""adit-rehearsal demo for a newcomer: in a small window, in a pipe, two at once, at a port, with a wrong option. No process of it
survives its end."""
import fcntl
import os
import pty
import re
import shlex
import signal
import socket
import struct
import subprocess
import tempfile
import termios
import unittest
import urllib.request
from pathlib import Path

from patience import patient, wait_until

DEMO = Path(__file__).resolve().parents[2] / "firmware/programs/rehearsal/demo/demo"
SIZE = struct.Struct("4H")  # winsize: rows, columns, and pixels that nobody counts
HOME, BELOW = b"\x1b[H", b"\x1b[J"
TO_THE_END = re.compile(r"\x1b\[K")


def like_a_terminals_shell():
    """For the child: makes Ctrl-C work, also if this test runs in the background of a script, where SIGINT is ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class Window:
    """A terminal with that many rows and columns, in which the demo runs."""

    def __init__(self, rows, columns, *words):
        self.screen, end = pty.openpty()
        self.said = b""
        self.resize(rows, columns)
        os.set_blocking(self.screen, False)
        self.process = subprocess.Popen([DEMO, *words], stdin=end, stdout=end, stderr=end, start_new_session=True,
                                        preexec_fn=like_a_terminals_shell)
        os.close(end)

    def resize(self, rows, columns):
        self.rows, self.columns = rows, columns
        fcntl.ioctl(self.screen, termios.TIOCSWINSZ, SIZE.pack(rows, columns, 0, 0))

    def read(self):
        try:
            while more := os.read(self.screen, 65536):
                self.said += more
        except (BlockingIOError, OSError):  # nothing more now, or ever
            pass
        return self.said

    def next_frame(self):
        """The lines of the next complete picture."""
        self.read()
        self.said = b""

        def drawn():
            whole = [frame for frame in self.read().split(HOME)[1:] if BELOW in frame]
            return [TO_THE_END.sub("", line.decode()) for line in whole[-1].replace(BELOW, b"").split(b"\r\n")] if whole else None

        return wait_until(drawn, "a picture")

    def rows_of(self, frame):
        return sum(max(1, -(-len(line) // self.columns)) for line in frame)


class Demo(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-demo-")), "demo")

    def window(self, rows, columns, *words):
        window = Window(rows, columns, "--directory", self.folder, *words)
        self.addCleanup(self.end, window.process)
        return window

    def end(self, process):
        if process.poll() is None:
            process.terminate()
            process.wait(patient(60))

    def nothing_runs(self):
        """Every program of a demo holds a lock in its directory."""
        with open(self.folder / "of-a-demo", "ab") as held:
            try:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return False
        return True

    def refused(self, *words, folder=None, code=1):
        """The first line of the error."""
        done = subprocess.run([DEMO, "--directory", folder or self.folder, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=patient(120), check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr.splitlines()[0]

    def test_small_window_shows_the_page_and_its_password(self):
        window = self.window(24, 80)
        for rows, columns in (24, 80), (16, 50):
            window.resize(rows, columns)
            wait_until(lambda: window.rows_of(window.next_frame()) < rows, f"a picture of {rows} rows")
            frame = wait_until(lambda: [line for line in window.next_frame() if line.startswith("Run ")] and window.next_frame(), "the summary")
            self.assertLess(window.rows_of(frame), rows, frame)
            self.assertRegex("\n".join(frame), r"^The page:     http://127\.0\.0\.1:80\d\d/\nIts password: rehearsal-\w+\n")
        self.assertIn(f"another demo runs in {self.folder}", self.refused())
        self.assertIsNone(window.process.poll(), "and the one that runs is not upset")
        os.write(window.screen, b"\x03")  # Ctrl-C
        wait_until(lambda: (window.read(), window.process.poll() is not None)[1], "its end")
        self.assertEqual(window.process.returncode, 0)
        self.assertIn(f"Kept in {self.folder}", window.read().decode().replace("\r\n", "\n"))
        self.assertTrue(self.nothing_runs())

    def test_it_ends_with_its_window(self):
        window = self.window(24, 80)
        window.next_frame()
        os.close(window.screen)
        window.process.wait(patient(60))
        self.assertTrue(self.nothing_runs())

    def test_it_ends_with_its_pipe(self):
        process = subprocess.Popen([DEMO, "--directory", self.folder], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        for line in process.stdout:
            self.assertNotIn("\x1b", line)
            if line.startswith("Reports "):
                break
        process.stdout.close()
        process.wait(patient(60))
        self.assertTrue(self.nothing_runs())

    def test_stop_during_start_leaves_no_process(self):
        window = self.window(24, 80)
        wait_until((self.folder / "adit-rehearsal.log").exists, "its first program")
        window.process.send_signal(signal.SIGINT)
        wait_until(lambda: (window.read(), window.process.poll() is not None)[1], "its end")
        self.assertTrue(self.nothing_runs())

    def test_sigterm_ends_it_in_the_background(self):
        command = f"{shlex.join([str(DEMO), '--directory', str(self.folder)])} & echo $!; wait"  # bash: it ignores SIGINT
        script = subprocess.Popen(["bash", "-c", command], stdout=subprocess.PIPE, text=True)
        self.addCleanup(script.stdout.close)
        self.addCleanup(self.end, script)
        demo = int(script.stdout.readline())
        next(line for line in script.stdout if line.startswith("Reports "))
        os.kill(demo, signal.SIGTERM)
        script.wait(patient(60))
        self.assertIn("Kept in", script.stdout.read())
        self.assertTrue(self.nothing_runs())

    def test_page_is_at_the_given_address_and_port(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            self.assertEqual(self.refused("--port", str(port)), f"adit-rehearsal demo: port {port} is in use: name another by --port")
            self.assertFalse(self.folder.exists())
        process = subprocess.Popen([DEMO, "--directory", self.folder, "--listen", "127.0.0.2", "--port", str(port)], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(self.end, process)
        self.assertEqual(next(line for line in process.stdout if line.strip()), f"The page:     http://127.0.0.2:{port}/\n")
        with urllib.request.urlopen(f"http://127.0.0.2:{port}/", timeout=patient(10)) as page:
            self.assertEqual(page.status, 200)

    def test_wrong_options_are_named_before_anything_starts(self):
        for words, why in ((("--for", "soon"), "--for wants whole seconds, not 'soon'"), (("--for",), "--for wants a value"),
                           (("--for", "--port"), "--for wants a value"), (("--fast",), "unknown word '--fast'"),
                           (("fast",), "unknown word 'fast'"), (("--port", "80"), "--port wants a number from 1024 to 65535, not '80'"),
                           (("--robots", "many"), "--robots: expected 0 to 50, got 'many'"), (("--robots", "0"), "--robots 0: needs --maps"),
                           (("--style", "morse"), "--style: unknown style 'morse'"),
                           (("--maps", "/nowhere"), "--maps: /nowhere: No such file or directory"),
                           (("--fault-rate", "x"), "--fault-rate: expected a rate from 0 to 1 at the end, as in reports:record-then-drop=0.1, got 'x'"),
                           (("--listen", "here"), '--listen: expected an IPv4 or IPv6 address, got "here"'),
                           (("--listen", "203.0.113.7"), "--listen: this machine does not have the address 203.0.113.7")):
            with self.subTest(words):
                self.assertEqual(self.refused(*words, code=2), f"adit-rehearsal demo: {why}")
                self.assertFalse(self.folder.exists())

    def test_wrong_directory_is_named(self):
        self.assertIn("/proc/demo cannot be written to: name another directory by --directory", self.refused(folder="/proc/demo"))
        self.assertIn("is there, and not a demo's", self.refused(folder=self.folder.parent))
