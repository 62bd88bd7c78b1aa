"""Changes of the box's addresses by a real systemd-networkd."""

import pathlib

import dhcp
import hosts
import networkd
from changes import Change, NEW, OLD
from programs import wait_until


class WithNetworkd(Change):
    """A real one."""

    def setUp(self):
        super().setUp()
        networkd.needs_networkd()
        # Addresses that somebody else set. networkd would keep darpa0's route; and the kernel keeps team0's without a broadcast address, so
        # that a networkd (252) which is restarted and has the same one to set sets it for ever, and hears nobody.
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

    def test_by_dhcp_comes_an_address_and_nothing_else(self):
        server = dhcp.Server(self.network.team, "eth0", self.network.team_address, "192.168.7.77")
        self.addCleanup(server.stop)
        self.confirm_first()
        self.box.ask("wanted.json", confirm_within_ms=60000, numbers={
            **self.box.numbers(), "team": {"mode": "dhcp"}})
        self.box.start()
        self.has("192.168.7.77/24")
        self.assertEqual(set(self.box.routes("main")) - {"169.254.0.0/16"}, {"192.168.7.0/24"})
        self.assertEqual(self.box.pending()["wanted"]["team"], {"mode": "dhcp"})
        self.box.ask("word.json", nonce=self.box.pending()["nonce"], word="revert")
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

    def test_networkd_may_restart_while_a_change_waits(self):
        self.confirm_first()
        nonce = self.box.want(within_ms=600000, team="192.168.8.11")
        self.has(NEW)
        self.networkd.restart()
        self.assertEqual(self.box.addresses("team0"), [NEW])
        self.box.ask("word.json", nonce=nonce, word="revert")
        self.ends()
        self.has(OLD)
        self.networkd.restart()
        self.has(OLD)

    def test_networkd_may_die_as_it_is_asked(self):
        """Then the change is made by the next one, or reverted, and what is told is so."""
        self.confirm_first()
        for _ in range(3):
            self.networkd.hang()
            nonce = self.box.ask("wanted.json", confirm_within_ms=600000, numbers=self.box.numbers(team="192.168.8.11"))
            self.box.start()
            wait_until(self.is_asked, "networkd to be asked")
            self.networkd.restart()
            wait_until(lambda: self.is_made(nonce) or self.box.process.poll() is not None, "the change to be made, or not")
            if self.is_made(nonce):
                self.box.ask("word.json", nonce=nonce, word="revert")
            self.ends()
            self.assertEqual((self.box.status()["pending"], self.box.status()["last"]), (None, "reverted"))
            # Where no udev is, a networkd that is started leaves an address alone that it did not set itself.
            wait_until(lambda: OLD in self.box.addresses("team0"), f"team0 to have {OLD}")
            hosts.ip("-n", self.network.box, "address", "flush", "dev", "team0", "to", NEW)

    def is_asked(self):
        """Whether adit-network waits for networkctl."""
        asking = pathlib.Path(f"/proc/{self.box.process.pid}/task/{self.box.process.pid}/children").read_text().split()
        return any(pathlib.Path(f"/proc/{each}/comm").read_text() == "networkctl\n" for each in asking)

    def is_made(self, nonce):
        pending = self.box.pending()
        return bool(pending) and pending["nonce"] == nonce and NEW in self.box.addresses("team0")

    def test_a_confirmation_disturbs_nothing(self):
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

    def test_a_pulled_cable_costs_no_address(self):
        self.confirm_first()
        self.has("10.100.1.10/24", "darpa0")
        with self.monitored() as seen:
            self.network.pull_cable()
            self.network.pull_cable(False)
        self.assertNotIn("Deleted", seen())
        self.assertEqual(self.box.addresses("darpa0"), ["10.100.1.10/24"])
