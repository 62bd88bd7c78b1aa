"""Maps to send: recorded ones from the directory in ADIT_MAPS, and generated ones."""

import dataclasses
import math
import os
import pathlib
import random
import re
import struct

RECORDED = os.environ.get("ADIT_MAPS")
IDENTITY = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}


@dataclasses.dataclass
class Grid:
    """Cells row by row from the lower left, 0 to 100 or 255."""

    label: str
    width: int
    height: int
    resolution: float
    origin: tuple
    cells: bytes

    type = "OccupancyGrid"

    @property
    def data(self):
        return self.cells

    def head(self):
        x, y, z = self.origin
        return {"info": {"resolution": self.resolution, "width": self.width, "height": self.height,
                         "origin": {"position": {"x": x, "y": y, "z": z}, "orientation": dict(IDENTITY)}}}


@dataclasses.dataclass
class Cloud:
    label: str
    fields: list
    point_step: int
    data: bytes
    is_bigendian: bool = False

    type = "PointCloud2"

    def head(self):
        return {"fields": self.fields, "is_bigendian": self.is_bigendian, "point_step": self.point_step}


def field(name, offset, datatype, count=1):
    return {"name": name, "offset": offset, "datatype": datatype, "count": count}


def read_grid(path, resolution=0.05):
    """A PGM as map_saver writes it: 0 occupied, 254 free, 205 unknown; a grid's first row is the picture's last."""
    content = path.read_bytes()
    header = re.match(rb"P5\s+(?:#.*\s+)*(\d+)\s+(?:#.*\s+)*(\d+)\s+(?:#.*\s+)*(\d+)\s", content)
    width, height = int(header[1]), int(header[2])
    pixels = content[header.end():][: width * height]
    scale = bytes(255 if value == 205 else round((255 - value) * 100 / 255) for value in range(256))
    rows = [pixels[row * width:(row + 1) * width] for row in range(height)]
    return Grid(path.stem, width, height, resolution, (-12.5, 3.25, 0.0), b"".join(reversed(rows)).translate(scale))


PCD_TYPES = {("F", 4): 7, ("F", 8): 8, ("U", 1): 2, ("U", 2): 4, ("U", 4): 6, ("I", 4): 5}
PLY_TYPES = {"float": (7, 4), "float32": (7, 4), "double": (8, 8), "uchar": (2, 1), "uint": (6, 4), "int": (5, 4)}


def read_pcd(path):
    content = path.read_bytes()
    end = content.index(b"DATA binary") + len(b"DATA binary\n")
    head = {words[0]: words[1:] for words in (line.split() for line in content[:end].decode().splitlines()) if words}
    fields, offset = [], 0
    for name, size, kind, count in zip(head["FIELDS"], head["SIZE"], head["TYPE"], head["COUNT"]):
        fields.append(field(name, offset, PCD_TYPES[kind, int(size)], int(count)))
        offset += int(size) * int(count)
    return Cloud(path.stem, fields, offset, content[end:][: offset * int(head["POINTS"][0])])


def read_ply(path):
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    fields, offset, points = [], 0, 0
    for words in (line.split() for line in content[:end].decode().splitlines()):
        if words[:2] == ["element", "vertex"]:
            points = int(words[2])
        if words[0] == "property":
            datatype, size = PLY_TYPES[words[1]]
            fields.append(field(words[2], offset, datatype))
            offset += size
    return Cloud(path.stem, fields, offset, content[end:][: offset * points])


def recorded():
    """Every recorded map, the largest last; empty if ADIT_MAPS is not set."""
    if not RECORDED:
        return []
    folder = pathlib.Path(RECORDED)
    found = [read_grid(path) for path in sorted(folder.glob("grids/*.pgm"))]
    found += [read_pcd(path) for path in sorted(folder.glob("clouds/*.pcd"))]
    found += [read_ply(path) for path in sorted(folder.glob("clouds/*.ply"))]
    return sorted(found, key=lambda item: len(item.data))


def made_grid(width, height, seed=1):
    """Generated rooms and corridors: runs of free, occupied and unknown cells."""
    chance = random.Random(seed)
    cells = bytearray()
    while len(cells) < width * height:
        cells += bytes([chance.choice([0, 0, 0, 100, 255, 255, chance.randint(1, 99)])]) * chance.randint(1, 40)
    return Grid(f"made_{width}x{height}", width, height, 0.1, (chance.uniform(-50, 50), 1.0, 0.5),
                bytes(cells[: width * height]))


XYZ = [field("x", 0, 7), field("y", 4, 7), field("z", 8, 7)]


def made_cloud(points, seed=1):
    """The wall of a tunnel. All points are finite."""
    chance = random.Random(seed)
    data = bytearray()
    for _ in range(points):
        along, around = chance.uniform(0, 80), chance.uniform(0, 2 * math.pi)
        data += struct.pack("<3f", along, 2 * math.cos(around), 2 * math.sin(around))
    return Cloud(f"made_{points}", XYZ, 12, bytes(data))
