#!/usr/bin/python3
"""ADIT_TOKEN=... example.py http://10.0.0.1:8000 report 10.5 -3.25 0.4 Backpack (or: status, map, state, markers; with --bare
for a Command Post without Adit). Prints the answer. Exit status: 1 if the message was rejected, 2 if the words are wrong, 3 if a
person must decide."""
import base64
import gzip
import json
import os
import sys
import time

from client import Client, Refused, Unknown

POSE = {"position": {"x": 1.0, "y": 2.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}


def header():
    return {"stamp": time.time(), "frame_id": "darpa"}


def a_map():
    cells = bytes([0, 0, 100, 255] * 3)  # free, free, occupied, unknown: row by row from the lower left
    info = {"resolution": 0.1, "width": 4, "height": 3, "origin": POSE}
    data = base64.b64encode(gzip.compress(cells)).decode()
    return {"type": "OccupancyGrid", "name": "r1",
            "msg": {"header": header(), "info": info, "data": data, "compression": "gzip"}}


def a_state():
    return {"header": header(), "poses": [{"name": "r1", **POSE}]}


def some_markers():
    ball = {"header": header(), "ns": "artifacts", "id": 1, "type": 2, "action": 0, "pose": POSE,
            "scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0}}
    return {"markers": [ball]}


UPDATES = {"map": a_map, "state": a_state, "markers": some_markers}


def main(url, what, *words, bare=False):
    client = Client(url, os.environ["ADIT_TOKEN"], bare)
    if what == "status":
        return client.status()
    if what == "report":
        x, y, z = map(float, words[:3])
        return client.report(x, y, z, words[3])
    return client.update(what, UPDATES[what]())


def fault_in(words):
    """A sentence about wrong words or a missing token, or nothing."""
    if not os.environ.get("ADIT_TOKEN"):
        return "the variable ADIT_TOKEN is not set"
    if len(words) < 2 or not words[0].startswith("http"):
        return "expected a URL that begins with http://, and what to send"
    if words[1] != "report":
        return "" if words[1] in ("status", *UPDATES) else f"expected report, status, map, state or markers, got {words[1]}"
    try:
        _, _, _, kind = *map(float, words[2:5]), *words[5:]
    except ValueError:
        return f"report: expected the numbers X Y Z and one word for the type, got {words[2:]}"
    return "" if kind else "report: expected a type"


if __name__ == "__main__":
    given = [word for word in sys.argv[1:] if word != "--bare"]
    if fault := fault_in(given):
        usage = "usage: ADIT_TOKEN=... example.py URL report X Y Z TYPE (or: status, map, state, markers) [--bare]"
        print(f"{fault}\n{usage}", file=sys.stderr)
        sys.exit(2)
    try:
        print(json.dumps(main(*given, bare="--bare" in sys.argv)))
    except Refused as why:
        sys.exit(f"refused: {why}")
    except Unknown as why:
        print(f"not known: {why}", file=sys.stderr)
        sys.exit(3)
