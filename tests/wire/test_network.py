"""adit-network on the box: changes of its addresses that take themselves back, and whether anybody else has them."""

import contextlib
import http.client
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import dhcp
import hosts
import networkd
import programs
from programs import wait_until

OLD, NEW = "192.168.7.11/24", "192.168.8.11/24"


class Base(unittest.TestCase):
    def setUp(self):
        hosts.needs_namespaces()
        self.network = self.enterContext(hosts.Network())
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-network-")))
        self.addCleanup(lambda: self.box.stop())

    def ends(self, within=20.0):
        wait_until(lambda: self.box.process.poll() is not None, "adit-network to end", within)
        self.assertEqual(self.box.process.returncode, 0, self.box.said())

    def has(self, address, interface="team0", within=15.0):
        wait_until(lambda: self.box.addresses(interface) == [address], f"{interface} to have {address}", within)

    def confirm_first(self):
        """The numbers that the box has from the beginning, confirmed."""
        nonce = self.box.want()
        self.has(OLD)
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()


class WithAStandIn(Base):
    """Which does at once what networkd takes some seconds for."""

    def setUp(self):
        super().setUp()
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.assertEqual(self.box.run(), 0)
        self.confirm_first()

    def test_a_change_takes_itself_back(self):
        self.box.want(within_ms=1500, team="192.168.8.11")
        self.has(NEW)
        pending = self.box.pending()
        self.assertEqual(pending["wanted"]["team"]["address"], "192.168.8.11")
        self.ends()
        self.has(OLD)
        status = self.box.status()
        self.assertEqual((status["pending"], status["last"]), (None, "taken back"))
        self.assertEqual(status["why"], "nobody confirmed it within 2 s")
        self.assertNotIn("40-adit-team.network", self.box.files("networkd"))

    def test_a_confirmed_change_stays(self):
        nonce = self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()
        status = self.box.status()
        self.assertEqual((status["pending"], status["last"]), (None, "confirmed"))
        self.assertIn("Address=192.168.8.11/24", (self.folder / "networkd" / "50-adit-team.network").read_text())
        self.start_the_machine_anew()
        self.has(NEW)

    def start_the_machine_anew(self):
        """What is in /run is gone, and the interfaces have what networkd finds."""
        for name in ("networkd", "status"):
            for path in (self.folder / name).iterdir():
                path.unlink()
        self.box.start("--start")
        self.assertEqual(self.box.process.wait(5), 0, self.box.said())
        self.assertEqual(self.box.run(), 0, self.box.said())
        hosts.ip("-n", self.network.box, "address", "flush", "dev", "team0")
        subprocess.run(["ip", "netns", "exec", self.network.box, self.box.networkctl, "reload"], check=True)

    def test_an_unconfirmed_change_is_lost_in_a_power_cut(self):
        self.box.want(team="192.168.8.11")
        self.has(NEW)
        self.box.stop()
        self.start_the_machine_anew()
        self.has(OLD)
        self.assertIsNone(self.box.pending())

    def test_what_was_asked_before_a_power_cut_is_not_done_after_it(self):
        self.box.ask("wanted.json", confirm_within_ms=60000, numbers=self.box.numbers(team="192.168.8.11"))
        self.start_the_machine_anew()
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
        self.ends(2.0)
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
        return any("socket" in os.readlink(link) for link in pathlib.Path(f"/proc/{monitor.pid}/fd").iterdir())

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
        self.box.networkctl.write_text("#!/bin/sh\ntest -e /tmp || exit 1\necho no bus >&2\nexit 1\n")
        self.box.want(team="192.168.8.11")
        self.ends()
        status = self.box.status()
        self.assertEqual(status["last"], "taken back")
        self.assertIn("no bus", status["why"])
        self.assertNotIn("40-adit-team.network", self.box.files("networkd"))

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
        self.start_the_machine_anew()
        self.assertEqual(self.box.addresses("team0"), ["10.0.0.1/24"])

    def test_what_was_to_be_forgotten_before_a_power_cut_is_forgotten_after_it(self):
        self.box.ask("forget.json")
        self.start_the_machine_anew()
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

    def test_an_interface_that_is_gone_is_told(self):
        hosts.ip("-n", self.network.box, "link", "delete", "darpa0")
        self.assertEqual(self.probe()["address"], "")


