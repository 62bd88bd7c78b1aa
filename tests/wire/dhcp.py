"""A DHCP server (RFC 2131) with one address to give, and with a router, a name server and a clock that nobody is to take."""

import contextlib
import socket
import struct
import threading

import capture

DISCOVER, OFFER, REQUEST, ACK = 1, 2, 3, 5
MAGIC = b"\x63\x82\x53\x63"


def option(number, value):
    return bytes([number, len(value)]) + value


def options_in(packet):
    found, rest = {}, packet[240:]
    while rest and rest[0] != 255:
        if rest[0] == 0:
            rest = rest[1:]
            continue
        found[rest[0]] = rest[2:2 + rest[1]]
        rest = rest[2 + rest[1]:]
    return found


class Server:
    """At `port` of `host`: gives `address`/24 to whoever asks, for an hour."""

    def __init__(self, host, port, own, address):
        self.own, self.address = socket.inet_aton(own), socket.inet_aton(address)
        self.stopping = threading.Event()
        with capture.inside(host):
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, port.encode())
            self.socket.bind(("", 67))
        self.socket.settimeout(0.1)
        self.thread = threading.Thread(target=self._serve)
        self.thread.start()

    def _serve(self):
        while not self.stopping.is_set():
            with contextlib.suppress(TimeoutError):
                packet = self.socket.recv(2048)
                said = options_in(packet).get(53, b"\0")[0]
                if said in (DISCOVER, REQUEST):
                    self.socket.sendto(self._answer(packet, OFFER if said == DISCOVER else ACK), ("255.255.255.255", 68))

    def _answer(self, packet, what):
        head = struct.pack("!BBBB4sHH4s4s4s4s16s", 2, 1, 6, 0, packet[4:8], 0, 0x8000, b"\0" * 4, self.address, self.own,
                           b"\0" * 4, packet[28:44])
        given = {53: bytes([what]), 54: self.own, 51: struct.pack("!I", 3600), 1: socket.inet_aton("255.255.255.0"),
                 3: self.own, 6: self.own, 42: self.own, 12: b"taken", 121: b"\x08\x0a" + self.own}
        return head + b"\0" * 192 + MAGIC + b"".join(option(*each) for each in given.items()) + b"\xff"

    def stop(self):
        self.stopping.set()
        self.thread.join()
        self.socket.close()
