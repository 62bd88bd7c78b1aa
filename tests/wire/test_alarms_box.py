"""The alarm table: each condition of the box, its networks and who connects to it is made true on the real programs, is seen
everywhere (alarming.py), and is seen to go. What these hosts cannot make true is driven through the seam by which the real thing
comes: the files of adit-update and adit-network."""

import contextlib
import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time
import unittest
from unittest import mock

import hosts
import neighbour
import networkd
import programs
from alarming import WithAlarms
from filling import Filler
from networkd import AditNetwork
from programs import wait_until
from reporting import another, began, submit

PASSWORD = "a password of the team's"
CROWD, LOOKS = "192.168.7.21", "192.168.7.22"
TOKEN = f"Authorization: Bearer {programs.TEAM_TOKEN}\r\n"


def setUpModule():
    hosts.needs_namespaces()


class AlarmsOfTheBox(WithAlarms):
    def test_the_disk_is_nearly_full(self):
        stage = self.stage(disk="12m")
        filler = Filler(stage.box.state, leaves=512 << 10)
        self.sees(stage, "disk_full", "bad", "box", "The disk is nearly full")
        filler.make_room()
        self.goes(stage, "disk_full")

    def test_the_box_rests(self):
        stage = self.stage()
        self.assertEqual(stage.box.ask("POST /adit/spare/rest", body={})[0], 200)
        self.sees(stage, "rests", "bad", "box", "This box rests and sends nothing", "for its spare")
        self.assertEqual([alarm["id"] for alarm in self.view(stage)["alarms"]], ["rests"], "the only cause")
        wait_until(lambda: stage.box.ask("POST /adit/spare/wake", body={})[0] == 200, "it to be woken up")
        wait_until(lambda: self.view(stage)["lights"] and not self.alarm(stage, "rests"), "it to go on")
        began(stage)
        self.assertEqual(submit(stage).status_code, 201)

    def test_the_ledger_was_damaged(self):
        stage = self.stage()
        self.assertEqual(submit(stage).status_code, 201)
        self.assertEqual(stage.box.stop(), 0)
        ledger = stage.box.state / "ledger.sqlite"
        ledger.write_bytes(ledger.read_bytes()[:4096] + os.urandom(ledger.stat().st_size - 4096))
        for log in stage.box.state.glob("ledger.sqlite-*"):
            log.unlink()
        stage.restart_box()
        self.sees(began(stage), "ledger_damaged", "ask", "box", "The ledger was damaged")
        lost = next(each["id"] for each in self.view(stage)["alarms"] if each["id"].startswith("report_lost:"))
        self.sees(stage, lost, "ask", "box", "The ledger is not whole", "may be lost")
        self.assertEqual(stage.box.judge(int(lost.partition(":")[2]), "done")[0], 200)
        self.goes(stage, lost)
        self.gone_after_a_restart(stage, "ledger_damaged")

    def runtime(self, size="8m"):
        """A runtime folder that is a file system of its own, as with systemd."""
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-runtime-")))
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "adit-wire", folder], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", folder], check=False)
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=str(folder)))
        return folder

    def test_the_ledger_cannot_be_written(self):
        self.runtime()
        stage = self.stage(disk="12m")
        self.assertEqual(submit(stage).status_code, 201)
        filler = Filler(stage.box.state)
        for number in range(1, 500):  # what the ledger has of its own has room for some
            if submit(stage, another(number)).status_code != 201:
                break
        self.sees(stage, "ledger_unwritable", "bad", "box", "No report is taken", "the ledger cannot be written", light="health")
        filler.make_room()
        wait_until(lambda: submit(stage, another(number)).status_code == 201, "room to be found")
        self.goes(stage, "ledger_unwritable")

    def test_the_run_is_not_kept(self):
        stage = self.stage(disk="12m")
        filler = Filler(stage.box.state, leaves=2 << 20)
        self.sees(stage, "run_not_kept", "bad", "box", "The run's map is not kept", "will not outlive a restart")
        filler.make_room()
        self.goes(stage, "run_not_kept")

    def test_maps_and_states_cannot_be_kept(self):
        runtime = self.runtime("4m")
        stage = self.stage()
        filler = Filler(runtime)
        self.assertEqual(self.send_map(stage, "r1", 1, 100000).status_code, 503)
        self.sees(stage, "map_not_kept", "bad", "box", "The last map was not taken", panel=False)
        robot = self.robot(stage, "r1")
        self.sees(stage, "state_not_kept", "bad", "box", "States and markers are not taken", "they cannot be kept", panel=False)
        robot.quiet()
        filler.make_room()
        self.robot(stage, "r1")
        self.goes(stage, "state_not_kept")
        wait_until(lambda: self.send_map(stage, "r1", 1).status_code == 200, "a map to be taken")
        self.goes(stage, "map_not_kept")

    def test_a_cable_is_out_and_is_the_only_cause(self):
        stage = self.stage()
        stage.network.pull_cable()
        self.sees(stage, "cable_out:command_post", "bad", "network", "The Command Post's cable is out", "darpa0")
        wait_until(lambda: self.alarm(stage, "cable_out:command_post")["hides"] > 0, "the endpoints to be hidden")
        self.assertEqual(len(self.view(stage)["alarms"]), 1)
        stage.network.pull_cable(False)
        self.goes(stage, "cable_out:command_post")

    def test_no_token_is_set(self):
        stage = self.stage()
        (stage.folder / "secrets/mapping.token").unlink()
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": None})
        self.sees(stage, "no_token:mapping", "bad", "box", "No mapping token is set", "wait until one is")
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": programs.MAPPING_TOKEN})
        self.goes(stage, "no_token:mapping")

    def test_the_settings_were_taken_back(self):
        stage = self.stage()
        held = stage.box.ask("GET /adit/settings")[1]
        held["settings"]["team"]["listen"].append({"address": "192.168.99.99", "port": 1234})
        stage.box.apply("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})
        self.sees(stage, "settings_not_changed", "bad", "box", "The last change was taken back")
        stage.box.save(lambda settings: settings["reports"].update(near_metres=7))
        self.goes(stage, "settings_not_changed")

    # By adit-update's file: it needs an image with two slots.
    def tell_of_update(self, stage, **more):
        status = {"format": 1, "trouble": "", "running": {"compatible": "adit-x", "version": "1.2.0", "slot": "B", "other": "A"},
                  "nonce": "", "refusal": "", "doing": "", "progress": None,
                  "last": {"stage": "installed", "version": "1.2.0", "slot": "B", "boot": "b", "why": ""},
                  "trial": False, "stray": "", "stick": None, "stick_trouble": "", **more}
        folder = stage.folder / "update"
        folder.mkdir(exist_ok=True)
        (folder / "status.new").write_text(json.dumps(status))
        (folder / "status.new").rename(folder / "status.json")

    def test_an_update_is_on_trial(self):
        stage = self.stage()
        self.tell_of_update(stage, trial=True)
        self.sees(stage, "update_on_trial", "wait", "box", "Version 1.2.0 is on trial")
        self.tell_of_update(stage)
        self.goes(stage, "update_on_trial")

    def test_another_slot_runs_than_the_last_good_one(self):
        stage = self.stage()
        self.tell_of_update(stage, stray="A with 1.1.0 runs, and B with 1.2.0 was good last")
        self.sees(stage, "other_slot", "ask", "box", "Another slot is running", "B with 1.2.0 was good last")
        self.tell_of_update(stage)
        self.goes(stage, "other_slot")

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

    def test_no_token_is_set_at_all(self):
        stage = self.stage()
        operator = self.operator(stage)
        for token in (stage.folder / "secrets").glob("*.token"):
            token.unlink()
        for name in ("mapping", "scoring", "team"):
            status, said = stage.box.insist("POST /adit/tokens", operator, {"name": name, "token": None}, token=None)
            self.assertEqual(status, 200, said)

        def found():
            return next((each for each in stage.box.ask("GET /adit/run", operator, token=None)[1]["alarms"]
                         if each["id"] == "no_token:team"), None)

        alarm = wait_until(found, "no_token:team")
        self.assertEqual((alarm["severity"], alarm["side"], alarm["what"]), ("bad", "box", "No token is set at all"))
        self.blinks(stage, "attention")
        said = stage.box.insist("POST /adit/tokens", operator, {"name": "team", "token": programs.TEAM_TOKEN}, token=None)
        self.assertEqual(said[0], 200, said)
        wait_until(lambda: stage.box.ask("GET /adit/run")[0] == 200, "the token to be in use")
        self.goes(stage, "no_token:team")

    def operator(self, stage):
        """The headers of somebody who is logged in; he needs no token."""
        (stage.folder / "secrets/label.code").write_text("12345678\n")
        (stage.folder / "secrets/label.code").chmod(0o600)
        stage.box.stop()
        stage.restart_box()
        body = {"role": "operator", "code": "12345678", "password": PASSWORD}
        status, said = began(stage).box.ask("POST /adit/password", body=body, token=None)
        self.assertEqual(status, 200, said)
        return programs.log_in(stage.box, PASSWORD)

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

    def test_the_time_is_not_set(self):
        if not shutil.which("clang-19"):
            self.skipTest("clang-19 is not here")
        library = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()), "no_clock.so")
        subprocess.run(["clang-19", "-shared", "-fPIC", "-o", library, pathlib.Path(__file__).with_name("no_clock.c")], check=True)
        with mock.patch.dict(os.environ, LD_PRELOAD=str(library)):
            stage = self.stage()
        self.sees(stage, "time_not_set", "wait", "box", "The box's time is not set", "of a wrong day")
        self.gone_after_a_restart(stage, "time_not_set")

    def test_ntp_does_not_work(self):
        """On a machine that keeps its time by itself."""
        stage = self.stage(clock={"ntp_server": "192.168.7.5"})
        self.sees(stage, "ntp", "wait", "box", "NTP does not work", "keeps its time by itself")
        self.gone_after_a_restart(stage, "ntp", clock={"ntp_server": ""})

    @staticmethod
    def is_reached(stage):
        with contextlib.suppress(OSError):
            return stage.box.ask("GET /adit/run", timeout=2)[0] == 200
        return False

    def test_saved_settings_are_not_used(self):
        stage = self.stage()
        stage.box.save(lambda settings: settings["reports"].update(near_metres=7))
        self.assertEqual(stage.box.stop(), 0)
        (stage.box.state / "settings.json").write_text("{")
        stage.restart_box()
        self.sees(began(stage), "settings_not_used", "bad", "box", "The saved settings are not used", "are set aside")
        stage.box.save(lambda settings: settings["reports"].update(near_metres=8))
        self.goes(stage, "settings_not_used")

    def test_the_boards_file_is_not_used(self):
        stage = self.with_a_file("board.json", "{")
        self.sees(stage, "board_not_used", "bad", "box", "The board's file is not used")
        (stage.folder / "board.json").unlink()
        self.gone_after_a_restart(stage, "board_not_used")

    def test_the_lights_cannot_be_set(self):
        """The simulated panel's, while a folder stands in the way of its file."""
        stage = self.stage()
        obstacle = stage.box.state / "panel.new"
        obstacle.mkdir()
        self.assertEqual(stage.box.ask("POST /adit/identify", body={"seconds": 1})[0], 200)  # something to show
        self.sees(stage, "lights_not_set", "bad", "box", "The lights are not to be trusted", "Is a directory", panel=False)
        obstacle.rmdir()
        self.goes(stage, "lights_not_set")

    def test_whoever_started_the_box_left_a_notice(self):
        stage = self.with_a_file("notices/card", "the card's settings are not used\n")
        self.sees(stage, "notice:card", "bad", "box", "The box is not well", "the card's settings are not used")
        (stage.folder / "notices/card").unlink()
        self.goes(stage, "notice:card")

    def test_a_notice_is_left_while_it_runs(self):
        stage = began(self.stage())
        (stage.folder / "notices").mkdir(exist_ok=True)
        (stage.folder / "notices/disks").write_text("2 disks hold an Adit\n")
        self.sees(stage, "notice:disks", "bad", "box", "The box is not well", "2 disks hold an Adit")
        (stage.folder / "notices/disks").unlink()
        self.goes(stage, "notice:disks")

    def with_a_file(self, name, text):
        stage = self.stage()
        self.assertEqual(stage.box.stop(), 0)
        (stage.folder / name).parent.mkdir(exist_ok=True)
        (stage.folder / name).write_text(text)
        stage.restart_box()
        return began(stage)

    # By adit-network's file, which is that of test_network.py.
    def tell_of_network(self, stage, **more):
        status = {"version": 1, "team_interface": "team0", "command_post_interface": "darpa0",
                  "kept": AditNetwork.numbers(), "endpoints": [], "pending": None, "last": None, "last_nonce": "", "why": "", **more}
        folder = stage.folder / "network" / "status"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "status.new").write_text(json.dumps(status))
        (folder / "status.new").rename(folder / "status.json")

    def test_a_change_of_the_network_waits(self):
        stage = self.stage()
        until = time.clock_gettime_ns(time.CLOCK_MONOTONIC) // 1_000_000 + 60_000
        self.tell_of_network(stage, pending={"nonce": "0" * 32, "until_ms": until, "confirm_within_ms": 60000,
                                             "wanted": AditNetwork.numbers(team="192.168.8.11")})
        self.sees(stage, "network_change", "ask", "network", "A network change is waiting", "192.168.8.11")
        self.tell_of_network(stage)
        self.goes(stage, "network_change")

    def test_the_box_has_no_address_upstream(self):
        stage = self.stage()
        bare = {**AditNetwork.numbers(), "command_post": {"addresses": [], "gateway": ""}}
        self.tell_of_network(stage, kept=bare)
        self.sees(stage, "no_address", "bad", "box", "The box has no address upstream")
        self.tell_of_network(stage)
        self.goes(stage, "no_address")

    # Of a crowd it is told for a minute after the last one.
    def test_clients_are_refused(self):
        stage = self.stage(team__connections_per_address=4)
        hosts.ip("address", "add", f"{CROWD}/24", "dev", "eth0")
        with contextlib.ExitStack() as held:
            for _ in range(4):
                held.enter_context(self.begun(stage, "/map/update", TOKEN))
            wait_until(lambda: self.is_refused(stage), "a fifth to be refused")
        self.sees(stage, "clients_refused", "bad", "robot", "Clients are refused", f"most of {CROWD}")
        self.goes(stage, "clients_refused", 90)

    def is_refused(self, stage):
        with self.begun(stage, "/state/update", TOKEN) as more:
            more.settimeout(2)
            with contextlib.suppress(TimeoutError):
                return more.recv(100).startswith(b"HTTP/1.1 503")
        return False

    @staticmethod
    def begun(stage, path, headers):
        connection = socket.create_connection((stage.network.box_address, programs.PORT), 30, source_address=(CROWD, 0))
        connection.sendall(f"POST {path} HTTP/1.1\r\nHost: {stage.network.box_address}\r\nContent-Type: application/json\r\n{headers}"
                           "Content-Length: 1000\r\n\r\n{".encode())
        return connection

    def test_wrong_tokens_are_shown(self):
        stage = self.stage()
        self.assertEqual(stage.box.ask("GET /api/status", token="an-old-token")[0], 401)
        self.sees(stage, "wrong_tokens", "ask", "robot", "Wrong tokens are shown", stage.network.team_address)
        self.goes(stage, "wrong_tokens", 90)

    def test_too_many_strangers_are_connected(self):
        stage = self.stage()
        hosts.ip("address", "add", f"{CROWD}/24", "dev", "eth0")
        with contextlib.ExitStack() as held:
            for _ in range(40):
                held.enter_context(self.begun(stage, "/adit/login", ""))
            wait_until(lambda: self.alarm(stage, "strangers"), "strangers")
        self.sees(stage, "strangers", "wait", "robot", "Too many strangers are connected", CROWD)
        self.goes(stage, "strangers", 90)
