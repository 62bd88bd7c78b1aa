"""adit-network on the box: changes of its addresses that take themselves back, and whether anybody else has them."""

import json
import os
import signal
import subprocess

import hosts
import networkd
from changes import Change, NEW, OLD
from programs import wait_until


class WithAStandIn(Change):
    """Which does at once what networkd takes some seconds for."""

    def setUp(self):
        super().setUp()
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.assertEqual(self.box.run(), 0)
        self.confirm_first()

    def test_a_change_takes_itself_back(self):
        self.box.want(within_ms=15000, team="192.168.8.11")
        self.has(NEW)
        pending = self.box.pending()
        self.assertEqual(pending["wanted"]["team"]["address"], "192.168.8.11")
        self.ends()
        self.has(OLD)
        status = self.box.status()
        self.assertEqual((status["pending"], status["last"]), (None, "taken back"))
        self.assertEqual(status["why"], "nobody confirmed it within 15 s")
        self.assertNotIn("04-adit-team.network", self.box.files("networkd"))

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
        self.assertEqual(self.box.process.wait(30), 0, self.box.said())
        self.assertEqual(self.box.run(), 0, self.box.said())
        hosts.ip("-n", self.network.box, "address", "flush", "dev", "team0")
        subprocess.run(["ip", "netns", "exec", self.network.box, self.box.networkctl, "reload"], check=True)

    def test_an_unconfirmed_change_is_lost_in_a_power_cut(self):
        self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.stop()
        self.restart_the_machine()
        self.has(OLD)
        self.assertIsNone(self.box.pending())

    def test_what_was_asked_before_a_power_cut_is_not_done_after_it(self):
        self.box.ask("wanted.json", confirm_within_ms=60000, numbers=self.box.numbers(team="192.168.8.11"))
        self.restart_the_machine()
        self.has(OLD)
        self.assertEqual(self.box.files("wanted"), [])
        self.assertIsNone(self.box.pending())

    def test_a_change_is_taken_back_after_a_kill(self):
        self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.stop()
        self.assertEqual(self.box.run(), 0)
        self.has(OLD)
        self.assertEqual(self.box.status()["last"], "taken back")

    def test_a_change_is_taken_back_after_a_kill_though_networkd_fails_at_first(self):
        self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.stop()
        self.break_networkctl()
        self.assertEqual(self.box.run(), 1)
        self.assertTrue(self.box.pending())
        self.box.stand_in()
        self.assertEqual(self.box.run(), 0)
        self.has(OLD)
        self.assertEqual((self.box.pending(), self.box.status()["last"]), (None, "taken back"))

    def break_networkctl(self):
        self.box.networkctl.write_text("#!/bin/sh\ntest -e /tmp || exit 1\necho no bus >&2\nexit 1\n")

    def test_a_change_is_taken_back_when_the_service_is_stopped(self):
        self.box.want(team="192.168.8.11")
        self.has(NEW)
        os.kill(self.pid(), signal.SIGTERM)
        self.ends()
        self.has(OLD)

    def pid(self):
        """Of adit-network itself: `ip netns exec` becomes it."""
        return self.box.process.pid

    def test_a_change_is_taken_back_by_one_word(self):
        nonce = self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.ask("word.json", nonce=nonce, word="back")
        self.ends()
        self.has(OLD)

    def test_another_nonce_confirms_nothing(self):
        self.box.want(within_ms=1500, team="192.168.8.11")
        self.box.ask("word.json", word="confirm")
        self.ends()
        self.has(OLD)

    def test_the_other_interface_is_not_touched(self):
        with self.monitored() as seen:
            nonce = self.box.want(team="192.168.8.11")
            self.has(NEW)
            self.box.ask("word.json", nonce=nonce, word="back")
            self.ends()
        self.assertIn("team0", seen())
        self.assertNotIn("darpa0", seen())

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
        self.assertEqual(self.box.said().count("refused what was asked for"), 12, self.box.said())
        self.assertEqual(self.box.files("wanted"), [])
        self.assertEqual(secret.read_text(), "of root")
        self.assertNotIn("of root", self.box.said())
        self.assertEqual(self.box.addresses("team0"), [OLD])

    def test_a_change_that_cannot_be_applied_is_taken_back_at_once(self):
        self.break_networkctl()
        self.box.want(team="192.168.8.11")
        self.assertEqual(self.box.process.wait(50), 1, "so that its unit starts it again")
        status = self.box.status()
        self.assertEqual(status["last"], "taken back")
        self.assertIn("no bus", status["why"])
        self.assertNotIn("04-adit-team.network", self.box.files("networkd"))
        self.assertEqual(self.box.run(), 1)
        self.box.stand_in()
        self.assertEqual(self.box.run(), 0)

    def test_an_address_that_somebody_has_is_not_taken(self):
        hosts.ip("-n", self.network.team, "address", "add", "192.168.8.11/24", "dev", "eth0")
        self.box.want(team="192.168.8.11")
        self.ends()
        status = self.box.status()
        self.assertEqual(status["last"], "taken back")
        self.assertIn("192.168.8.11 is in use already on team0", status["why"])
        self.assertEqual(self.box.addresses("team0"), [OLD])

    def test_what_was_confirmed_is_forgotten(self):
        (self.folder / "network.json").write_text(json.dumps({"version": 1, "numbers": self.box.numbers("10.0.0.1", [])}))
        self.box.ask("forget.json")
        self.assertEqual(self.box.run(), 0)
        self.assertEqual((self.box.addresses("team0"), self.box.addresses("darpa0")), (["10.0.0.1/24"], []))
        self.assertEqual(self.box.files("state"), [])
        self.assertEqual(self.box.status()["kept"], self.box.numbers("10.0.0.1", []))
        self.restart_the_machine()
        self.assertEqual(self.box.addresses("team0"), ["10.0.0.1/24"])

    def test_what_was_to_be_forgotten_before_a_power_cut_is_forgotten_after_it(self):
        self.box.ask("forget.json")
        self.restart_the_machine()
        self.assertIsNone(self.box.status()["kept"])
        self.assertEqual(self.box.files("state"), [])

    def probe(self, sought=""):
        nonce = self.box.ask("probe.json", sought=sought)
        self.assertEqual(self.box.run(), 0)
        probed = self.box.probed()
        self.assertEqual(probed["nonce"], nonce)
        return probed

    def test_nobody_else_has_the_address(self):
        self.assertEqual({**self.probe(), "nonce": ""},
                         {"version": 1, "nonce": "", "address": "10.100.1.10", "claimant": "", "own": "", "found_on": "", "trouble": ""})

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

    def test_a_probe_does_not_wait_for_a_change(self):
        nonce = self.box.want(team="192.168.8.11")
        asked = self.box.ask("probe.json", sought="")
        wait_until(lambda: (self.box.probed() or {}).get("nonce") == asked, "the probe's answer")
        self.assertTrue(self.box.pending())
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()

    def test_a_word_that_comes_during_a_probe_is_in_time(self):
        nonce = self.box.want(within_ms=5000, team="192.168.8.11")
        self.box.ask("probe.json", sought="10.100.1.77")
        wait_until(lambda: "probe.json" not in self.box.files("wanted"), "the probe to be begun")
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()
        self.assertEqual(self.box.status()["last"], "confirmed")

    def test_an_interface_that_is_gone_is_told(self):
        hosts.ip("-n", self.network.box, "link", "delete", "darpa0")
        self.assertEqual(self.probe()["address"], "")
