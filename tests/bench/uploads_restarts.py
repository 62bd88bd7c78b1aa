"""The cost of a start after a kill until Adit listens, with and without queued maps."""

import base64
import json
import os
import random
import socket
import statistics
import subprocess

import uploads_maps
from uploads_both_ends import upload
from uploads_ways import Adit, free_port

# The number of queued grids and their cells.
QUEUES = {"no map": (0, 0), "40 grids of 6 MB": (40, 6_000_000), "500 grids of 400 bytes": (500, 400)}
HEAD = "| way | what waits | CPU ms until it listens | by so much the time without maps | us more for each map |"


def fill(way, count, cells):
    """Grids of two robots side by side, so that none replaces another."""
    if count == 0:
        return
    side, data = uploads_maps.cave(cells)
    text = base64.b64encode(data).decode()
    for number in range(count):
        message = uploads_maps.grid(side, text, number + 1)
        message["name"] = f"r{number % 2}"
        place = {"x": number * side * 0.1, "y": 0.0, "z": 0.0}
        message["msg"]["info"]["origin"] = uploads_maps.POSE | {"position": place}
        upload(way.port, "application/json", json.dumps(message).encode(), 100_000)


def kill(way):
    way.process.kill()
    way.process.wait()


def start(way):
    """The CPU time until it is ready, so that it listens."""
    address = way.folder / "notify"
    address.unlink(missing_ok=True)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as notify, open(way.folder / "log", "a", encoding="utf-8") as log:
        notify.bind(str(address))
        way.process = subprocess.Popen(way.process.args, stdout=log, stderr=log,
                                       env=os.environ | {"RUNTIME_DIRECTORY": str(way.folder), "NOTIFY_SOCKET": str(address)})
        while b"READY=1" not in notify.recv(4096):
            pass
        return way.cpu()


def queued(name, folder, program, count, cells):
    """Adit, killed with that many queued maps. Without a token it packs and sends none of them."""
    way = Adit(name, folder, free_port(), program)
    try:
        fill(way, count, cells)
    finally:
        kill(way)
    (way.folder / "secrets/mapping.token").unlink()
    return way


def play(programs, rounds, folder):
    print(f"\n**a start after a kill**, the median of {rounds}, beside each other\n\n{HEAD}\n|{' --- |' * (HEAD.count('|') - 1)}", flush=True)
    os.mkdir(folder)
    for name, program in programs.items():
        os.mkdir(f"{folder}/{name}")
        ways = {waits: queued(name, f"{folder}/{name}/{count}", program, count, cells)
                for waits, (count, cells) in QUEUES.items()}
        took = {waits: [] for waits in QUEUES}
        for number in range(rounds + 1):  # the first is not counted
            for waits in random.sample(list(QUEUES), len(QUEUES)):
                try:
                    took[waits] += [start(ways[waits])] if number else []
                finally:
                    kill(ways[waits])
        none = statistics.median(took["no map"])
        for waits, (count, _) in QUEUES.items():
            median = statistics.median(took[waits])
            more = f"{1000 * (median - none) / count:.1f}" if count else "-"
            print(f"| {name} | {waits} | {median:.1f} | {median / none:.2f} | {more} |", flush=True)
