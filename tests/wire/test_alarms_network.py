"""Alarms of the two networks, and of who connects to the box. Changes of addresses are driven through adit-network's file."""

import contextlib
import json
import socket
import time
import unittest

import hosts
import neighbour
import networkd
import programs
from alarming import WithAlarms
from networkd import AditNetwork
from programs import wait_until

CROWD, STRANGERS, LOOKS = "192.168.7.21", "192.168.7.22", "192.168.7.23"
MANY = 40  # connections
TOKEN = f"Authorization: Bearer {programs.TEAM_TOKEN}\r\n"


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

    # Of a crowd it is told for a minute after the last one: so all three are made together.
    def test_clients_are_refused_wrong_tokens_shown_and_too_many_strangers_connected(self):
        stage = self.stage(team__connections_per_address=MANY)
        for address in (CROWD, STRANGERS):
            hosts.ip("address", "add", f"{address}/24", "dev", "eth0")
        self.assertEqual(stage.box.ask("GET /api/status", token="an-old-token")[0], 401)
        with contextlib.ExitStack() as held:
            for _ in range(MANY):
                held.enter_context(self.begun(stage, CROWD, "/map/update", TOKEN))
            wait_until(lambda: self.is_refused(stage), "one more to be refused")
            for _ in range(MANY):
                held.enter_context(self.begun(stage, STRANGERS, "/adit/login", ""))
            wait_until(lambda: self.alarm(stage, "strangers"), "strangers")
        self.sees(stage, "clients_refused", "bad", "robot", "Clients are refused", f"most of {CROWD}")
        self.sees(stage, "wrong_tokens", "ask", "robot", "Wrong tokens are shown", stage.network.team_address)
        self.sees(stage, "strangers", "wait", "robot", "Too many strangers are connected", STRANGERS)
        for name in ("clients_refused", "wrong_tokens", "strangers"):
            self.goes(stage, name, 90)

    def is_refused(self, stage):
        with self.begun(stage, CROWD, "/state/update", TOKEN) as more:
            more.settimeout(2)
            with contextlib.suppress(TimeoutError):
                return more.recv(100).startswith(b"HTTP/1.1 503")
        return False

    @staticmethod
    def begun(stage, address, path, headers):
        connection = socket.create_connection((stage.network.box_address, programs.PORT), 30, source_address=(address, 0))
        connection.sendall(f"POST {path} HTTP/1.1\r\nHost: {stage.network.box_address}\r\nContent-Type: application/json\r\n{headers}"
                           "Content-Length: 1000\r\n\r\n{".encode())
        return connection


if __name__ == "__main__":
    unittest.main()