class WithNetworkd(Base):
    """A real one."""

    def setUp(self):
        super().setUp()
        networkd.needs_networkd()
        hosts.ip("-n", self.network.box, "address", "flush", "dev", "darpa0")  # with its route, which networkd would keep
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.networkd = networkd.Networkd(self.network, self.folder)
        self.addCleanup(self.networkd.stop)
        self.box.networkctl = self.networkd.networkctl
        self.assertEqual(self.box.run(), 0)

    def test_a_change_and_the_way_back(self):
        self.confirm_first()
        self.has(OLD)
        self.has("10.100.1.10/24", "darpa0")
        self.box.want(within_ms=12000, team="192.168.8.11")
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
        self.box.ask("word.json", nonce=self.box.pending()["nonce"], word="back")
        self.ends()
        self.has(OLD)

    def test_several_addresses_on_the_command_posts_side(self):
        nonce = self.box.want(post=["10.100.1.10", "10.100.2.10", "10.100.1.11"], gateway="10.100.2.1")
        three = ["10.100.1.10/24", "10.100.1.11/24", "10.100.2.10/24"]
        wait_until(lambda: sorted(self.box.addresses("darpa0")) == three, "all three addresses")
        self.box.ask("word.json", nonce=nonce, word="confirm")
        self.ends()
        self.assertEqual(self.box.status()["kept"]["command_post"]["gateway"], "10.100.2.1")
        self.box.want(within_ms=1000, post=[])
        wait_until(lambda: self.box.addresses("darpa0") == [], "no address")
        self.ends()
        wait_until(lambda: sorted(self.box.addresses("darpa0")) == three, "all three addresses again")

    def test_networkd_may_start_anew_while_a_change_waits(self):
        self.confirm_first()
        self.box.want(within_ms=5000, team="192.168.8.11")
        self.has(NEW)
        self.networkd.start_anew()
        self.assertEqual(self.box.addresses("team0"), [NEW])
        self.ends()
        self.has(OLD)
        self.networkd.start_anew()
        self.has(OLD)

    def test_a_confirmation_disturbs_nothing(self):
        self.box.put("endpoints.json", endpoints=["10.100.1.200", "10.100.2.201", "172.20.0.1"])
        nonce = self.box.want(team="192.168.8.11", post="10.100.1.10", gateway="10.100.1.200")
        self.has(NEW)
        self.has("10.100.1.10/24", "darpa0")
        by_gateway = ("10.100.1.200", "darpa0")
        ways = {"10.100.1.0/24": (None, "darpa0"), "10.100.2.201": by_gateway, "172.20.0.1": by_gateway}
        wait_until(lambda: self.box.routes() == ways, "the ways to the endpoints and no others")
        self.assertEqual(set(self.box.routes("main")) - {"169.254.0.0/16"}, {"192.168.8.0/24"})
        with WithAStandIn.monitored(self) as seen:
            self.box.ask("word.json", nonce=nonce, word="confirm")
            self.ends()
            self.assertEqual(self.networkd.reload().returncode, 0)
        self.assertEqual(seen(), "")
        self.assertEqual(self.box.addresses("team0"), [NEW])

    listening = staticmethod(WithAStandIn.listening)

    def test_a_pulled_cable_costs_no_address(self):
        self.confirm_first()
        self.has("10.100.1.10/24", "darpa0")
        with WithAStandIn.monitored(self) as seen:
            self.network.pull_cable()
            self.network.pull_cable(False)
        self.assertNotIn("Deleted", seen())
        self.assertEqual(self.box.addresses("darpa0"), ["10.100.1.10/24"])


