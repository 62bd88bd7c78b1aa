"""The box between its two networks, like the appliance: a real systemd-networkd, the firewall, the kernel's settings."""

import json
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import requests

import capture
import hosts
import networkd
import programs
from programs import wait_until

SERVICES = pathlib.Path(os.environ["ADIT_SOURCE"]) / "services"
SYN_ACK = 0x12  # of a segment that takes a connection
SILENT_FOR = 1.5  # seconds, after which nobody answers any more
PORTS = [*range(1, 1200), 5353, 5355, 8000, 8080, 9100, 40000, 65535]


class Appliance(unittest.TestCase):
    """`numbers`: addresses that were confirmed before the box starts."""

    team_net = "192.168.7"
    post_address = hosts.BOX_DARPA  # of the box

    def setUp(self):
        networkd.needs_networkd()
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-appliance-")))
        self.folder.chmod(0o755)
        self.network = self.enterContext(hosts.Network(self.team_net))
        for port in ("team0", "darpa0"):
            self.in_box("ip", "address", "flush", "dev", port)
            self.in_box("ip", "link", "set", port, "down")
        source = capture.mac_of(self.network.box, "darpa0")
        self.heard = capture.Capture(self.network.post, "eth0", source)
        self.addCleanup(self.heard.stop)
        self.start_the_box()

    def in_box(self, *command):
        return subprocess.run(["ip", "netns", "exec", self.network.box, *map(str, command)], check=True, capture_output=True,
                              text=True).stdout

    def start_the_box(self):
        """In the order of the units: settings of the kernel, firewall, networkd's files, networkd, aditd."""
        self.in_box("sysctl", "-q", "-p", SERVICES / "adit.sysctl", SERVICES / "adit-appliance.sysctl")
        self.in_box("nft", "-D", 'others="drop"', "-f", SERVICES / "adit-nftables.conf")
        files = self.folder / "network"
        files.mkdir()
        self.box = networkd.AditNetwork(self.network, files)
        self.confirmed(self.box.numbers(self.network.box_address, self.post_address))
        programs.secrets_folder(self.folder / "secrets")
        self.box.start("--start")
        self.assertEqual(self.box.process.wait(programs.patient(5)), 0, self.box.output())
        self.networkd = networkd.Networkd(self.network, files)
        self.addCleanup(self.networkd.stop)
        wait_until(lambda: self.box.addresses("team0") and (self.box.addresses("darpa0") or not self.post_address),
                   "the addresses")
        self.post = self.command_post()
        (self.folder / "state").mkdir()
        self.aditd = programs.Box(self.network, self.folder, network__allow_overlap=True,
                                  team__listen=[{"address": "0.0.0.0", "port": programs.PORT}])
        self.addCleanup(lambda: self.aditd.stop())

    def command_post(self):
        post = programs.CommandPost(self.network, self.folder, "--rate", "0")
        self.addCleanup(post.stop)
        return post

    def confirmed(self, numbers):
        (self.folder / "network" / "state" / "confirmed.json").write_text(json.dumps({"format": 1, "numbers": numbers}))

    def connected(self):
        return all(each["connected"] for each in self.aditd.ask("GET /adit/run")[1]["endpoints"] if each["name"] == "scoring")

    def links(self):
        return {each["side"]: each["carrier"] for each in self.aditd.ask("GET /adit/run")[1]["links"]}

    def send_state(self):
        headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
        pose = {"name": "A", "position": {"x": 1, "y": 2, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
        state = {"header": {"stamp": time.time(), "frame_id": "darpa"}, "poses": [pose]}
        answer = requests.post(f"http://{self.network.box_address}:{programs.PORT}/state/update", json=state, headers=headers,
                               timeout=30)
        self.assertLess(answer.status_code, 300, answer.text)


class TwoNetworks(Appliance):
    def meant(self, frame):
        """Whether it is ARP between the two, or a segment to one of the two endpoints."""
        if frame.is_arp:
            return frame.arp[0] in ("0.0.0.0", hosts.BOX_DARPA) and frame.arp[1] in (
                hosts.SCORING, hosts.MAPPING, hosts.BOX_DARPA)
        ends = ((hosts.BOX_DARPA, hosts.SCORING, programs.PORT), (hosts.BOX_DARPA, hosts.MAPPING, programs.PORT))
        return frame.tcp in ends

    def assert_silent_else(self):
        frames = self.heard.since(0)
        self.assertTrue(any(frame.tcp for frame in frames), "the run was not heard at all")
        self.assertTrue(any(frame.is_arp for frame in frames))
        self.assertEqual([frame for frame in frames if not self.meant(frame)], [])

    def test_only_arp_and_tcp_to_the_endpoints_leave_by_darpa0(self):
        wait_until(self.connected, "the Command Post")
        self.send_state()
        wait_until(lambda: self.post.requests("/state/update"), "the state")
        self.network.pull_cable()
        wait_until(lambda: self.links() == {"team": True, "command_post": False}, "the cable to be seen out")
        self.assertIn("cable_out:command_post", self.aditd.alarms())
        time.sleep(2)
        self.network.pull_cable(False)
        wait_until(lambda: self.links()["command_post"], "the cable to be seen in")
        self.assertNotIn("cable_out:command_post", self.aditd.alarms())
        self.send_state()
        wait_until(lambda: len(self.post.requests("/state/update")) > 1, "the next state")
        self.assertEqual(self.networkd.reload().returncode, 0)
        self.aditd.stop()
        time.sleep(1)
        self.assert_silent_else()

    def test_no_host_on_the_command_post_side_gets_an_answer(self):
        wait_until(self.connected, "the Command Post")
        first = len(self.heard.frames)
        capture.scan(self.network.post, hosts.SCORING, hosts.BOX_DARPA, PORTS)
        capture.shout(self.network.post, "eth0", capture.mac_of(self.network.post, "eth0"))
        self.assertFalse(capture.answers_ping(self.network.post, hosts.BOX_DARPA, SILENT_FOR))
        for frame in self.heard.since(first, SILENT_FOR):
            self.assertTrue(self.meant(frame), frame)
        taken = [frame for frame in self.heard.since(first) if frame.tcp and frame.data[47] & SYN_ACK == SYN_ACK]
        self.assertEqual(taken, [], "no connection is taken")

    def test_neither_side_is_heard_or_reached_by_the_other(self):
        for host, port, gateway, target in ((self.network.team, "eth0", self.network.box_address, hosts.SCORING),
                                            (self.network.post, "eth0", hosts.BOX_DARPA, self.network.team_address)):
            net = target.rpartition(".")[0] + ".0/24"
            hosts.ip("-n", host, "route", "add", net, "via", gateway, "dev", port)
            with self.assertRaises(OSError):
                self.network.connect(host, target, programs.PORT, SILENT_FOR)
        # By the address of the other side, although this side's interface gets the packet.
        hosts.ip("-n", self.network.team, "route", "replace", hosts.BOX_DARPA, "via", self.network.box_address, "dev", "eth0")
        with self.assertRaises(OSError):
            self.network.connect(self.network.team, hosts.BOX_DARPA, programs.PORT, SILENT_FOR)
        asks = (self.network.post, "eth0")
        self.assertTrue(capture.answers_arp(*asks, hosts.BOX_DARPA))
        self.assertFalse(capture.answers_arp(*asks, self.network.box_address, SILENT_FOR), "that is an address of the other side")
        self.assertTrue(capture.answers_arp(self.network.team, "eth0", self.network.box_address))
        self.assertFalse(capture.answers_arp(self.network.team, "eth0", hosts.BOX_DARPA, SILENT_FOR))
        self.network.connect(self.network.team, self.network.box_address, programs.PORT, 30).close()

    def test_the_team_finds_the_box_without_its_address(self):
        """By its link-local address."""
        def link_local():
            shown = json.loads(self.in_box("ip", "-4", "-j", "address", "show", "dev", "team0"))
            return [each["local"] for each in shown[0]["addr_info"] if each["local"].startswith("169.254.")]
        address = wait_until(link_local, "a link-local address")[0]
        hosts.ip("-n", self.network.team, "address", "add", "169.254.7.7/16", "dev", "eth0")
        self.network.connect(self.network.team, address, programs.PORT, 30).close()
        self.assertTrue(capture.answers_ping(self.network.team, address))
        shown = self.aditd.ask("GET /adit/network")[1]["team"]
        self.assertEqual(shown["address"], self.network.box_address, "that is not the one to tell people")

class AsItComes(Appliance):
    """The Command Post's side has no address yet."""

    post_address = ()

    def test_no_frame_leaves_by_darpa0(self):
        wait_until(lambda: self.aditd.ask("GET /adit/run")[1]["endpoints"][0]["trouble"], "the Command Post to be missed")
        time.sleep(3)
        self.assertEqual(self.heard.since(0), [])


class Overlapping(Appliance):
    """Both sides have 10.100.1.0/24."""

    team_net = "10.100.1"

    def start_the_box(self):
        self.network.box_address, self.network.team_address = "10.100.1.11", "10.100.1.12"
        super().start_the_box()

    def test_each_message_takes_its_own_network(self):
        wait_until(self.connected, "the Command Post")
        self.send_state()
        wait_until(lambda: self.post.requests("/state/update"), "the state")
        # An unbound socket uses the team's network.
        self.assertTrue(capture.answers_ping(self.network.team, "10.100.1.11"))
        self.assertIn("dev team0", self.in_box("ip", "route", "get", "10.100.1.12"))
        self.assertIn("dev team0", self.in_box("ip", "route", "get", hosts.SCORING))
        self.assertIn("dev darpa0", self.in_box("ip", "route", "get", hosts.SCORING, "oif", "darpa0"))
        for frame in self.heard.since(0):
            self.assertTrue(frame.tcp or frame.is_arp, frame)
            self.assertNotIn("10.100.1.12", frame.arp if frame.is_arp else frame.tcp)
