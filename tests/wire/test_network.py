"""adit-network on the box: a change of its addresses that stays, hostile requests, and whether anybody else has an address. How a change
is reverted is in network/change_test, applier/applier_test, applier/networkd_files_test and test_networkd."""

import os
import subprocess

import hosts
import networkd
from changes import Change, NEW, OLD
from patience import patient


class WithAStandIn(Change):
    """Which does at once what networkd takes some seconds for."""

    def setUp(self):
        super().setUp()
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.assertEqual(self.box.run(), 0)
        self.confirm_first()

    def test_a_confirmed_change_stays(self):
        nonce = self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()
        status = self.box.status()
        self.assertEqual((status["pending"], status["last"]), (None, "confirmed"))
        self.assertIn("Address=192.168.8.11/24", (self.folder / "networkd" / "05-adit-team.network").read_text())
        self.restart_the_machine()
        self.has(NEW)

    def restart_the_machine(self):
        """What is in /run is gone, and the interfaces have what networkd finds."""
        for name in ("networkd", "status"):
            for path in (self.folder / name).iterdir():
                path.unlink()
        self.box.start("--start")
        self.assertEqual(self.box.process.wait(patient(30)), 0, self.box.said())
        self.assertEqual(self.box.run(), 0, self.box.said())
        hosts.ip("-n", self.network.box, "address", "flush", "dev", "team0")
        subprocess.run(["ip", "netns", "exec", self.network.box, self.box.networkctl, "reload"], check=True)

    def test_what_is_wrong_or_hostile_is_refused_and_taken_away(self):
        secret = self.folder / "secret"
        secret.write_text("of root")
        good = self.box.numbers(team="192.168.8.11")
        injected = self.box.numbers(team="192.168.8.11\n[Network]\nDHCP=yes")
        for file, members in (("wanted.json", {"confirm_within_ms": 60000, "numbers": injected}),
                              ("wanted.json", {"confirm_within_ms": 10, "numbers": good}),
                              ("wanted.json", {"confirm_within_ms": 60000, "numbers": good, "interface": "lo"}),
                              ("wanted.json", {"confirm_within_ms": 60000, "numbers": good, "nonce": "../../x"}),
                              ("word.json", {"word": "reboot"}), ("probe.json", {"interface": "lo"}),
                              ("endpoints.json", {"endpoints": ["0.0.0.0/0"]}), ("forget.json", {"all": True})):
            self.box.ask(file, **members)
            self.assertEqual(self.box.run(), 0)
        (self.folder / "wanted" / "wanted.json").symlink_to(secret)
        self.assertEqual(self.box.run(), 0)
        os.mkfifo(self.folder / "wanted" / "wanted.json")
        self.assertEqual(self.box.run(), 0)
        (self.folder / "wanted" / "wanted.json").write_bytes(b"{" * 1000000)
        self.assertEqual(self.box.run(), 0)
        (self.folder / "wanted" / "wanted.json" / "deeper").mkdir(parents=True)
        self.assertEqual(self.box.run(), 0)
        self.assertEqual(self.box.said().count("request rejected"), 12, self.box.said())
        self.assertEqual(self.box.files("wanted"), [])
        self.assertEqual(secret.read_text(), "of root")
        self.assertNotIn("of root", self.box.said())
        self.assertEqual(self.box.addresses("team0"), [OLD])

    def test_an_address_that_somebody_has_is_not_taken(self):
        hosts.ip("-n", self.network.team, "address", "add", "192.168.8.11/24", "dev", "eth0")
        self.box.want(team="192.168.8.11")
        self.ends()
        status = self.box.status()
        self.assertEqual(status["last"], "reverted")
        self.assertIn("192.168.8.11 is already in use on team0", status["why"])
        self.assertEqual(self.box.addresses("team0"), [OLD])

    def probe(self, sought=""):
        nonce = self.box.ask("probe.json", sought=sought)
        self.assertEqual(self.box.run(), 0)
        probed = self.box.probed()
        self.assertEqual(probed["nonce"], nonce)
        return probed

    def test_somebody_else_has_the_address(self):
        hosts.ip("-n", self.network.post, "address", "add", "10.100.1.10/24", "dev", "eth0")
        probed = self.probe()
        shown = subprocess.run(["ip", "netns", "exec", self.network.post, "cat", "/sys/class/net/eth0/address"],
                               capture_output=True, text=True, check=True)
        self.assertEqual(probed["claimant"], shown.stdout.strip())
        self.assertEqual((probed["own"], probed["trouble"]), ("", ""))

    def test_the_command_post_is_found_at_whichever_port_it_is(self):
        self.assertEqual(self.probe(hosts.SCORING)["found_on"], "darpa0")
        self.assertEqual(self.probe("10.100.1.77")["found_on"], "")
        hosts.ip("-n", self.network.team, "address", "add", "10.100.1.77/24", "dev", "eth0")
        self.assertEqual(self.probe("10.100.1.77")["found_on"], "team0")

    def test_an_interface_that_is_gone_is_told(self):
        hosts.ip("-n", self.network.box, "link", "delete", "darpa0")
        self.assertEqual(self.probe()["address"], "")
