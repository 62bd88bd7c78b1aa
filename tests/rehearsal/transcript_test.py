"""The transcript contains the received messages: its pictures decode to their exact bytes."""

import glob
import math
import os
import struct
import unittest
import zlib

import cbor2

from command_post import (MAPPING_TOKEN, POSE, POINTS, SCORING_TOKEN, CommandPost, changed, cloud, grid, marker,
                          state)

CBOR = {"Content-Type": "application/cbor"}


def read_pgm(path):
    """Cells in the order of an OccupancyGrid, whose first row is the bottom one."""
    with open(path, "rb") as file:
        magic, size, most, pixels = file.read().split(b"\n", 3)
    width, height = map(int, size.split())
    assert (magic, most, len(pixels)) == (b"P5", b"255", width * height)
    cell_of = {205: 255, **{254 - (254 * cell + 50) // 100: cell for cell in range(101)}}
    rows = [pixels[row * width:(row + 1) * width] for row in reversed(range(height))]
    return width, height, bytes(cell_of[pixel] for row in rows for pixel in row)


def read_pcd(path):
    with open(path, "rb") as file:
        header, data = file.read().split(b"DATA binary\n", 1)
    lines = [line.split() for line in header.decode().splitlines() if not line.startswith("#")]
    return {line[0]: line[1:] for line in lines}, data


class Transcript(unittest.TestCase):
    def setUp(self):
        self.post = self.enterContext(CommandPost(transcript=True))

    def path(self, name):
        return os.path.join(self.post.transcript, name)

    def test_a_line_for_each_request(self):
        self.post.map(grid(compression="gzip"))
        self.post.report({"x": 1, "y": 2.5, "z": 3, "type": "Drill"})
        self.post.mapping_request("GET", "/nowhere")
        self.post.mapping_request("POST", "/state/update", state("X1"), {"Expect": "100-continue"})
        taken, report, lost, expecting = self.post.lines()
        self.assertEqual({**taken, "at": 0, "body_bytes": 0, "message": None},
                         {"number": 1, "at": 0, "endpoint": "mapping", "method": "POST", "uri": "/map/update",
                          "content_type": "application/json", "content_encoding": None, "expect": False,
                          "authorization": True, "body_bytes": 0, "status": 200, "answer": "null",
                          "message": None, "fault": None, "rehearsed_fault": None,
                          "violations": []})
        cells = bytes([0, 100, 255, 50, 19, 20])
        self.assertEqual(taken["message"],
                         changed(grid(compression="gzip"), msg__data={
                             "bytes": 6, "crc32": zlib.crc32(cells), "file": "grids/000001-X1.pgm"}))
        self.assertEqual((report["status"], report["message"]["y"]), (201, 2.5))
        self.assertEqual((lost["status"], lost["uri"], len(lost["violations"])), (404, "/nowhere", 1))
        self.assertEqual((expecting["expect"], expecting["message"]), (True, state("X1")))
        self.assertEqual([line["type"] for line in self.post.lines("reports.jsonl")], ["Drill"])
        for token in (SCORING_TOKEN, MAPPING_TOKEN):
            for name in ("requests.jsonl", "reports.jsonl"):
                with open(self.path(name), encoding="utf-8") as file:
                    self.assertNotIn(token, file.read())

    def test_grids_decode_back(self):
        cells = bytes([*range(101), 255, 255, 0, 50])
        turned = {"x": 0, "y": 0, "z": 0.7071067811865476, "w": 0.7071067811865476}
        message = changed(grid(cells, width=7, height=15, cbor=True, compression="gzip"),
                          msg__info__origin__orientation=turned)
        self.assertEqual(self.post.map_cbor(message).status_code, 200)
        self.assertEqual(read_pgm(self.path("grids/000001-X1.pgm")), (7, 15, cells))
        with open(self.path("grids/000001-X1.yaml"), encoding="utf-8") as file:
            lines = dict(line.split(": ") for line in file.read().splitlines())
        x, y, yaw = map(float, lines.pop("origin").strip("[]").split(","))
        self.assertEqual((x, y), (1.5, -2))
        self.assertAlmostEqual(yaw, math.pi / 2)
        self.assertEqual(lines, {"image": "000001-X1.pgm", "resolution": "0.2", "negate": "0",
                                 "occupied_thresh": "0.65", "free_thresh": "0.196"})

    def test_clouds_decode_back_without_their_gaps(self):
        schema = [{"name": "x", "offset": 4, "datatype": 7, "count": 1},
                  {"name": "y", "offset": 8, "datatype": 7, "count": 1},
                  {"name": "z", "offset": 12, "datatype": 7, "count": 1},
                  {"name": "ring", "offset": 0, "datatype": 4, "count": 1},
                  {"name": "two words", "offset": 16, "datatype": 1, "count": 3}]
        points = [(i, 0.5 * i, -1.0 * i, 2.0 * i, -i, i, 0) for i in range(100)]
        for order in "<>":
            with self.subTest(order=order):
                data = b"".join(struct.pack(order + "HxxfffbbbxI", *point, 7) for point in points)
                message = changed(cloud(data, point_step=len(data) // 100, schema=schema, cbor=True,
                                        compression="gzip"), msg__is_bigendian=order == ">")
                self.assertEqual(self.post.map_cbor(message).status_code, 200)
                line = self.post.lines()[-1]
                self.assertEqual(line["message"]["msg"]["data"]["crc32"], zlib.crc32(data))
                header, body = read_pcd(self.path(line["message"]["msg"]["data"]["file"]))
                self.assertEqual(header, {
                    "VERSION": ["0.7"], "FIELDS": ["x", "y", "z", "ring", "two_words"],
                    "SIZE": ["4", "4", "4", "2", "1"], "TYPE": ["F", "F", "F", "U", "I"],
                    "COUNT": ["1", "1", "1", "1", "3"], "WIDTH": ["100"], "HEIGHT": ["1"],
                    "VIEWPOINT": ["1.5", "-2", "0.25", "1", "0", "0", "0"], "POINTS": ["100"]})
                self.assertEqual(list(struct.iter_unpack("<fffHbbb", body)),
                                 [(x, y, z, ring, *rest) for ring, x, y, z, *rest in points])

    def test_hostile_names_are_escaped(self):
        with CommandPost("--as-measured", transcript=True) as post:
            for name in ("../../x", "/etc/passwd", "a" * 500, "", "\u0000\n\u2028", "."):
                self.assertEqual(post.map(changed(grid(), name=name)).status_code, 200)
            self.assertEqual(sorted(os.listdir(post.transcript)), ["clouds", "grids", "reports.jsonl", "requests.jsonl"])
            files = sorted(os.listdir(os.path.join(post.transcript, "grids")))
            self.assertEqual(len(files), 12)
            for file in files:
                self.assertRegex(file, r"^00000\d-\w{1,32}\.(pgm|yaml)$")
            self.assertEqual(post.lines()[0]["message"]["name"], "../../x")

    def test_rejected_map_has_a_line_but_no_picture(self):
        self.post.map(grid(cells=bytes(5)))
        self.post.map_cbor(grid(cells=bytes(5), cbor=True))
        first, second = self.post.lines()
        self.assertEqual((first["status"], first["message"]["msg"]["data"]), (422, {"unread": "string"}))
        self.assertEqual(second["message"]["msg"]["data"], {"unread": "binary"})
        self.assertEqual(first["violations"], ["msg.data: expected 3 x 2 = 6 bytes, got 5"])
        self.assertEqual(glob.glob(self.path("grids/*")), [])

    def test_over_the_budget_there_are_only_lines(self):
        with CommandPost("--transcript-mb", "1", transcript=True) as post:
            for _ in range(3):
                self.assertEqual(post.map(grid(bytes(600_000), 1000, 600, compression="gzip")).status_code, 200)
            names = [line["message"]["msg"]["data"]["file"] for line in post.lines()]
            self.assertEqual(names, ["grids/000001-X1.pgm", None, None])
            self.assertEqual(len(os.listdir(os.path.join(post.transcript, "grids"))), 2)

    def test_line_of_a_large_message_is_short(self):
        long = {**state("X1"), "extra": "x" * 100_000, "list": [0] * 100_000, "bytes": bytes(100_000)}
        self.post.mapping_request("POST", "/state/update", cbor2.dumps(long), CBOR)
        many = {"markers": marker()["markers"] * 5000}
        self.post.mapping_request("POST", "/markers/update", cbor2.dumps(many), CBOR)
        first, second = self.post.lines()
        self.assertEqual((first["status"], second["status"]), (200, 200))
        self.assertEqual({**first["message"], **state("X1")}, {
            **state("X1"), "extra": {"characters": 100_000}, "list": {"elements": 100_000}, "bytes": {"bytes": 100_000}})
        self.assertEqual(list(second["message"]), ["characters"])

    def test_second_start_continues_the_first(self):
        self.post.map(grid())
        self.post.stop()
        self.post.__enter__()
        self.post.map(grid())
        self.assertEqual([line["number"] for line in self.post.lines()], [1, 2])
        self.assertEqual(len(glob.glob(self.path("grids/*.pgm"))), 2)

    def test_origin_is_stored_apart_from_the_points(self):
        self.assertEqual(self.post.map(cloud()).status_code, 200)
        header, body = read_pcd(self.path("clouds/000001-X2.pcd"))
        self.assertEqual(body, POINTS)
        self.assertEqual([float(word) for word in header["VIEWPOINT"][:3]], list(POSE["position"].values()))
