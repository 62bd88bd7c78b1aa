"""Captures every frame on the box's cable, and reports those that the box should not have sent."""

import contextlib
import socket
import struct
import threading
import time

ALL_PROTOCOLS = 0x0003
OUTGOING = 4  # of Linux's packet types: what the namespace itself sends
ARP, IPV4, IPV6 = 0x0806, 0x0800, 0x86DD
TCP, UDP = 6, 17
PORT_MDNS = 5353


class Eavesdropper:
    """Listens on `eth0` of a namespace from its creation on."""

    def __init__(self, network, host):
        self.socket = network.made_in(host, on_eth0)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
        self.socket.settimeout(0.2)
        self.frames, self.ending = [], False  # (when, the first bytes) of those from the box
        self.thread = threading.Thread(target=self._hear, daemon=True)
        self.thread.start()

    def _hear(self):
        while not self.ending:
            try:
                frame, (_, _, kind, *_) = self.socket.recvfrom(128)
            except TimeoutError:
                continue
            except OSError:  # the port itself is gone
                return
            if kind != OUTGOING:
                self.frames.append((time.monotonic(), frame))

    def close(self):
        self.ending = True
        self.thread.join()
        self.socket.close()

    def strangers(self, *endpoints):
        """Frames other than ARP for IPv4 and TCP to an endpoint (address, port), one line for each kind."""
        return sorted({said for _, frame in self.frames if (said := stranger(frame, endpoints))})

    def count(self):
        return len(self.frames)


def on_eth0():
    made = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ALL_PROTOCOLS))
    made.bind(("eth0", ALL_PROTOCOLS))
    return made


def stranger(frame, endpoints):
    ethertype = struct.unpack_from("!H", frame, 12)[0]
    if ethertype == ARP:
        return ""
    if ethertype == IPV6:
        return f"IPv6, next header {frame[20]}, to {socket.inet_ntop(socket.AF_INET6, frame[38:54])}"
    if ethertype != IPV4:
        return f"Ethernet type {ethertype:#06x} to {frame[:6].hex(':')}"
    protocol, length = frame[23], (frame[14] & 0x0F) * 4
    source, target = (socket.inet_ntoa(frame[at : at + 4]) for at in (26, 30))
    if protocol not in (TCP, UDP):
        return f"IP protocol {protocol} from {source} to {target}"
    port = struct.unpack_from("!H", frame, 14 + length + 2)[0]
    if protocol == TCP and (target, port) in endpoints:
        return ""
    return f"{'TCP' if protocol == TCP else 'UDP'} from {source} to {target} port {port}"


def mdns_addresses(network, host, own_address, name="adit.local", within=3.0):
    """The IPv4 addresses that hosts on `eth0` of a namespace answer for a name by multicast DNS."""
    question = b"".join(bytes([len(part)]) + part.encode() for part in name.split(".")) + b"\0"
    asker = network.made_in(host, lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    with asker:
        asker.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        asker.bind(("", PORT_MDNS))
        group = socket.inet_aton("224.0.0.251")
        asker.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group + socket.inet_aton(own_address))
        asker.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(own_address))
        asker.settimeout(0.5)
        end, found = time.monotonic() + within, set()
        while time.monotonic() < end:
            asker.sendto(
                struct.pack("!6H", 0, 0, 1, 0, 0, 0) + question + struct.pack("!2H", 1, 1), ("224.0.0.251", PORT_MDNS)
            )
            with contextlib.suppress(TimeoutError):
                while time.monotonic() < end:
                    found |= addresses_in(asker.recv(9000), name)
        return found


def addresses_in(message, name):
    """The addresses in A records of that name in a DNS message (RFC 1035, 4.1), if it is an answer."""
    _, flags, questions, *records = struct.unpack_from("!6H", message)
    if not flags & 0x8000:
        return set()
    at, found = 12, set()
    for _ in range(questions):
        at = name_at(message, at)[1] + 4
    for _ in range(sum(records)):
        owner, at = name_at(message, at)
        kind, klass, _, size = struct.unpack_from("!HHIH", message, at)
        at += 10 + size
        if (owner.lower(), kind, klass & 0x7FFF, size) == (name, 1, 1, 4):  # the bit above: "forget what you knew"
            found.add(socket.inet_ntoa(message[at - 4 : at]))
    return found


def name_at(message, at):
    """A name and its end. A part of it may be a pointer to an earlier place."""
    parts, end = [], None
    while message[at]:
        if message[at] >= 0xC0:
            end = end or at + 2
            at = struct.unpack_from("!H", message, at)[0] & 0x3FFF
        else:
            parts.append(message[at + 1 : at + 1 + message[at]].decode(errors="replace"))
            at += 1 + message[at]
    return ".".join(parts), end or at + 1