class WholeBox(Base):
    """aditd asks, adit-network does; the team's host is who sits at the page."""

    def setUp(self):
        hosts.needs_namespaces()
        self.stage = self.enterContext(programs.Stage(network__confirm_within_ms=10000, **{
            "team__listen": [{"address": "0.0.0.0", "port": programs.PORT}]}))
        self.network, self.folder = self.stage.network, self.stage.folder / "network"
        self.folder.mkdir()
        self.stage.folder.chmod(0o755)
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.addCleanup(self.box.stop)
        self.box.wanted = self.stage.folder / "state"
        self.assertEqual(self.box.run(), 0, self.box.said())
        self.confirm_first()
        self.stage.box.stop()
        self.stage.restart_box()
        self.stopping = threading.Event()
        self.units = threading.Thread(target=self.path_unit)
        self.units.start()
        self.addCleanup(self.units.join)
        self.addCleanup(self.stopping.set)

    def path_unit(self):
        """As adit-network.path does."""
        while not self.stopping.wait(0.05):
            if any((self.box.wanted / name).exists() for name in networkd.ASKED):
                self.box.start()
                while self.box.process.poll() is None and not self.stopping.wait(0.05):
                    pass

    def post(self, path, body=None, at="192.168.7.11"):
        """Its status, and what its JSON says."""
        connection = http.client.HTTPConnection(at, programs.PORT, timeout=5)
        with contextlib.closing(connection):
            connection.request("POST", path, json.dumps(body or {}), {
                "Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"})
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read())

    def shown(self):
        return self.stage.box.ask("GET /adit/network")[1]

    def test_a_change_is_checked_tried_and_confirmed_from_the_new_address(self):
        self.assertTrue(self.shown()["managed"], self.shown())
        wanted = self.box.numbers(team="192.168.8.11")
        _, verdict = self.post("/adit/network/check", wanted)
        self.assertEqual(verdict["errors"], [])
        self.assertIn("this cuts you off", verdict["warnings"][0])
        self.assertEqual(verdict["changes"], [{"path": "team.address", "from": "192.168.7.11", "to": "192.168.8.11"}])
        status, view = self.post("/adit/network", wanted)
        self.assertEqual((status, view["pending"]["page"]), (200, "http://192.168.8.11:8000"))
        self.has(NEW)
        hosts.ip("-n", self.network.team, "address", "add", "192.168.8.12/24", "dev", "eth0")
        self.network.box_address = "192.168.8.11"
        wait_until(lambda: self.shown()["pending"], "the change to wait")
        self.assertIn("network change: confirm within", self.stage.box.attention())
        self.assertEqual(self.post("/adit/network", wanted, "192.168.8.11")[0], 409)
        status, _ = self.post("/adit/network/confirm", at="192.168.8.11")
        self.assertEqual(status, 200)
        wait_until(lambda: self.shown()["last"] == "confirmed", "the change to be confirmed")
        self.assertIsNone(self.shown()["pending"])
        self.assertNotIn("network change", self.stage.box.attention())

    def test_a_change_that_cuts_everybody_off_takes_itself_back(self):
        self.post("/adit/network", self.box.numbers(team="192.168.8.11"))
        self.has(NEW)
        self.has(OLD, within=15.0)
        wait_until(lambda: self.shown()["last"] == "taken back", "the change to be taken back")

    def test_a_change_is_not_confirmed_where_the_new_address_is_not_asked(self):
        hosts.ip("-n", self.network.box, "address", "add", "192.168.7.99/24", "dev", "team0")
        self.post("/adit/network", self.box.numbers(team="192.168.7.98"), "192.168.7.99")
        self.has("192.168.7.98/24")
        hosts.ip("-n", self.network.box, "address", "add", "192.168.7.99/24", "dev", "team0")
        status, why = self.post("/adit/network/confirm", at="192.168.7.99")
        self.assertEqual(status, 409)
        self.assertIn("confirm it at http://192.168.7.98:8000", why)
        self.assertEqual(self.post("/adit/network/back", at="192.168.7.99")[0], 200)
        self.ends()

    def test_overlaps_are_refused(self):
        status, why = self.post("/adit/network", self.box.numbers(team="10.100.7.11"))
        self.assertEqual(status, 422)
        self.assertIn("overlaps 10.100.0.0/16", why)

    def steps(self):
        """All steps of a test, by "scoring link", once it has ended."""
        self.assertEqual(self.post("/adit/test")[0], 200)
        wait_until(lambda: not self.stage.box.ask("GET /adit/test")[1]["running"], "the test to end", 30)
        return {f"{endpoint['name']} {step['name']}": step
                for endpoint in self.stage.box.ask("GET /adit/test")[1]["endpoints"] for step in endpoint["steps"]}

    def states(self, steps):
        return {name: step["state"] for name, step in steps.items()}

    def test_the_test_finds_nothing_wrong_and_spends_no_report(self):
        steps = self.steps()
        self.assertEqual({name: state for name, state in self.states(steps).items() if state == "bad"}, {}, steps)
        for name in ("link", "address", "cables", "reach", "token"):
            self.assertEqual((steps[f"scoring {name}"]["state"], steps[f"mapping {name}"]["state"]), ("good", "good"), steps)
        self.assertEqual(self.stage.post.recorded(), [])

    def test_the_test_finds_a_conflict_and_a_server_that_is_gone(self):
        hosts.ip("-n", self.network.post, "address", "add", "10.100.1.10/24", "dev", "eth0")
        steps = self.steps()
        self.assertEqual(steps["scoring address"]["state"], "bad", steps)
        hosts.ip("-n", self.network.post, "address", "delete", "10.100.1.10/24", "dev", "eth0")
        self.stage.post.stop()
        steps = self.steps()
        self.assertEqual(steps["scoring reach"]["state"], "bad")
        self.assertIn("no server at that port", steps["scoring reach"]["said"])
        self.assertEqual(steps["scoring token"]["state"], "skipped")
        self.network.pull_cable()
        self.assertEqual(self.steps()["mapping link"]["state"], "bad")

    def test_the_test_finds_the_command_post_at_the_wrong_port(self):
        hosts.ip("-n", self.network.post, "address", "delete", f"{hosts.SCORING}/24", "dev", "eth0")
        hosts.ip("-n", self.network.team, "address", "add", f"{hosts.SCORING}/24", "dev", "eth0")
        cables = self.steps()["scoring cables"]
        self.assertEqual(cables["state"], "bad", cables)
        self.assertIn("10.100.1.200 is not at darpa0 but at team0", cables["said"])

    def test_the_test_finds_wrong_tokens(self):
        self.stage.box.stop()
        for name in ("scoring", "mapping"):
            (self.stage.folder / "secrets" / f"{name}.token").write_text("another\n")
        self.stage.restart_box()
        steps = self.steps()
        for name in ("scoring token", "mapping token"):
            self.assertEqual(steps[name]["state"], "bad", steps)
            self.assertIn("token is refused", steps[name]["said"])


if __name__ == "__main__":
    unittest.main()
