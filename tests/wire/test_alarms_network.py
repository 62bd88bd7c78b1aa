"""Alarms of the two networks. Changes of addresses are driven through adit-network's file."""

import contextlib
import json
import time

import hosts
import neighbour
import networkd
from alarming import WithAlarms
from networkd import AditNetwork
from programs import wait_until

LOOKS = "192.168.7.22"  # from the cable at team0


class Networks(WithAlarms):
    # By adit-network's file, which is that of test_network.py.
    def tell_of_network(self, stage, **more):
        status = {"version": 1, "team_interface": "team0", "command_post_interface": "darpa0",
                  "kept": AditNetwork.numbers(), "endpoints": [], "pending": None, "last": None, "last_nonce": "", "why": "", **more}
        folder = stage.folder / "network" / "status"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "status.new").write_text(json.dumps(status))
        (folder / "status.new").rename(folder / "status.json")

    def test_a_change_of_the_network_waits_and_then_there_is_no_address(self):
        stage = self.stage()
        until = time.clock_gettime_ns(time.CLOCK_MONOTONIC) // 1_000_000 + 60_000
        self.tell_of_network(stage, pending={"nonce": "0" * 32, "until_ms": until, "confirm_within_ms": 60000,
                                             "wanted": AditNetwork.numbers(team="192.168.8.11")})
        self.sees(stage, "network_change", "ask", "network", "A network change is waiting", "192.168.8.11")
        self.tell_of_network(stage, kept={**AditNetwork.numbers(), "command_post": {"addresses": [], "gateway": ""}})
        self.goes(stage, "network_change")
        self.sees(stage, "no_address", "bad", "box", "The box has no address upstream")
        self.tell_of_network(stage)
        self.goes(stage, "no_address")

    def test_our_address_is_taken(self):
        """By another host, on either side, and once it is gone the alarm goes by itself."""
        stage = self.stage()
        watch = networkd.AddressWatch(stage.network, stage.folder / "watch")
        self.addCleanup(watch.stop)
        for side, host, address, interface in (("command_post", stage.network.post, hosts.BOX_DARPA, "darpa0"),
                                               ("team", stage.network.team, stage.network.box_address, "team0")):
            with neighbour.Neighbour(stage.network, host, interface) as other:
                other.take(address)
                name = f"address_taken:{side}"
                self.sees(stage, name, "bad", "network", "Our address is taken", f"{address} on {interface} is also {other.mac}'s")
                other.leave()
                self.goes(stage, name)

    def test_the_two_cables_are_exchanged(self):
        """Nobody of the team can ask then: whoever looks has plugged himself into the cable that is at team0."""
        stage = self.stage()
        self.tell_of_network(stage, endpoints=[hosts.SCORING, hosts.MAPPING])
        watch = networkd.AddressWatch(stage.network, stage.folder / "watch", told=stage.folder / "network/status")
        self.addCleanup(watch.stop)
        with self.exchanged(stage):
            alarm = self.sees(stage, "cables_exchanged", "bad", "network", "The two cables are exchanged", light="scoring", within=90)
            self.assertRegex(alarm["why"], r"^10\.100\.1\.20[01] is at team0 and not at darpa0$")
            self.assertEqual([each["id"] for each in self.view(stage)["alarms"]], ["cables_exchanged"], "the only cause")
            self.assertGreater(alarm["hides"], 0)
        self.goes(stage, "cables_exchanged")

    @contextlib.contextmanager
    def exchanged(self, stage):
        network = stage.network
        network.exchange_cables()
        hosts.ip("-n", network.post, "address", "add", f"{LOOKS}/24", "dev", "eth0")
        hosts.enter(f"/run/netns/{network.post}")
        try:
            yield
        finally:
            hosts.enter(f"/run/netns/{network.team}")
            network.exchange_cables()

    def test_the_teams_cable_is_out(self):
        """Nobody can ask then: the lights say it, and what is asked afterwards."""
        stage = self.stage()
        hosts.ip("link", "set", "eth0", "down")
        self.blinks(stage, "health")
        self.blinks(stage, "attention")
        hosts.ip("link", "set", "eth0", "up")
        wait_until(lambda: self.is_reached(stage), "the box to be reached again")
        self.goes(stage, "cable_out:team")
        over = next(each for each in self.view(stage)["alarms_over"] if each["id"] == "cable_out:team")
        self.assertEqual((over["severity"], over["side"], over["was"]), ("bad", "network", "The team's cable was out"))

    @staticmethod
    def is_reached(stage):
        with contextlib.suppress(OSError):
            return stage.box.ask("GET /adit/run", timeout=2)[0] == 200
        return False
