"""Shared by the tests of adit-network."""

import contextlib
import pathlib
import tempfile
import unittest

import hosts
from growth import descriptors
from programs import wait_until

OLD, NEW = "192.168.7.11/24", "192.168.8.11/24"


class Change(unittest.TestCase):
    """`box` is an adit-network."""

    def setUp(self):
        self.network = self.enterContext(hosts.Network())
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-network-")))
        self.addCleanup(lambda: self.box.stop())

    def ends(self, within=50.0):
        wait_until(lambda: self.box.process.poll() is not None, "adit-network to end", within)
        self.assertEqual(self.box.process.returncode, 0, self.box.output())

    def has(self, address, interface="team0", within=50.0):
        wait_until(lambda: self.box.addresses(interface) == [address], f"{interface} to have {address}", within)

    def confirm_first(self):
        """Confirms the box's initial addresses."""
        nonce = self.box.want()
        self.has(OLD)
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()

    @contextlib.contextmanager
    def monitored(self):
        log = self.folder / "monitor"
        with open(log, "wb") as output:
            monitor = self.network.start(self.network.box, "stdbuf", "-oL", "ip", "-o", "monitor", "address", stdout=output)
            try:
                wait_until(lambda: self.listening(monitor), "ip monitor")
                yield log.read_text
            finally:
                monitor.kill()
                monitor.wait()

    @staticmethod
    def listening(monitor):
        return any(link.startswith("socket:") for link in descriptors(monitor.pid))
