"""Captures every frame that leaves an interface, at the host on the other end of its cable."""

import contextlib
import ctypes
import os
import socket
import struct
import threading
import time

import hosts

ALL = 3  # ETH_P_ALL
ARP, IPV4, TCP = 0x0806, 0x0800, 6


@contextlib.contextmanager
def inside(host):
    """Runs this thread in the namespace `host`."""
    mine = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
    try:
        hosts.enter(f"/run/netns/{host}")
        yield
    finally:
        hosts.enter(f"/proc/self/fd/{mine}")
        os.close(mine)


def mac_of(host, port):
    with inside(host), open_packets(port) as packets:
        return packets.getsockname()[4]


def open_packets(port):
    packets = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ALL))
    packets.bind((port, ALL))
    return packets


def only_from(source, packets):
    """Lets the kernel drop frames of other MAC addresses, because a scan would fill the socket's buffer with its own frames."""
    begins, ends = struct.unpack("!HI", source)
    load, load_half, is_equal, give = 0x20, 0x28, 0x15, 0x06  # classic BPF
    code = [(load, 0, 0, 8), (is_equal, 0, 3, ends), (load_half, 0, 0, 6), (is_equal, 0, 1, begins), (give, 0, 0, 65536), (give, 0, 0, 0)]
    program = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *each) for each in code))
    packets.setsockopt(socket.SOL_SOCKET, 26, struct.pack("HP", len(code), ctypes.addressof(program)))  # SO_ATTACH_FILTER


class Frame:
    """An Ethernet frame. Its text identifies it."""

    def __init__(self, data):
        self.data, self.source = data, data[6:12]
        self.kind = struct.unpack("!H", data[12:14])[0]

    @property
    def is_arp(self):
        return self.kind == ARP

    @property
    def arp(self):
        """The sender's and the target's address of an ARP frame."""
        return socket.inet_ntoa(self.data[28:32]), socket.inet_ntoa(self.data[38:42])

    @property
    def tcp(self):
        """(from, to, port) of a TCP segment; None for other frames."""
        if self.kind != IPV4 or self.data[23] != TCP:
            return None
        size = (self.data[14] & 15) * 4
        return (socket.inet_ntoa(self.data[26:30]), socket.inet_ntoa(self.data[30:34]),
                struct.unpack("!H", self.data[14 + size + 2:14 + size + 4])[0])

    def __repr__(self):
        return f"{self.kind:04x} {self.arp if self.is_arp else self.tcp or self.data[14:60].hex()}"


class Capture:
    """All frames from `source` that arrive at `port` of `host`."""

    def __init__(self, host, port, source):
        self.frames, self.stopping = [], threading.Event()
        with inside(host):
            self.packets = open_packets(port)
        only_from(source, self.packets)
        self.packets.settimeout(0.1)
        self.thread = threading.Thread(target=self._listen)
        self.thread.start()

    def _listen(self):
        while not self.stopping.is_set():
            with contextlib.suppress(TimeoutError, OSError):
                data, (_, _, direction, _, _) = self.packets.recvfrom(65536)
                if direction != socket.PACKET_OUTGOING:
                    self.frames.append(Frame(data))

    def since(self, first, settle=0.5):
        """The frames after the first `first`, once frames in flight have arrived."""
        time.sleep(settle)
        return self.frames[first:]

    def stop(self):
        self.stopping.set()
        self.thread.join()
        self.packets.close()


def checksum(data):
    data += b"\0" * (len(data) % 2)
    total = sum(struct.unpack(f"!{len(data) // 2}H", data))
    while total >> 16:
        total = (total & 0xffff) + (total >> 16)
    return ~total & 0xffff


def syn(source, target, port):
    """A segment that opens a connection, for a raw socket."""
    head = struct.pack("!HHIIBBHHH", 40000, port, 1, 0, 5 << 4, 2, 64240, 0, 0)
    pseudo = socket.inet_aton(source) + socket.inet_aton(target) + struct.pack("!BBH", 0, TCP, len(head))
    return head[:16] + struct.pack("!H", checksum(pseudo + head)) + head[18:]


