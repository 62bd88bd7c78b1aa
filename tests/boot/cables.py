"""The box's two cables: each port of the machine is connected to `eth0` of a namespace, the team's or the Command Post's."""

import fcntl
import os
import select
import socket
import struct
import time

import hosts

TUNSETIFF = 0x400454CA
IFF_TAP, IFF_NO_PI, IFF_VNET_HDR = 0x0002, 0x1000, 0x4000
FACTORY_ADDRESS = "10.0.0.1"  # of the box, as services/network.json has it
TEAM_ADDRESS = "10.0.0.12"


class Cables(hosts.Network):
    """The wire tests' three hosts, but the box is a separate machine. `ports` are its ports: team0, darpa0."""

    def __init__(self):
        super().__init__("10.0.0")
        self.box_address, self.team_address = FACTORY_ADDRESS, TEAM_ADDRESS
        self.ports = []

    def _make(self):
        for name in (self.team, self.box, self.post):
            hosts.ip("netns", "add", name)
            hosts.ip("-n", name, "link", "set", "lo", "up")
        for host, addresses in ((self.team, [self.team_address]), (self.post, [hosts.SCORING, hosts.MAPPING])):
            hosts.enter(f"/run/netns/{host}")
            self.ports.append(tap("eth0"))
            for address in addresses:
                hosts.ip("address", "add", f"{address}/24", "dev", "eth0")
            hosts.ip("link", "set", "eth0", "up")
        hosts.enter(f"/run/netns/{self.team}")

    def open_ports(self, host, address, ports, within=4.0):
        """The TCP ports at which `host` gets an answer."""
        waiting = select.poll()
        tried = {}
        try:
            for port in ports:
                made = self.made_in(
                    host, lambda: socket.socket(socket.AF_INET, socket.SOCK_STREAM | socket.SOCK_NONBLOCK)
                )
                tried[made.fileno()] = made, port
                made.connect_ex((address, port))
                waiting.register(made, select.POLLOUT)
            end, found = time.monotonic() + within, []
            while tried and time.monotonic() < end:
                for number, _ in waiting.poll(100):
                    made, port = tried.pop(number)
                    waiting.unregister(made)
                    if made.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) == 0:
                        found.append(port)
                    made.close()
            return found
        finally:
            for made, _ in tried.values():
                made.close()

    def __exit__(self, *reason):
        for port in self.ports:
            os.close(port)
        self.ports = []
        super().__exit__(*reason)


def tap(name):
    """Makes a port in this namespace, and returns the descriptor of the other end of its cable."""
    end = os.open("/dev/net/tun", os.O_RDWR | os.O_CLOEXEC)
    fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TAP | IFF_NO_PI | IFF_VNET_HDR))
    return end
