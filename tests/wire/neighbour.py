"""Another host on one of the box's two cables, with its own kernel and MAC address. It shares the cable with the host at its end, as
behind a switch."""

import os
import socket
import struct
import subprocess

import capture
import hosts

EVERYBODY, NOBODY = b"\xff" * 6, "0.0.0.0"
ASKS = 1


def arp(mac, sender, about, operation=ASKS):
    """A broadcast frame."""
    return (EVERYBODY + mac + struct.pack("!HHHBBH", capture.ARP, 1, capture.IPV4, 6, 4, operation) + mac +
            socket.inet_aton(sender) + b"\0" * 6 + socket.inet_aton(about))


class Neighbour:
    """`host` is at the end of the cable of the box's `interface`. The neighbour's port has the same name."""

    count = 0

    def __init__(self, network, host, interface):
        Neighbour.count += 1
        self.network, self.host, self.port = network, host, interface
        self.name = f"adit{os.getpid()}n{Neighbour.count}"
        self.mac = ""

    def __enter__(self):
        hosts.ip("netns", "add", self.name)
        self.plug(self.host, self.port)
        self.mac = ":".join(f"{byte:02x}" for byte in capture.mac_of(self.name, self.port))
        return self

    def plug(self, host, port):
        """Plugs the neighbour into another host's cable as well."""
        made = f"n{Neighbour.count}{port}"
        hosts.ip("-n", host, "link", "add", "link", "eth0", "name", made, "type", "macvlan", "mode", "bridge")
        hosts.ip("-n", host, "link", "set", made, "netns", self.name, "name", port)
        hosts.ip("-n", self.name, "link", "set", port, "up")

    def __exit__(self, *_):
        subprocess.run(["ip", "netns", "delete", self.name], stderr=subprocess.DEVNULL, check=False)

    def has(self, address, port=None):
        """Adds an address as `ip address add` does: Linux announces it to no host."""
        hosts.ip("-n", self.name, "address", "add", f"{address}/24", "dev", port or self.port)

    def take(self, address):
        """Has the address and starts to communicate, so its kernel sends an ARP request."""
        self.has(address)
        with capture.inside(self.name), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as someone:
            someone.sendto(b"?", (address.rpartition(".")[0] + ".77", 9))

    def leave(self):
        hosts.ip("-n", self.name, "address", "flush", "dev", self.port)

    def says(self, sender, about, operation=ASKS, mac=None, port=None):
        """Sends ARP from that address, with this host's MAC address or the given one."""
        with capture.inside(self.name), capture.open_packets(port or self.port) as packets:
            own = mac or packets.getsockname()[4]
            packets.send(arp(own, sender, about, operation))
