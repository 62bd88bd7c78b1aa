"""The daily variant: the real root and units in a container, set up, reporting, restarted and killed, in under a minute."""

import contextlib
import socket
import time
import unittest

import requests

import cables
import container
import dhcp_server
import eavesdropper
import hosts
import inside_unit
import maps
import messages
import ntp
import programs
import stage
import sticks
from contained import Contained
from patience import patient
from reporting import REPORT, another, submit
from stage import load_tests, note  # unittest looks for them here

STATE = "/var/lib/private/adit"
JSON = messages.Style()
POSE = {"name": "r1", "position": {"x": 4.0, "y": 0.0, "z": 0.0}, "orientation": maps.IDENTITY}


def setUpModule():
    hosts.needs_root()
    if container.missing():
        raise unittest.SkipTest(container.missing())


class Everyday(Contained):
    def test_it_answers_at_the_factory_address(self):
        self.box.start()
        note("container, from its start to the first answer on team0", f"{time.monotonic() - self.box.began:.1f} s")
        self.assertEqual(self.asked("GET /adit/session")["first_start"], True)

    def test_no_unit_has_failed(self):
        self.assertEqual(self.box.run("systemctl", "--failed", "--plain", "--no-legend", "--no-pager").stdout, "")

    def test_it_is_set_up_over_the_api(self):
        self.set_up()

    def addresses(self):
        return [each["address"] for each in self.asked("GET /adit/network")["command_post"]["addresses"]]

    def networkd(self):
        return self.shell("systemctl show -p MainPID --value systemd-networkd.service").strip()

    def test_networkd_may_be_killed_in_the_middle_of_a_change(self):
        other = {"addresses": [{"address": "10.100.1.77", "prefix": 24}], "gateway": ""}
        self.asked("POST /adit/network", {**stage.NUMBERS, "command_post": other})
        programs.wait_until(lambda: self.addresses() == ["10.100.1.77"], "the change to be tried", 60)
        before = self.networkd()
        self.shell("systemctl kill --kill-who=main --signal=KILL systemd-networkd.service")
        programs.wait_until(lambda: self.networkd() not in ("0", before), "another networkd", 60)
        self.shell("networkctl reload")  # so it serves
        self.assertEqual(self.addresses(), ["10.100.1.77"])
        programs.wait_until(self.reverted, "the change to be reverted", 60)
        programs.wait_until(lambda: self.addresses() == [hosts.BOX_DARPA], "the address from before", 60)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)

    def reverted(self):
        session = {**self.session, "Content-Type": "application/json"}
        return self.box.ask("POST /adit/network/revert", session, None, token=None)[0] == 200

    def test_a_report_is_recorded(self):
        self.assertEqual(submit(self.stage).status_code, 201)
        self.assertEqual(len(self.stage.post.recorded(REPORT)), 1)

    def test_a_restart_loses_no_connection_attempt(self):
        network, before, tried = self.stage.network, self.box.pid(), 0
        self.box.run("systemctl", "restart", "--no-block", "adit.service")
        end = time.monotonic() + patient(60)
        while tried <= 100 or self.box.pid() in (0, before) or not self.box.answers():
            self.assertLess(time.monotonic(), end, "it is not started again")
            for _ in range(20):
                network.connect(network.team, network.box_address, 80, 20.0).close()
                tried += 1

    def test_sandbox_of_the_unit_holds(self):
        # A container's systemd may not load an address filter into the kernel.
        refused = inside_unit.check(self, self.shell, but={"connect to 203.0.113.1"})
        note("container, refused from inside adit.service", f"{refused} attempts")

    def flows(self, uri, message):
        """A posted message is accepted and arrives."""
        before = len(self.stage.post.requests(uri))
        answer = messages.post(requests.Session(), self.box.url, uri, message, JSON)
        self.assertEqual(answer.status_code, 200, answer.text)
        programs.wait_until(lambda: len(self.stage.post.requests(uri)) > before, f"{uri} to go on", 60)

    def report_states(self):
        return [each["state"] for each in self.box.reports()]

    def takes_no(self, report):
        """And other messages are sent."""
        refused = submit(self.stage, report)
        self.assertEqual(refused.status_code, 503, refused.text)
        self.assertEqual(self.stage.post.recorded(report), [])
        self.assertEqual(self.report_states(), ["answered"], "what can be read is shown")
        self.flows("/state/update", {"poses": [POSE]})
        self.flows("/map/update", messages.map_update(maps.made_grid(20, 20), "r1", time.time(), JSON))

    def test_unwritable_state_directory(self):
        """A file system of its own, that is read-only as after an error of the disk, then full, with room in the ledger's files. Without it, an
        older copy of the ledger is back: an alarm says so, and the operator decides about reports sent since."""
        self.shell(f"""systemctl stop adit.service; cp -a {STATE} /run/was
            mount -t tmpfs -o size=32m,mode=0700 tmpfs {STATE}; cp -aT /run/was {STATE}; mount -o remount,ro {STATE}
            systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)
        self.assertIn("ledger_unwritable", self.box.alarms())
        self.takes_no(another(1))
        self.shell(f"""systemctl stop adit.service; mount -o remount,rw {STATE}
            dd if=/dev/zero of={STATE}/filler bs=4096 2>/dev/null || true; systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)
        self.assertEqual(submit(self.stage, another(2)).status_code, 201)
        self.assertFalse(self.box.alarms() & {"ledger_unwritable", "ledger_damaged"})
        self.shell(f"""systemctl stop adit.service; umount {STATE}; systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)
        self.assertIn("ledger_damaged", self.box.alarms())
        self.assertEqual(self.report_states(), ["answered", "in_doubt"])
        self.assertEqual(len(self.stage.post.recorded(another(2))), 1)

    def test_it_is_started_again_after_a_kill(self):
        before = programs.wait_until(self.box.pid, "it to run", 60)
        self.box.run("kill", "-9", str(before))
        programs.wait_until(
            lambda: self.box.pid() not in (0, before) and self.box.answers(), "another aditd to answer", 60
        )

    def test_the_lights_show_a_hang_before_systemd_ends_it(self):
        before = programs.wait_until(self.box.pid, "it to run", 60)
        self.wait_for_lights()
        self.box.run("kill", "-STOP", str(before))
        began = time.monotonic()
        programs.wait_until(lambda: self.lit() <= {"health"}, "the lights not to pretend any more", 60)
        note("container, from SIGSTOP of aditd to the fault on the lights", f"{time.monotonic() - began:.1f} s")
        self.assertEqual(self.box.pid(), before, "nobody has ended it yet")
        programs.wait_until(lambda: self.box.pid() not in (0, before) and self.box.answers(), "another aditd to answer", 60)
        self.wait_for_lights()

    def blink(self, lights):
        """Waits for all of these alarms, while health is steady."""
        seen = [self.lit() for _ in range(12)]
        each = all(any(light in lit for lit in seen) and any(light not in lit for lit in seen) for light in lights)
        return each and all("health" in lit for lit in seen)

    def test_exchanged_cables_show_on_the_lights_and_heal(self):
        """The page is unavailable then, so only the lights show the state."""
        self.wait_for_lights()
        self.stage.network.exchange_cables()
        programs.wait_until(lambda: self.blink(["scoring", "mapping", "attention"]), "the lights to tell of it", 60)
        self.assertFalse(self.box.answers(), "nothing is served at darpa0, and no team is at team0")
        told = self.box.run("adit", "status")
        self.assertEqual(told.returncode, 1, told)
        programs.wait_until(
            lambda: '"cables_exchanged"' in self.box.run("adit", "status", "--json").stdout, "the alarm to say so", 90
        )
        self.stage.network.exchange_cables()
        programs.wait_until(self.box.answers, "the team to reach the box", 60)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        self.wait_for_lights()

    def test_a_panel_that_is_killed_or_hangs_comes_back(self):
        for how in "KILL", "STOP":
            before = self.shell("systemctl show -p MainPID --value adit-panel.service").strip()
            self.shell(f"kill -{how} {before}; rm -f /run/adit-panel/lights")
            programs.wait_until(lambda: self.lit() >= {"health", "scoring", "mapping"}, "another adit-panel to show the lights", 60)
            self.assertTrue(self.box.answers())

    def test_a_watch_of_the_network_that_hangs_is_started_again(self):
        def listening():
            """The number of its process once it has said that it listens; otherwise ""."""
            said = self.shell("systemctl show -p ActiveState,MainPID adit-network-watch.service").splitlines()
            told = dict(line.split("=", 1) for line in said)
            return told["MainPID"] if told["ActiveState"] == "active" else ""

        before = programs.wait_until(listening, "it to listen", 60)
        self.shell(f"kill -STOP {before}")
        programs.wait_until(lambda: listening() not in ("", before), "another one to listen", 90)

    def speaks_ntp(self):
        return self.box.run("systemctl", "is-active", "adit-ntp").stdout.strip() == "active"

    def asks_for_ntp(self, **clock):
        session = {**self.session, "Content-Type": "application/json"}
        held = self.box.ask("GET /adit/settings", session, token=None)[1]
        self.asked("POST /adit/settings", {"settings": {**held["settings"], "clock": clock}, "base": held["tag"]})

    def test_ntp_runs_only_on_team0_and_only_by_setting(self):
        """A container may not set the clock; all else is as on a box."""
        network = self.stage.network
        for unit in ("adit-clock.service", "adit-clock.path"):
            self.drop_in(unit, "[Unit]", "ConditionVirtualization=")
        only = ("CapabilityBoundingSet", "AmbientCapabilities")
        self.drop_in("adit-ntp.service", "[Service]", *(f"{name}={value}" for name in only for value in ("", "CAP_NET_BIND_SERVICE")))
        self.shell("systemctl daemon-reload; systemctl start adit-clock.service adit-clock.path")
        server = ntp.Server(network.team, network.team_address, ahead=90 * 86400.0)
        self.addCleanup(server.close)
        self.assertFalse(self.speaks_ntp(), "it is off")
        self.asks_for_ntp(ntp_server=network.team_address, serve_ntp=True)
        programs.wait_until(self.speaks_ntp, "chronyd to be started", 60)
        programs.wait_until(lambda: server.asked > 0, "the server to be asked", 60)
        self.assertIn("is being asked", self.asked("GET /adit/clock")["ntp"])
        self.assertEqual(self.asked("GET /adit/clock")["source"], "none")
        self.assertIsNone(ntp.asked_of(network.team, network.box_address), "its time is not set")
        # As if the operator had set it, while nobody asks again for the Command Post's time, which nobody here may set.
        self.shell("""systemctl stop adit-clock.path adit-clock.service
            sed -i 's/"source":"none"/"source":"operator"/' /run/adit-clock/status.json; grep -q operator /run/adit-clock/status.json
            systemctl start adit-clock.path""")
        self.asks_for_ntp(serve_ntp=True)
        stratum, told = programs.wait_until(lambda: ntp.asked_of(network.team, network.box_address), "the team to be told the time", 60)
        self.assertEqual(stratum, 10)
        self.assertAlmostEqual(told, time.time(), delta=5)
        self.assertIsNone(ntp.asked_of(network.post, hosts.BOX_DARPA), "on darpa0")
        self.shell("nft flush chain inet adit input; nft add chain inet adit input '{ policy accept; }'")
        self.assertIsNone(ntp.asked_of(network.post, hosts.BOX_DARPA), "on darpa0, where no firewall is")
        self.shell("systemctl restart adit-nftables.service")
        self.asks_for_ntp()
        programs.wait_until(lambda: not self.speaks_ntp(), "chronyd to be stopped", 60)
        self.assertIsNone(ntp.asked_of(network.team, network.box_address))
        self.assertNotIn("elements", self.shell("nft list set inet adit ntp_clients; nft list set inet adit ntp_servers"))

    def team_reaches(self, port):
        network = self.stage.network
        with contextlib.suppress(OSError):
            network.connect(network.team, network.box_address, port, 1).close()
            return True
        return False

    def test_added_port_is_opened_and_another_program_stays_closed(self):
        foreign = self.stage.network.made_in(f"../../proc/{self.box.leader()}/ns/net", lambda: socket.create_server(("0.0.0.0", 11311)))
        self.addCleanup(foreign.close)
        session = {**self.session, "Content-Type": "application/json"}
        for is_added in True, False:
            held = self.box.ask("GET /adit/settings", session, token=None)[1]
            listen = [each for each in held["settings"]["team"]["listen"] if each["port"] != 9000]
            held["settings"]["team"]["listen"] = [*listen, *([{"address": "0.0.0.0", "port": 9000}] if is_added else [])]
            self.asked("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})
            programs.wait_until(lambda is_added=is_added: self.team_reaches(9000) == is_added, "the port to follow the settings", 60)
            self.shell("systemctl restart adit-nftables.service")
            self.assertEqual((self.team_reaches(9000), self.team_reaches(80), self.team_reaches(11311)), (is_added, True, False))

    def moves_to(self, address, team):
        """Changes the team's side, and confirms at the box's new address."""
        self.asked("POST /adit/network", {**stage.NUMBERS, "team": team})
        self.stage.network.box_address = address
        programs.wait_until(lambda: self.reached(self.confirmed), f"the change to be confirmed at {address}", 60)

    @staticmethod
    def reached(asks):
        """Its answer; False while the box has another address."""
        try:
            return asks()
        except OSError:
            return False

    def shows_run(self):
        return self.reached(lambda: self.box.ask("GET /adit/run", timeout=5)[0] == 200)

    def dhcp(self, address):
        server = dhcp_server.Server(self.stage.network, self.stage.folder, address)
        self.addCleanup(server.stop)
        return server

    def test_dhcp_lease_is_obtained_renewed_lost_and_obtained_again(self):
        network = self.stage.network
        ear = eavesdropper.Eavesdropper(network, network.post)
        self.addCleanup(ear.close)
        server = self.dhcp("10.0.0.50")
        self.moves_to("10.0.0.50", {"mode": "dhcp"})
        given = server.given()
        programs.wait_until(lambda: server.given() > given + 1, "the lease to be renewed, twice", 60)
        self.assertTrue(self.shows_run())
        self.assertEqual(self.box.run("ip", "-4", "-o", "route", "show", "default").stdout, "", "no router is taken")
        server.stop()
        programs.wait_until(lambda: not self.shows_run(), "the lease to be lost", 60)
        asked = len(self.stage.post.requests("/api/status"))
        programs.wait_until(lambda: len(self.stage.post.requests("/api/status")) > asked, "the Command Post to be asked all the same", 60)
        self.dhcp("10.0.0.60")  # another base station
        network.box_address = "10.0.0.60"
        programs.wait_until(self.shows_run, "the page under the new address", 120)
        self.flows("/state/update", {"poses": [POSE]})
        self.moves_to(cables.FACTORY_ADDRESS, stage.NUMBERS["team"])
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        self.assertGreater(ear.count(), 0)
        self.assertEqual(ear.strangers(*stage.ENDPOINTS), [], "of all this nothing is on the Command Post's side")

    def spare(self):
        return self.asked("GET /adit/spare")

    def stick(self):
        return self.spare()["stick"]

    def wait_for_stick(self, condition, what):
        programs.wait_until(lambda: condition(self.stick()), what, 60)
        return self.stick()

    def test_its_export_goes_to_a_stick_and_comes_from_it(self):
        """With the units of the box. FAT, and unplugging at any time: applier/real_stick.py. A container has no udev, which would
        start and stop the stick's unit."""
        if not sticks.can_mount("ext4"):
            self.skipTest("nothing can be mounted here")
        stick = sticks.Stick(self.box, self.stage.folder, "stick")
        self.addCleanup(stick.pull)
        self.assertTrue(self.stick()["hindrance"], "there is no stick")
        self.asked("POST /adit/spare/standby")
        programs.wait_until(lambda: self.spare()["code"], "it to rest", 60)
        self.asked("POST /adit/spare/to-stick", status=409)
        stick.plug()
        self.wait_for_stick(lambda said: not said["hindrance"], "the stick to be found")
        self.asked("POST /adit/spare/to-stick")
        began = time.monotonic()
        name = self.wait_for_stick(lambda said: said["written"] or said["refusal"], "the export to be on the stick")["written"]
        note("container, from the press to the export on the stick, read back", f"{time.monotonic() - began:.1f} s")
        self.assertRegex(name, r"^adit-[0-9.]+-\d{8}T\d{6}Z\.adit-spare$", self.stick()["refusal"])
        kept = stick.as_it_is(name)  # pulled out at this very moment
        self.assertEqual(kept[:10], b"adit-spare")
        self.asked("POST /adit/spare/from-stick", {"name": name})
        programs.wait_until(lambda: self.spare()["asks_code"], f"the export to be read: {self.stick()}", 60)
        self.asked("POST /adit/spare/open", {"code": self.spare()["code"]}, status=409)  # it made the export itself
        self.asked("POST /adit/spare/forget")
        second = sticks.Stick(self.box, self.stage.folder, "second")
        self.addCleanup(second.pull)
        second.plug()
        self.wait_for_stick(lambda said: said["hindrance"], "the second stick to be found")
        self.asked("POST /adit/spare/to-stick", status=409)
        second.pull()
        self.wait_for_stick(lambda said: not said["hindrance"], "the second stick to be gone")
        stick.fill()
        self.wait_for_stick(lambda said: not said["hindrance"] and said["exports"], "the full stick to be found")
        self.asked("POST /adit/spare/to-stick")
        self.wait_for_stick(lambda said: said["refusal"] and not said["doing"], "a refusal")
        self.assertEqual(stick.as_it_is(name), kept, "what was there before is there still")
        self.asked("POST /adit/spare/resume")
        programs.wait_until(self.box.knows_the_run, "it to go on", 60)

    def test_settings_reports_and_journal_survive_a_boot(self):
        before = self.report_states()
        self.box.stop()
        self.stage.network.cable_the_box()
        self.box.start()
        self.assertEqual(self.report_states(), before)
        programs.wait_until(self.box.knows_the_run, "the Command Post to be heard again by the confirmed address", 60)
        boots = self.box.run("journalctl", "--list-boots", "-q", "--no-pager").stdout
        self.assertEqual(len(boots.splitlines()), 2, boots)
