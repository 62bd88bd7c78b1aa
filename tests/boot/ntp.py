"""NTP (RFC 5905) of other hosts: a server with any time or none, and a client."""

import contextlib
import socket
import struct
import threading
import time

from hosts import Network

PORT = 123
SINCE_1900 = 2208988800  # seconds from then to 1970
PACKET = struct.Struct("!BBbbIIIQQQQ")
CLIENT, SERVER, VERSION = 3, 4, 4 << 3


def stamp(seconds):
    """An NTP time stamp: seconds in 32 bits, which wrap in 2036, and 32 bits of fraction."""
    return int((seconds + SINCE_1900) * 2**32) % 2**64


class Server:
    """A server in the namespace `host`, `ahead` seconds ahead of this machine's clock; None: it does not answer."""

    def __init__(self, host, address, ahead=0.0):
        self.ahead, self.asked = ahead, 0
        self.socket = Network.made_in(host, lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        self.socket.bind((address, PORT))
        self.thread = threading.Thread(target=self._serve, daemon=True)
        self.thread.start()

    def _serve(self):
        with contextlib.suppress(OSError):
            while True:
                asked, who = self.socket.recvfrom(512)
                if len(asked) < PACKET.size or asked[0] & 7 != CLIENT or self.ahead is None:
                    continue
                self.asked += 1
                now = stamp(time.time() + self.ahead)
                sent = PACKET.unpack(asked[: PACKET.size])[-1]
                self.socket.sendto(PACKET.pack(VERSION | SERVER, 2, 3, -20, 0, 64, 0x7F000001, now, sent, now, now), who)

    def close(self):
        with contextlib.suppress(OSError):
            self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()
        self.thread.join(5)


def asked_of(host, address, within=1.0):
    """The answer to a client in the namespace `host`: stratum and seconds since 1970; None: no answer, or not synchronised."""
    with Network.made_in(host, lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as client:
        client.settimeout(within)
        with contextlib.suppress(OSError):
            client.sendto(PACKET.pack(VERSION | CLIENT, 0, 3, -20, 0, 0, 0, 0, 0, 0, stamp(time.time())), (address, PORT))
            told = PACKET.unpack(client.recv(512)[: PACKET.size])
            leap, stratum, sent = told[0] >> 6, told[1], told[-1]
            return None if leap == 3 else (stratum, sent / 2**32 - SINCE_1900)
    return None
