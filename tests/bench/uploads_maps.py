"""The bodies that tests/bench/uploads posts: a cave's grid and a surveyed cloud of any size, the same each time."""

import array
import base64
import json
import math
import random

import cbor2

UNKNOWN, FREE, WALL = 255, 0, 100
POSE = {"position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}


def header(at):
    return {"stamp": float(at), "frame_id": "darpa"}


def cave(cells):
    """The side of a square with that many cells, and its cells: winding passages, rough walls, unknown rock."""
    chance, side = random.Random(4), math.isqrt(cells)
    passages = [[chance.randrange(side), chance.randrange(8, 60)] for _ in range(max(side // 120, 1))]
    rows = []
    for _ in range(side):
        row = bytearray([UNKNOWN]) * side
        for passage in passages:
            passage[0] = (passage[0] + chance.randrange(-2, 3)) % side
            passage[1] = min(max(passage[1] + chance.randrange(-1, 2), 4), 80)
            left, right = max(passage[0] - passage[1], 0), min(passage[0] + passage[1], side)
            row[left:right] = bytes([FREE]) * (right - left)
            for wall in (left, right - 1):
                row[wall:wall + 2] = bytes([WALL]) * len(row[wall:wall + 2])
        rows.append(bytes(row))
    return side, b"".join(rows)


def grid(side, data, at):
    info = {"resolution": 0.1, "width": side, "height": side, "origin": POSE}
    return {"type": "OccupancyGrid", "name": "r1", "msg": {"header": header(at), "info": info, "data": data}}


def base64_grid(megabytes):
    """JSON of that many megabytes, in base64."""
    side, cells = cave(int(megabytes * 750_000))
    return "application/json", lambda at: json.dumps(grid(side, base64.b64encode(cells).decode(), at)).encode()


def integers_grid(megabytes):
    """base64_grid()'s grid as a list of integers, as rospy writes it."""
    side, cells = cave(int(megabytes * 750_000))
    listed = json.dumps([cell if cell != UNKNOWN else -1 for cell in cells])
    return "application/json", lambda at: json.dumps(grid(side, "HERE", at)).replace('"HERE"', listed).encode()


def cbor_integers_grid(megabytes):
    """The same list in CBOR."""
    side, cells = cave(int(megabytes * 750_000))
    listed = cbor2.dumps([cell if cell != UNKNOWN else -1 for cell in cells])
    return "application/cbor", lambda at: cbor2.dumps(grid(side, "HERE", at)).replace(b"\x64HERE", listed)


def cloud(megabytes):
    """CBOR with that many megabytes of points, as a rotating scanner sees a passage."""
    chance, points = random.Random(5), array.array("f")
    for i in range(int(megabytes * 1e6) // 16):
        angle, along = i % 1800 * math.pi / 900, i // 1800 * 0.05
        distance = 2 + 0.3 * math.sin(3 * angle + along) + chance.uniform(-0.01, 0.01)
        points.extend((along, distance * math.cos(angle), distance * math.sin(angle), 100 * distance % 7))
    fields = [{"name": name, "offset": 4 * place, "datatype": 7, "count": 1} for place, name in enumerate(("x", "y", "z", "intensity"))]
    data = points.tobytes()
    msg = {"fields": fields, "is_bigendian": False, "point_step": 16, "row_step": len(data), "width": len(data) // 16, "height": 1,
           "is_dense": True, "data": data}
    return "application/cbor", lambda at: cbor2.dumps({"type": "PointCloud2", "name": "r1", "msg": {"header": header(at), **msg}})
