"""Hears every frame on the box's cable, and says what in it the box should not have said."""

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
    """On `eth0` of a namespace, from the moment it is made."""

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
        """What is neither ARP for IPv4 nor TCP to one of the endpoints, (address, port), one line for each kind."""
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
    source, target = (socket.inet_ntoa(frame[at:at + 4]) for at in (26, 30))
    if protocol not in (TCP, UDP):
        return f"IP protocol {protocol} from {source} to {target}"
    port = struct.unpack_from("!H", frame, 14 + length + 2)[0]
    if protocol == TCP and (target, port) in endpoints:
        return ""
    return f"{'TCP' if protocol == TCP else 'UDP'} from {source} to {target} port {port}"


def mdns_addresses(network, host, own_address, name="adit.local", within=3.0):
    """The IPv4 addresses that anybody on `eth0` of a namespace gives for a name by multicast DNS."""
    question = b"".join(bytes([len(part)]) + part.encode() for part in name.split(".")) + b"\0"
    asker = network.made_in(host, lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    with asker:
        asker.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        asker.bind(("", PORT_MDNS))
        group = socket.inet_aton("224.0.0.251")
        asker.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group + socket.inet_aton(own_address))
        asker.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(own_address))
        end, found = time.monotonic() + within, set()
        while time.monotonic() < end and not found:
            asker.sendto(struct.pack("!6H", 0, 0, 1, 0, 0, 0) + question + struct.pack("!2H", 1, 1), ("224.0.0.251", PORT_MDNS))
            asker.settimeout(0.5)
            try:
                while True:
                    answer, _ = asker.recvfrom(9000)
                    found |= addresses_in(answer, question)
            except TimeoutError:
                pass
        return found


def addresses_in(answer, question):
    """Of A records: a name (here uncompressed, and the only one), type 1, class 1 with or without "cache flush", ttl, 4 bytes."""
    if not answer[2] & 0x80:
        return set()  # a question
    found, at = set(), answer.find(question)
    while at >= 0:
        rest = at + len(question)
        kind, klass, _, size = struct.unpack_from("!HHIH", answer.ljust(rest + 14, b"\0"), rest)
        if (kind, klass & 0x7FFF, size) == (1, 1, 4):
            found.add(socket.inet_ntoa(answer[rest + 10:rest + 14]))
        at = answer.find(question, rest)
    return found
