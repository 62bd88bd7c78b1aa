"""Alarms of the two networks."""

import contextlib

import hosts
import neighbour
import networkd
from alarming import WithAlarms
from programs import wait_until


class Networks(WithAlarms):
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
                self.sees(stage, name, "bad", "network", f"{other.mac} also uses {address} on {interface}")
                other.leave()
                self.goes(stage, name)

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
        self.assertEqual((over["severity"], over["side"]), ("bad", "network"))

    @staticmethod
    def is_reached(stage):
        with contextlib.suppress(OSError):
            return stage.box.ask("GET /adit/run", timeout=2)[0] == 200
        return False