def scan(host, source, target, ports):
    """Tries each port, by TCP and by UDP."""
    with inside(host):
        tcp = socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_TCP)
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    with tcp, udp:
        for knocker in (tcp, udp):
            knocker.bind((source, 0))
        for port in ports:
            tcp.sendto(syn(source, target, port), (target, 0))
            udp.sendto(b"?", (target, port))


def shout(host, port, source_mac):
    """Queries that a network may send to all hosts: multicast groups, neighbours, names, routers."""
    every = {
        "IGMP": (b"\x01\x00\x5e\x00\x00\x01", IPV4, _ip("10.100.1.200", "224.0.0.1", 2, b"\x11\x64\xee\x9b\0\0\0\0")),
        "mDNS": (b"\x01\x00\x5e\x00\x00\xfb", IPV4, _udp("10.100.1.200", "224.0.0.251", 5353, DNS)),
        "LLMNR": (b"\x01\x00\x5e\x00\x00\xfc", IPV4, _udp("10.100.1.200", "224.0.0.252", 5355, DNS)),
        "DHCP": (b"\xff" * 6, IPV4, _udp("10.100.1.200", "255.255.255.255", 68, b"\x02\x01\x06\0" + b"\0" * 300)),
        "ping to all": (b"\xff" * 6, IPV4, _ip("10.100.1.200", "10.100.1.255", 1, b"\x08\0\xf7\xfe\0\1\0\0")),
        "IPv6 neighbours": (b"\x33\x33\0\0\0\x01", 0x86dd, _ipv6(b"\x80\0\0\0\0\1\0\1")),
        "IPv6 groups": (b"\x33\x33\0\0\0\x01", 0x86dd, _ipv6(b"\x82\0\0\0\x27\x10\0\0" + b"\0" * 16)),
    }
    with inside(host), open_packets(port) as packets:
        for target, kind, payload in every.values():
            packets.send(target + source_mac + struct.pack("!H", kind) + payload)


def answers_ping(host, target, within=10.0):
    """Sends an echo request. Returns whether a reply came."""
    with inside(host):
        pinger = socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_ICMP)
    with pinger:
        pinger.settimeout(within)
        pinger.sendto(b"\x08\0\xf7\xfd\0\1\0\1", (target, 0))
        with contextlib.suppress(TimeoutError):
            while True:
                packet, (source, _) = pinger.recvfrom(2048)
                if source == target and packet[20] == 0:
                    return True
    return False


def answers_arp(host, port, target, within=10.0):
    """Whether a host on that cable answers that it has the address."""
    with inside(host), open_packets(port) as packets:
        own = packets.getsockname()[4]
        ask = struct.pack("!HHBBH", 1, IPV4, 6, 4, 1) + own + b"\0" * 4 + b"\0" * 6 + socket.inet_aton(target)
        packets.send(b"\xff" * 6 + own + struct.pack("!H", ARP) + ask)
        end = time.monotonic() + within
        while (left := end - time.monotonic()) > 0:
            packets.settimeout(left)
            with contextlib.suppress(TimeoutError):
                frame = Frame(packets.recv(2048))
                if frame.is_arp and frame.source != own and frame.arp[0] == target:
                    return True
    return False


DNS = b"\0\0\0\0\0\1\0\0\0\0\0\0\x04adit\x05local\0\0\1\0\1"


def _ip(source, target, protocol, payload):
    head = struct.pack("!BBHHHBBH4s4s", 0x45, 0, 20 + len(payload), 1, 0, 1, protocol, 0, socket.inet_aton(source),
                       socket.inet_aton(target))
    return head[:10] + struct.pack("!H", checksum(head)) + head[12:] + payload


def _udp(source, target, port, payload):
    return _ip(source, target, 17, struct.pack("!HHHH", port, port, 8 + len(payload), 0) + payload)


def _ipv6(icmp):
    source, target = socket.inet_pton(socket.AF_INET6, "fe80::1"), socket.inet_pton(socket.AF_INET6, "ff02::1")
    sum_over = checksum(source + target + struct.pack("!IBBBB", len(icmp), 0, 0, 0, 58) + icmp)
    return struct.pack("!IHBB", 6 << 28, len(icmp), 58, 255) + source + target + icmp[:2] + struct.pack("!H", sum_over) + icmp[4:]
