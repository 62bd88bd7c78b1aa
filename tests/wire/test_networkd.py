"""Changes of the box's addresses with a real systemd-networkd."""

import hosts
import networkd
from changes import Change, NEW, OLD
from programs import wait_until


class WithNetworkd(Change):
    """With a real systemd-networkd."""

    def setUp(self):
        super().setUp()
        networkd.needs_networkd()
        # Removes addresses from earlier tests. networkd would keep darpa0's route. The kernel keeps team0's address
        # without a broadcast address, so that a restarted networkd (252) with the same address to set would set it
        # for ever, and hear no host.
        for port in "team0", "darpa0":
            hosts.ip("-n", self.network.box, "address", "flush", "dev", port)
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.networkd = networkd.Networkd(self.network, self.folder)
        self.addCleanup(self.networkd.stop)
        self.box.networkctl = self.networkd.networkctl
        self.assertEqual(self.box.run(), 0)

    def test_a_change_and_the_way_back(self):
        self.confirm_first()
        self.has(OLD)
        self.has("10.100.1.10/24", "darpa0")
        self.box.want(within_ms=20000, team="192.168.8.11")
        self.has(NEW)
        self.assertEqual(self.box.addresses("darpa0"), ["10.100.1.10/24"])
        self.ends()
        self.has(OLD)

    def test_several_addresses_on_the_command_posts_side(self):
        nonce = self.box.want(post=["10.100.1.10", "10.100.2.10", "10.100.1.11"], gateway="10.100.2.1")
        three = ["10.100.1.10/24", "10.100.1.11/24", "10.100.2.10/24"]
        wait_until(lambda: sorted(self.box.addresses("darpa0")) == three, "all three addresses")
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()
        self.assertEqual(self.box.status()["kept"]["command_post"]["gateway"], "10.100.2.1")
        self.box.want(within_ms=15000, post=[])
        wait_until(lambda: self.box.addresses("darpa0") == [], "no address")
        self.ends()
        wait_until(lambda: sorted(self.box.addresses("darpa0")) == three, "all three addresses again")

    def test_confirmation_causes_no_reload(self):
        self.box.put("endpoints.json", endpoints=["10.100.1.200", "10.100.2.201", "172.20.0.1"])
        nonce = self.box.want(team="192.168.8.11", post="10.100.1.10", gateway="10.100.1.200")
        self.has(NEW)
        self.has("10.100.1.10/24", "darpa0")
        by_gateway = ("10.100.1.200", "darpa0")
        ways = {"10.100.1.0/24": (None, "darpa0"), "10.100.2.201": by_gateway, "172.20.0.1": by_gateway}
        wait_until(lambda: self.box.routes() == ways, "the ways to the endpoints and no others")
        self.assertEqual(set(self.box.routes("main")) - {"169.254.0.0/16"}, {"192.168.8.0/24"})
        with self.monitored() as seen:
            self.box.ask("word.json", nonce=nonce, word="confirm")
            self.ends()
            self.assertEqual(self.networkd.reload().returncode, 0)
        self.assertEqual(seen(), "")
        self.assertEqual(self.box.addresses("team0"), [NEW])

    def test_pulled_cable_keeps_the_addresses(self):
        self.confirm_first()
        self.has("10.100.1.10/24", "darpa0")
        with self.monitored() as seen:
            self.network.pull_cable()
            self.network.pull_cable(False)
        self.assertNotIn("Deleted", seen())
        self.assertEqual(self.box.addresses("darpa0"), ["10.100.1.10/24"])
