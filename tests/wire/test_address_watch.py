"""Other hosts take the box's addresses while the box uses them, and adit-network --watch reports it. Rules: applier/takers_test and
applier/exchanged_test."""

import json
import pathlib
import tempfile
import unittest

import capture
import hosts
import networkd
import neighbour
from programs import wait_until

SECOND = "10.100.1.11"  # of darpa0's addresses


class AddressWatch(unittest.TestCase):
    def setUp(self):
        self.network = self.enterContext(hosts.Network())
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-watch-")))
        hosts.ip("-n", self.network.box, "address", "add", f"{SECOND}/24", "dev", "darpa0")
        self.heard = capture.Capture(self.network.post, "eth0", capture.mac_of(self.network.box, "darpa0"))
        self.addCleanup(self.heard.stop)
        self.watch = networkd.AddressWatch(self.network, self.folder / "box")
        self.addCleanup(self.watch.stop)

    def other(self, host=None, interface="darpa0"):
        return self.enterContext(neighbour.Neighbour(self.network, host or self.network.post, interface))

    def is_taken(self, address, mac, interface="darpa0"):
        wait_until(lambda: self.watch.taken().get((interface, address)) == mac, f"{address} to be taken by {mac}")

    def is_free(self, address, interface="darpa0"):
        wait_until(lambda: (interface, address) not in self.watch.taken(), f"{address} to be free")

    def asked(self):
        """The addresses for which the box has sent ARP requests on darpa0."""
        return [frame.arp[1] for frame in self.heard.frames if frame.is_arp and frame.arp[0] == neighbour.NOBODY]

    def test_host_that_uses_our_address_is_a_conflict(self):
        other = self.other()
        other.take(hosts.BOX_DARPA)
        self.is_taken(hosts.BOX_DARPA, other.mac)
        self.assertEqual(list(self.watch.taken()), [("darpa0", hosts.BOX_DARPA)])
        other.leave()
        self.is_free(hosts.BOX_DARPA)
        self.assertEqual(self.watch.output().count("another machine uses the box's address"), 1, self.watch.output())
        self.assertEqual(self.watch.output().count("no other machine uses"), 1, self.watch.output())

    def test_conflict_after_a_cable_is_plugged_is_found(self):
        wait_until(lambda: self.asked().count(SECOND) >= 3, "the first questions to be over")
        self.network.pull_cable()
        asked = self.asked().count(SECOND)
        other = self.other()
        other.has(SECOND)
        self.network.pull_cable(False)
        self.is_taken(SECOND, other.mac)
        wait_until(lambda: self.asked().count(SECOND) >= asked + 3, "more questions than were left of the first")

    def test_interface_disappears_and_returns(self):
        hosts.ip("-n", self.network.team, "link", "delete", "eth0")
        other = self.other()
        other.take(hosts.BOX_DARPA)
        self.is_taken(hosts.BOX_DARPA, other.mac)
        self.network.plug_team()
        late = self.other(self.network.team, "team0")
        late.take(self.network.box_address)
        self.is_taken(self.network.box_address, late.mac, "team0")

    def exchanged(self):
        return sorted(address for _, address in self.watch.taken("exchanged"))

    def tell_of_endpoints(self):
        told = {"format": 1, "team_interface": "team0", "command_post_interface": "darpa0", "kept": networkd.AditNetwork.numbers(),
                "endpoints": [hosts.SCORING, hosts.MAPPING], "pending": None, "last": "", "last_nonce": "", "why": "", "trouble": ""}
        folder = self.watch.folder
        (folder / ".new").write_text(json.dumps(told))
        (folder / ".new").rename(folder / "status.json")

    def test_the_command_post_is_at_the_teams_port(self):
        self.tell_of_endpoints()
        both = [hosts.SCORING, hosts.MAPPING]
        self.network.exchange_cables()
        wait_until(lambda: self.exchanged() == both, "the exchanged cables")
        self.network.exchange_cables()
        wait_until(lambda: self.exchanged() == [], "each in its own port")
        self.assertEqual(self.watch.taken(), {})
