"""Three hosts in network namespaces: the team, the box with its two interfaces, and the Command Post.

    team eth0 ---- team0 (box) darpa0 ---- eth0 Command Post (two addresses)

The test itself moves into the team's namespace, so that its sockets are a team's.
"""

import ctypes
import os
import socket
import subprocess
import unittest

CLONE_NEWNET = 0x40000000

SCORING = "10.100.1.200"
MAPPING = "10.100.1.201"
BOX_DARPA = "10.100.1.10"


class Network:
    """`team_net`: the first three numbers of the team's /24; "10.100.1" overlaps the Command Post's network."""

    def __init__(self, team_net="192.168.7"):
        prefix = f"adit{os.getpid()}"
        self.team, self.box, self.post = (f"{prefix}{letter}" for letter in "tbc")
        self.box_address = f"{team_net}.11"
        self.team_address = f"{team_net}.12"
        self.home = os.open("/proc/self/ns/net", os.O_RDONLY)

    def __enter__(self):
        try:
            self._make()
        except BaseException:
            self.__exit__()
            raise
        return self

    def _make(self):
        for name in (self.team, self.box, self.post):
            ip("netns", "add", name)
            ip("-n", name, "link", "set", "lo", "up")
        self.plug_team()
        self._cable(self.post, "eth0", [SCORING, MAPPING], self.box, "darpa0", [BOX_DARPA])
        enter(f"/run/netns/{self.team}")

    def plug_team(self):
        self._cable(self.team, "eth0", [self.team_address], self.box, "team0", [self.box_address])

    @staticmethod
    def _cable(left, left_port, left_addresses, right, right_port, right_addresses):
        ip("-n", left, "link", "add", left_port, "type", "veth", "peer", "name", right_port, "netns", right)
        for host, port, addresses in ((left, left_port, left_addresses), (right, right_port, right_addresses)):
            for address in addresses:
                ip("-n", host, "address", "add", f"{address}/24", "dev", port)
            ip("-n", host, "link", "set", port, "up")

    def pull_cable(self, pulled=True):
        """Unplugs the Command Post's cable, or plugs it in."""
        ip("-n", self.post, "link", "set", "eth0", "down" if pulled else "up")

    def exchange_cables(self):
        """Swaps the cables at the box: the team's is in darpa0 and the Command Post's in team0; or swaps them back."""
        ends = {self.team: [self.team_address], self.post: [SCORING, MAPPING]}
        for host in ends:
            ip("-n", host, "link", "set", "eth0", "name", "moved")
        for host, other in ((self.team, self.post), (self.post, self.team)):
            ip("-n", host, "link", "set", "moved", "netns", other, "name", "eth0")
        for host, addresses in ends.items():
            for address in addresses:
                ip("-n", host, "address", "add", f"{address}/24", "dev", "eth0")
            ip("-n", host, "link", "set", "eth0", "up")

    def start(self, host, *command, **options):
        return subprocess.Popen(["ip", "netns", "exec", host, *map(str, command)], **options)

    @staticmethod
    def made_in(host, make):
        """The result of `make()` in the namespace `host`, such as a socket of that host."""
        mine = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
        try:
            enter(f"/run/netns/{host}")
            return make()
        finally:
            enter(f"/proc/self/fd/{mine}")
            os.close(mine)

    @staticmethod
    def connect(host, address, port, within):
        """Opens a connection from the namespace `host`."""
        made = Network.made_in(host, socket.socket)
        try:
            made.settimeout(within)
            made.connect((address, port))
        except OSError:
            made.close()
            raise
        return made

    def __exit__(self, *_):
        enter(f"/proc/self/fd/{self.home}")
        for name in (self.team, self.box, self.post):
            subprocess.run(["ip", "netns", "delete", name], stderr=subprocess.DEVNULL, check=False)
        os.close(self.home)


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def enter(path):
    libc = ctypes.CDLL(None, use_errno=True)
    namespace = os.open(path, os.O_RDONLY)
    try:
        if libc.setns(namespace, CLONE_NEWNET) != 0:
            raise OSError(ctypes.get_errno(), f"setns {path}")
    finally:
        os.close(namespace)


def needs_root():
    """Skips if this process is not root, or is root only in the namespace of an ordinary user (../alone)."""
    if os.geteuid() != 0 or _ids()[1] != "0":
        raise unittest.SkipTest("needs root")


def needs_other_users():
    """Skips in the namespace of an ordinary user for whom ../alone got no ids of other users."""
    if _ids()[2:] == ["1"]:
        raise unittest.SkipTest("needs root, or newuidmap and a range in /etc/subuid: it starts a program as another user")


def _ids():
    with open("/proc/self/uid_map", encoding="ascii") as ids:
        return ids.read().split()
