"""adit-panel with lights that cannot be set: real_failing.py ADIT_PANEL ADITD. The panel is a simulated one, which cannot be
written while a folder stands in the way of its file."""

import contextlib
import threading
import time

from running import DARK, Running

GLITCH = 0.4  # seconds
SOON = 5.0  # seconds within which what failed is to be set again


class Failing(Running):
    def setUp(self):
        super().setUp()
        self.begin_panel()

    def well(self):
        client = self.connect("lit 1110")
        self.shows("1110")
        return client

    @contextlib.contextmanager
    def broken(self):
        obstacle = self.shown.with_name(self.shown.name + ".new")

        def is_made():
            with contextlib.suppress(FileExistsError):  # adit-panel is writing the file
                obstacle.mkdir()
            return obstacle.is_dir()

        self.wait_until(is_made, "adit-panel to have written its file")
        try:
            yield
        finally:
            obstacle.rmdir()

    @contextlib.contextmanager
    def telling(self, client, message):
        """Over and over, as aditd does."""
        over = threading.Event()

        def tell():
            while not over.wait(0.4):
                client.send(message)

        teller = threading.Thread(target=tell)
        client.send(message)
        teller.start()
        try:
            yield
        finally:
            over.set()
            teller.join()

    def test_what_could_not_be_set_is_set_again_though_nothing_changes(self):
        client = self.well()
        with self.broken():
            client.send(b"lit 1001")
            time.sleep(GLITCH)
            self.assertEqual(self.lit(), "1110")
        with self.telling(client, b"lit 1001"):
            self.wait_until(lambda: self.lit() == "1001", "the lights to be set again", SOON)

    def test_so_is_the_end(self):
        client = self.well()
        with self.broken():
            client.send(b"end")
            client.close()
            time.sleep(GLITCH)
            self.assertEqual(self.lit(), "1110")
        self.wait_until(lambda: self.lit() == DARK, "the lights to be dark", SOON)

    def test_it_is_logged_once_and_told_to_whoever_is_heard(self):
        first = self.well()
        with self.broken(), self.telling(first, b"lit 0111"):
            self.assertEqual(first.recv(1024).decode(), f"lights 0 panel: {self.shown}: Is a directory")
            time.sleep(2)  # several tries
            self.assertEqual(self.said().count("cannot set the lights, retrying"), 1)
        second = self.connect("lit 0111")
        self.assertEqual(second.recv(1024).decode(), f"lights 0 panel: {self.shown}: Is a directory", "not long enough well")
        with self.telling(second, b"lit 0111"):
            self.shows("0111")
            self.assertEqual(second.recv(1024), b"lights 1")
        self.assertEqual(self.said().count("the lights work again"), 1)

    def test_aditd_knows(self):
        self.begin_aditd()
        self.is_at_work()
        with self.broken():
            self.wait_until(lambda: "cannot set the panel lights" in self.said(), "aditd to say so")
        self.is_at_work()
        self.wait_until(lambda: "panel lights work again" in self.said(), "aditd to say so")
