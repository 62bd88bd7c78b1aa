"""Measures the round trip of a small packet to the Command Post, and the traffic. `echo ADDRESS PORT` answers. `ask ADDRESS PORT
DEVICE` sends every 10 ms until its end, and then prints [[seconds, round trip in seconds], ...] and [[seconds, bytes sent], ...] as
JSON."""

import contextlib
import json
import select
import signal
import socket
import sys
import time

STEP = 0.01  # seconds


def echo(where):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as server:
        server.bind(where)
        while True:
            server.sendto(*server.recvfrom(64))


def sent_by(device):
    with open("/proc/self/net/dev", encoding="ascii") as file:
        for line in file:
            name, _, counts = line.partition(":")
            if name.strip() == device:
                return int(counts.split()[8])
    raise RuntimeError(f"no {device} here")


def ask(where, device):
    delays, sent = [], []
    ends = []
    signal.signal(signal.SIGTERM, lambda *_: ends.append(True))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.connect(where)
        until = time.monotonic()
        while not ends:
            with contextlib.suppress(ConnectionRefusedError):  # nobody answers there yet
                client.send(repr(time.monotonic()).encode())
            sent.append((time.monotonic(), sent_by(device)))
            until += STEP
            while (left := until - time.monotonic()) > 0:
                with contextlib.suppress(ConnectionRefusedError):
                    if select.select([client], [], [], left)[0]:
                        began = float(client.recv(64))
                        delays.append((began, time.monotonic() - began))
    print(json.dumps({"delays": delays, "sent": sent}), flush=True)


address = (sys.argv[2], int(sys.argv[3]))
if sys.argv[1] == "echo":
    echo(address)
else:
    ask(address, sys.argv[4])
