"""adit-panel, which drives lights and button and watches aditd: real_panel.py ADIT_PANEL ADITD. The panel is simulated."""

import contextlib
import signal
import socket
import subprocess
import sys
import time

import running
from running import DARK, PATIENCE, Running


class Watching(Running):
    """With a client of the test's own."""

    def setUp(self):
        super().setUp()
        self.panel = self.begin_panel()

    def test_last_connection_counts(self):
        first = self.connect("lit 1000")
        self.shows("1000")
        self.connect("lit 0100")
        self.shows("0100")
        self.assertEqual(first.recv(64), b"", "the first is let go of")

    def test_hostile_bytes_end_only_their_connection(self):
        for message in (b"\xff\x00\xfe", b"lit 9999", b"lit", b"panel {", b"panel " + b"[" * 1000, b"x" * 100000, b"end\n", b"lit 1111\0",
                        b'panel {"name":"s","title":"S","panel":{"chip":"../../etc","health":"\\u0000"}}'):
            client = self.connect("lit 1110")
            self.shows("1110")
            client.send(message)
            self.assertEqual(client.recv(64), b"", message)
            self.shows_fault()
        for _ in range(200):
            self.connect()
        self.connect("lit 0110")
        self.shows("0110")
        self.assertIsNone(self.panel.poll())
        self.assertLessEqual(self.output().count("unknown message from aditd"), 9, "once for each that had told something before")

    def test_flood_blocks_neither_lights_nor_the_next_connection(self):
        """Frames faster than the lights can follow, and then silence."""
        client = self.connect()
        for each in range(20000):
            client.send(b"lit 1010" if each % 2 else b"lit 0101")
        self.shows_fault()
        self.connect("lit 1100")
        self.shows("1100")

    def test_button_is_reported(self):
        client = self.connect("lit 1110")
        self.shows("1110")
        for word, told in (("press", b"button 1"), ("release", b"button 0")) * 2:
            self.press(word)
            self.assertEqual(client.recv(64), told)

    def test_unavailable_lines_are_reported_and_simulated(self):
        client = self.connect("lit 1110")
        self.shows("1110")
        client.send(b'panel {"name":"s","title":"S","panel":{"chip":"no-such-chip","health":"H","button":"B"}}')
        self.wait_until(lambda: "cannot set the lights, retrying: panel: chip no-such-chip: No such file" in self.output(), "to be told")
        self.wait_until(lambda: "cannot read the button, retrying: panel: chip no-such-chip" in self.output(), "to be told of the button")
        client.send(b"lit 0110")
        self.shows("0110")
        self.assertFalse(self.button.exists(), "no other takes a real one's place")


class Starting(Running):
    def test_board_takes_precedence_over_a_message(self):
        board = self.folder / "board.json"
        board.write_text('{"name": "b", "title": "B", "panel": {"chip": "no-such-chip", "health": "H"}}')
        self.begin_panel("--board", board)
        self.wait_until(lambda: "no-such-chip" in self.output(), "the board's chip to be looked for")
        client = self.enterContext(socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET))
        client.connect(str(self.socket))
        client.send(b'panel {"name":"s","title":"S","panel":{"chip":"another-chip","health":"H"}}')
        client.send(b"lit 1000")
        self.shows("1000")
        self.assertNotIn("another-chip", self.output())

    def test_invalid_board_is_reported(self):
        board = self.folder / "board.json"
        board.write_text('{"name": "b", "title": "B", "panle": {}}')
        self.begin_panel("--board", board)
        self.wait_until(lambda: "board.json: panle: no such key; did you mean panel?" in self.output(), "the key to be told")

    def test_failed_start_is_explained(self):
        for words, code, why in (((), 1, "--socket is missing"), (("--socket", "/nowhere/socket"), 1, "/nowhere/socket: No such file"),
                                 (("--socket", "/" + "x" * 200), 1, "File name too long"), (("fault",), 2, "unknown word 'fault'")):
            done = subprocess.run([running.adit_panel, *words], capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(done.returncode, code)
            self.assertIn(why, done.stderr)


class WithAditd(Running):
    """Processes are killed, stopped, hung, or started in another order."""

    def test_panel_starts_first(self):
        self.begin_panel()
        self.begin_aditd()
        self.is_at_work()

    def test_aditd_starts_first(self):
        self.begin_aditd()
        self.wait_until(lambda: "listening address" in self.output(), "aditd to start")
        self.begin_panel()
        self.is_at_work()

    def test_a_hang_is_shown_within_two_seconds(self):
        self.begin_panel()
        hung = self.begin_aditd()
        figures = []
        for _ in range(3):
            self.is_at_work()
            hung.send_signal(signal.SIGSTOP)
            began = time.monotonic()
            self.wait_until(lambda: self.lit() in (DARK, "1000"), "the fault to begin")
            figures.append(time.monotonic() - began)
            self.shows_fault()
            hung.send_signal(signal.SIGCONT)
        self.is_at_work()
        print(f"\nadit-panel: from SIGSTOP of aditd to the fault: {', '.join(f'{each:.2f}' for each in figures)} s", file=sys.stderr)

    def test_a_kill_is_shown_until_the_next_start(self):
        self.begin_panel()
        self.begin_aditd().kill()
        killed = self.begin_aditd()
        self.is_at_work()
        killed.kill()
        self.shows_fault()
        self.begin_aditd()
        self.is_at_work()

    def test_panel_that_ends_or_hangs_does_not_affect_aditd(self):
        panel = self.begin_panel()
        served = self.begin_aditd()
        for how in (signal.SIGKILL, signal.SIGTERM, signal.SIGSTOP):
            self.is_at_work()
            panel.send_signal(how)
            if how != signal.SIGSTOP:
                panel.wait(PATIENCE)
                self.shown.unlink(missing_ok=True)
                panel = self.begin_panel()
            else:
                time.sleep(1.0)  # beats that nobody hears
                panel.send_signal(signal.SIGCONT)
        self.is_at_work()
        self.assertIsNone(served.poll())

    @contextlib.contextmanager
    def broken(self):
        """The simulated panel cannot be written, because a directory has its file's name."""
        obstacle = self.shown.with_name(self.shown.name + ".new")

        def is_made():
            with contextlib.suppress(FileExistsError):  # adit-panel is writing the file
                obstacle.mkdir()
            return obstacle.is_dir()

        self.wait_until(is_made, "adit-panel to have written its file")
        yield
        obstacle.rmdir()

    def test_failed_lights_are_reported_to_aditd_and_retried(self):
        self.begin_panel()
        self.begin_aditd()
        self.is_at_work()
        with self.broken():
            self.wait_until(lambda: "cannot set the panel lights" in self.output(), "aditd to say so")
        self.is_at_work()
        self.wait_until(lambda: "panel lights work again" in self.output(), "aditd to say so")

    def test_a_press_reaches_aditd_through_any_panel(self):
        self.begin_aditd()
        for _ in range(2):
            panel = self.begin_panel()
            self.is_at_work()
            before = self.output().count("the button was pressed")
            for word in ("press", "release"):
                self.press(word)
                time.sleep(0.2)  # somebody's finger
            self.wait_until(lambda: self.output().count("the button was pressed") > before, "aditd to be told")
            panel.kill()
            panel.wait(PATIENCE)
