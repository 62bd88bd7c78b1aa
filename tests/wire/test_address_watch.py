"""Other hosts that take the box's addresses while it uses them, and adit-network --watch, which says so. Who counts, and when, is in
applier/takers_test and applier/exchanged_test."""

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
IPV6 = 0x86dd  # these hosts' kernels speak it by themselves; an appliance's does not


class AddressWatch(unittest.TestCase):
    def setUp(self):
        self.network = self.enterContext(hosts.Network())
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-watch-")))
        hosts.ip("-n", self.network.box, "address", "add", f"{SECOND}/24", "dev", "darpa0")
        self.heard = capture.Capture(self.network.post, "eth0", capture.mac_of(self.network.box, "darpa0"))
        self.addCleanup(self.heard.stop)
        self.watch = self.watched("box")

    def watched(self, name, host=None):
        watch = networkd.AddressWatch(self.network, self.folder / name, host)
        self.addCleanup(watch.stop)
        return watch

    def other(self, host=None, interface="darpa0"):
        return self.enterContext(neighbour.Neighbour(self.network, host or self.network.post, interface))

    def is_taken(self, address, mac, interface="darpa0", watch=None):
        wait_until(lambda: (watch or self.watch).taken().get((interface, address)) == mac, f"{address} to be taken by {mac}")

    def is_free(self, address, interface="darpa0"):
        wait_until(lambda: (interface, address) not in self.watch.taken(), f"{address} to be free")

    def asked(self):
        """Whom the box has asked for on darpa0."""
        return [frame.arp[1] for frame in self.heard.frames if frame.is_arp and frame.arp[0] == neighbour.NOBODY]

    def test_a_host_that_speaks_from_our_address_has_taken_it(self):
        other = self.other()
        other.take(hosts.BOX_DARPA)
        self.is_taken(hosts.BOX_DARPA, other.mac)
        self.assertEqual(list(self.watch.taken()), [("darpa0", hosts.BOX_DARPA)])
        other.leave()
        self.is_free(hosts.BOX_DARPA)
        self.assertEqual(self.watch.said().count("another machine uses the box's address"), 1, self.watch.said())
        self.assertEqual(self.watch.said().count("no other machine uses"), 1, self.watch.said())

    def test_so_has_one_on_the_teams_side(self):
        other = self.other(self.network.team, "team0")
        other.take(self.network.box_address)
        self.is_taken(self.network.box_address, other.mac, "team0")
        self.assertEqual(self.asked().count(hosts.BOX_DARPA) + self.asked().count(SECOND), len(self.asked()))

    def test_one_that_a_cable_brings_is_found(self):
        wait_until(lambda: self.asked().count(SECOND) >= 3, "the first questions to be over")
        self.network.pull_cable()
        asked = self.asked().count(SECOND)
        other = self.other()
        other.has(SECOND)
        self.network.pull_cable(False)
        self.is_taken(SECOND, other.mac)
        wait_until(lambda: self.asked().count(SECOND) >= asked + 3, "more questions than were left of the first")

    def test_two_boxes_that_are_one_anothers_spare_both_say_so(self):
        """On both sides; the second is plugged in when the first has been silent for long."""
        wait_until(lambda: self.asked().count(SECOND) >= 3, "the first questions to be over")
        second = self.other(self.network.team, "team0")
        second.plug(self.network.post, "darpa0")
        second.has(self.network.box_address)
        second.has(hosts.BOX_DARPA, "darpa0")
        watch = self.watched("second", second.name)
        for port, address in (("team0", self.network.box_address), ("darpa0", hosts.BOX_DARPA)):
            for box, mine, theirs in ((self.network.box, watch, second.name), (second.name, self.watch, self.network.box)):
                mac = capture.mac_of(box, port)
                self.assertNotEqual(mac, capture.mac_of(theirs, port))
                self.is_taken(address, ":".join(f"{byte:02x}" for byte in mac), port, mine)

    def test_nobody_else_has(self):
        """Not who asks for it, nor who probes for it, nor what is no ARP, nor whoever is in another VLAN of the same cable."""
        other = self.other()
        other.has("10.100.1.99")
        other.says("10.100.1.99", hosts.BOX_DARPA)
        other.says(neighbour.NOBODY, hosts.BOX_DARPA)
        other.says("10.100.1.99", "10.100.1.98", neighbour.ANSWERS)
        with capture.inside(other.name), capture.open_packets("darpa0") as packets:
            own = packets.getsockname()[4]
            for size in (0, 1, 27, 46):
                packets.send(neighbour.EVERYBODY + own + b"\x08\x06" + b"\0" * size)
            frame = neighbour.arp(own, hosts.BOX_DARPA, hosts.BOX_DARPA)
            packets.send(frame[:12] + b"\x81\0\0\5" + frame[12:])
            packets.send(frame[:12] + b"\x08\0" + frame[14:])
        other.announces(SECOND)  # what comes after them has been heard
        self.is_taken(SECOND, other.mac)
        self.assertEqual(list(self.watch.taken()), [("darpa0", SECOND)])

    def test_an_interface_goes_and_comes_again(self):
        hosts.ip("-n", self.network.team, "link", "delete", "eth0")
        other = self.other()
        other.take(hosts.BOX_DARPA)
        self.is_taken(hosts.BOX_DARPA, other.mac)
        self.network.plug_team()
        late = self.other(self.network.team, "team0")
        late.take(self.network.box_address)
        self.is_taken(self.network.box_address, late.mac, "team0")

    def test_darpa0_hears_questions_for_the_boxs_own_addresses_alone(self):
        for address in SECOND, hosts.BOX_DARPA:
            wait_until(lambda address=address: self.asked().count(address) >= 3, "the first questions")
        heard = [frame for frame in self.heard.since(0) if frame.kind != IPV6]
        self.assertEqual({frame.arp for frame in heard if frame.is_arp}, {(neighbour.NOBODY, SECOND), (neighbour.NOBODY, hosts.BOX_DARPA)})
        self.assertTrue(all(frame.is_arp for frame in heard), heard)
        self.assertLessEqual(len(heard), 10, "five for each address as it comes")

    def exchanged(self):
        return sorted(address for _, address in self.watch.taken("exchanged"))

    def tell_of_endpoints(self):
        told = {"format": 1, "team_interface": "team0", "command_post_interface": "darpa0", "kept": networkd.AditNetwork.numbers(),
                "endpoints": [hosts.SCORING, hosts.MAPPING], "pending": None, "last": "", "last_nonce": "", "why": ""}
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
