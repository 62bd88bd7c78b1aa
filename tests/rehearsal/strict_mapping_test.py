"""The mapping endpoint of a strict Command Post: ICD 4 and 6."""

import base64
import gzip
import math
import struct
import time
import unittest

import cbor2

from command_post import (DROP, MAPPING_TOKEN, POINTS, CommandPost, changed, cloud, fields, grid, marker, state,
                          two_at_once)

CBOR = {"Content-Type": "application/cbor"}


class Taken(unittest.TestCase):
    def setUp(self):
        self.post = self.enterContext(CommandPost())

    def expect_taken(self, path, message):
        for headers, body in (({}, message), (CBOR, cbor2.dumps(message))):
            answer = self.post.mapping_request("POST", path, body, headers)
            self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def test_both_map_types_in_both_formats_with_and_without_compression(self):
        for make in (grid, cloud):
            for compression in ("none", "gzip"):
                with self.subTest(make=make.__name__, compression=compression):
                    self.assertEqual(self.post.map(make(compression=compression)).status_code, 200)
                    self.assertEqual(self.post.map_cbor(make(cbor=True, compression=compression)).status_code, 200)
        taken = {(part["kind"], part["robot"]): part["count"] for part in self.post.record()["accepted"]}
        self.assertEqual(taken, {("grid", "X1"): 4, ("cloud", "X2"): 4})

    def test_optional_members_may_be_absent(self):
        for body in (changed(grid(), name=DROP), changed(grid(), name=""), changed(grid(), msg__header=DROP),
                     changed(grid(), msg__compression=DROP), changed(grid(), msg__header__stamp=DROP),
                     changed(cloud(), msg__origin=DROP), changed(cloud(), msg__is_bigendian=DROP)):
            self.assertEqual(self.post.map(body).status_code, 200)
        self.expect_taken("/state/update", changed(state("X1"), header=DROP))
        for name in ("header", "ns", "id", "lifetime", "text"):
            self.expect_taken("/markers/update", marker(**{name: DROP}))

    def test_unknown_members_are_ignored(self):
        for rows in ({"msg__height": 1}, {"msg__height": 2, "msg__width": 1, "msg__row_step": 12}):
            body = changed(cloud(), msg__is_dense=True, msg__header__seq=4, **rows)
            self.assertEqual(self.post.map(body).status_code, 200)

    def test_empty_object_is_rejected_without_a_violation(self):
        for headers, body in (({}, {}), (CBOR, cbor2.dumps({}))):
            self.assertEqual(self.post.mapping_request("POST", "/state/update", body, headers).status_code, 422)
        self.assertEqual(self.post.record()["violation_count"], 0)

    def test_quaternion_has_length_1_within_noise(self):
        for length in (0.999999, 1, 1.000001):
            self.assertEqual(self.post.map(changed(grid(), msg__info__origin__orientation__w=length)).status_code, 200)

    def test_state_and_markers_of_all_kinds(self):
        self.expect_taken("/state/update", state("X1", "X2", "A_long_one"))
        self.expect_taken("/state/update", state())
        for action in (0, 2, 3):
            self.expect_taken("/markers/update", marker(action=action))
        self.expect_taken("/markers/update", marker(lifetime={"secs": 3, "nsecs": 500}))
        self.expect_taken("/markers/update", {"markers": []})
        taken = {(part["kind"], part["robot"]): part["count"] for part in self.post.record()["accepted"]}
        self.assertEqual(taken, {("pose", "X1"): 2, ("pose", "X2"): 2, ("pose", "A_long_one"): 2,
                                 ("marker", "artifacts"): 8})

    def test_colors_are_checked_only_for_markers_that_use_them(self):
        for kind in (0, 1, 2, 3, 9, 10):
            self.expect_taken("/markers/update", marker(type=kind, colors=[COLOR]))
        for kind in (4, 5, 6, 7, 8, 11):
            self.expect_taken("/markers/update", marker(type=kind, points=[POINT] * 3, colors=[COLOR] * 3))

    def test_cbor_in_any_of_its_lengths(self):
        # An indefinite map, a half float, a byte string in two chunks (RFC 8949 3.2, 3.3).
        body = cbor2.dumps(grid(cbor=True))
        data = bytes([0, 100, 255, 50, 19, 20])
        chunked = body.replace(cbor2.dumps(data), b"\x5f" + cbor2.dumps(data[:2]) + cbor2.dumps(data[2:]) + b"\xff")
        half = chunked.replace(b"\xfb" + struct.pack(">d", 1.0), b"\xf9\x3c\x00")
        indefinite = b"\xbf" + half[1:] + b"\xff"
        self.assertEqual(half[:1], b"\xa3")
        self.assertEqual(self.post.map(indefinite, **CBOR).text, "null")

    def test_equal_stamps_are_no_step_back(self):
        for stamp in (5, 5, 5.5):
            self.assertEqual(self.post.map(changed(grid(), msg__header__stamp=stamp)).status_code, 200)


def grid_refusals():
    info = {f"msg__info__{name}": DROP for name in ("resolution", "width", "height", "origin")}
    for path in ("type", "msg", "msg__info", "msg__data", *info):
        yield changed(grid(), **{path: DROP})
    for changes in ({"type": "Octomap"}, {"type": 5}, {"msg": []}, {"name": "elevenchars"}, {"name": "X 1"},
                    {"name": None}, {"msg__info__width": 4}, {"msg__info__width": 3.0}, {"msg__info__width": -3},
                    {"msg__info__width": 2**32}, {"msg__info__width": 0}, {"msg__info__height": "2"},
                    {"msg__info__resolution": 0}, {"msg__info__resolution": "0.2"},
                    {"msg__info__origin__orientation__w": 0}, {"msg__info__origin__orientation__w": 1.00001},
                    {"msg__info__origin__orientation__z": 1}, {"msg__info__origin__position__z": DROP},
                    {"msg__header__frame_id": "map"}, {"msg__header__frame_id": 1}, {"msg__header": 3},
                    {"msg__header__stamp": -1}, {"msg__header__stamp": {"secs": 1, "nsecs": 2}},
                    {"msg__compression": "bz2"}, {"msg__compression": True}, {"msg__compression": "gzip"},
                    {"msg__data": [0, 100, 255, 50, 19, 20]}, {"msg__data": "AGT_MhMU"}, {"msg__data": "AGT/MhMU="},
                    {"msg__data": " AGT/MhMU"}):
        yield changed(grid(), **changes)
    yield grid(cells=bytes([0, 100, 255, 50, 19]))
    yield grid(cells=bytes([0, 101, 255, 50, 19, 20]))
    yield grid(cells=bytes(2_000_000), compression="gzip")
    yield grid(width=2**16, height=2**16)
    packed = gzip.compress(bytes(6))
    for data in (packed[:-1], packed + b"\0", packed + packed, packed[:-8] + bytes(8), b"", bytes(6)):
        yield changed(grid(compression="gzip"), msg__data=base64.b64encode(data).decode())


def cloud_refusals():
    for path in ("msg__fields", "msg__point_step", "msg__data", "msg__fields__0__name", "msg__fields__1__offset"):
        yield changed(cloud(), **{path: DROP})
    for changes in ({"msg__point_step": 0}, {"msg__point_step": 11}, {"msg__point_step": -12},
                    {"msg__point_step": 12.0}, {"msg__fields__2__offset": 9}, {"msg__fields__2__offset": 2**32 - 1},
                    {"msg__fields__2__count": 2**32 - 1}, {"msg__fields__2__count": 0},
                    {"msg__fields__0__datatype": 0}, {"msg__fields__0__datatype": 9},
                    {"msg__fields__0__datatype": 6}, {"msg__fields__0__name": "y"},
                    {"msg__fields__0__name": "intensity"}, {"msg__fields": []}, {"msg__fields": {}},
                    {"msg__is_bigendian": 1}, {"msg__origin": None}, {"msg__origin__orientation": DROP},
                    {"msg__origin__orientation__w": 0.99}, {"msg__width": 2, "msg__row_step": 36},
                    {"msg__width": 1, "msg__height": 2, "msg__row_step": 0}):
        yield changed(cloud(), **changes)
    for value in (math.nan, math.inf, -math.inf):
        yield cloud(data=POINTS + struct.pack("<3f", 1, 2, value))
        yield changed(cloud(data=struct.pack(">3f", value, 1, 2)), msg__is_bigendian=True)
        yield cloud(schema=fields(8, 8), point_step=24, data=struct.pack("<3d", 1, value, 2))
    yield cloud(data=POINTS + b"PADDINGOFROW")
    yield cloud(data=POINTS[:-1])
    mixed = fields()[:2] + [{"name": "z", "offset": 8, "datatype": 8, "count": 1}]
    yield cloud(schema=mixed, point_step=16, data=bytes(32))


COLOR = {"r": 1, "g": 0.5, "b": 0, "a": 1}
POINT = {"x": 1, "y": 2, "z": 3}


def marker_refusals():
    for kind in (4, 5, 6, 7, 8, 11):
        yield marker(type=kind, colors=[COLOR] * 2, points=[POINT] * 3)
    for name in ("type", "action", "pose", "scale", "color"):
        yield marker(**{name: DROP})
    for changes in ({"type": 12}, {"type": -1}, {"type": "2"}, {"action": 1}, {"action": 4}, {"action": 0.0},
                    {"id": 2**31}, {"id": "7"}, {"ns": 3}, {"color__a": 1.5}, {"color__r": -0.1},
                    {"color__g": DROP}, {"scale__x": None}, {"pose__position__x": "1"}, {"lifetime": -1},
                    {"lifetime": "1"}, {"lifetime": {"secs": 1}}, {"text": 4}, {"header__frame_id": "odom"},
                    {"pose__orientation__w": 0}, {"pose__orientation__w": -2}):
        yield marker(**changes)
    yield from ({}, {"markers": {}}, {"markers": [3]}, [])


def state_refusals():
    yield from ({}, [], {"poses": {}}, {"poses": [1]}, state(""), state("elevenchars"), state("a-b"), state(7))
    for path in ("name", "position", "orientation", "position__x", "orientation__w"):
        yield changed(state("X1"), **{"poses__0__" + path: DROP})
    yield changed(state("X1"), poses__0__orientation__x=0.5)
    yield changed(state("X1"), header__frame_id="world")
    yield changed(state("X1"), header__stamp="1")


class Refused(unittest.TestCase):
    def test_each_rule_broken_is_422_and_a_violation(self):
        with CommandPost() as post:
            count = 0
            for path, bodies in (("/map/update", [*grid_refusals(), *cloud_refusals()]),
                                 ("/state/update", list(state_refusals())),
                                 ("/markers/update", list(marker_refusals()))):
                for body in bodies:
                    with self.subTest(path=path, body=str(body)[:300]):
                        answer = post.mapping_request("POST", path, body)
                        self.assertEqual((answer.status_code, answer.headers["Content-Type"]),
                                         (422, "application/json"))
                        self.assertIsInstance(answer.json(), str)
                        count += 1
                        self.assertLessEqual(count, post.record()["violation_count"])
            self.assertEqual(post.record()["accepted"], [])

    def test_sentences_name_the_field(self):
        table = [
            ("Missing field 'msg.info.width'", changed(grid(), msg__info__width=DROP)),
            ("msg.data: expected 4 x 2 = 8 bytes, got 6", grid(width=4)),
            ("msg.data[1]: expected 0 to 100 or 255, got 101", grid(cells=bytes([0, 101, 255, 50, 19, 20]))),
            ("msg.header.frame_id: expected \"darpa\" (ICD 6.1)", changed(grid(), msg__header__frame_id="map")),
            ("msg.data: bytes after the end of the one gzip member",
             changed(grid(), msg__compression="gzip",
                     msg__data=base64.b64encode(gzip.compress(bytes(6)) * 2).decode())),
            ("msg.point_step: expected at least 1, got 0", cloud(point_step=0)),
            ("msg.fields[2]: ends at byte 13 of a point of 12", changed(cloud(), msg__fields__2__offset=9)),
            ("msg.row_step: expected width * point_step = 24, got 36", changed(cloud(), msg__width=2, msg__row_step=36)),
            ("msg.data: point 1 has no finite y (ICD 6.3.2)", cloud(data=struct.pack("<6f", 1, 2, 3, 4, math.nan, 6))),
            ("msg.data: the padding between a robot's rows arrived as points", cloud(data=POINTS + b"PADDINGOFROW")),
            ("msg.origin.orientation: expected a quaternion of length 1, got one of length 2.000000",
             changed(cloud(), msg__origin__orientation__w=2)),
        ]
        with CommandPost() as post:
            for sentence, body in table:
                self.assertEqual(post.map(body).json(), sentence)

    def test_cbor_is_strict(self):
        good = cbor2.dumps(grid(cbor=True))
        data = cbor2.dumps(bytes([0, 100, 255, 50, 19, 20]))
        table = [
            (400, good[:-1]), (400, good + b"\0"), (400, b""), (400, b"\xff"), (400, b"\x81" * 65 + b"\x80"),
            (400, b"\x81" * 1_000_000), (400, b"\x9f" * 1_000_000), (400, b"\xa1\x01\x02"),
            (400, b"\x5b" + b"\xff" * 8), (400, b"\x9b" + b"\xff" * 8), (400, b"\xbb" + b"\x7f" * 8),
            (400, good.replace(b"bX1", b"b\xff\xfe")),
            (422, good.replace(data, cbor2.dumps("AGT/MhMU"))),
            (422, good.replace(b"\xfb" + struct.pack(">d", 1.0), b"\xf9\x7e\x00")),  # NaN
            (422, good.replace(b"\xfb" + struct.pack(">d", 1.0), b"\xf9\x7c\x00")),  # infinity
            (422, b"\xa4" + cbor2.dumps("name") + cbor2.dumps("X9") + good[1:]),
        ]
        with CommandPost() as post:
            for status, body in table:
                with self.subTest(body=body[:40]):
                    self.assertNotEqual(body, good)
                    answer = post.map(body, **CBOR)
                    self.assertEqual(answer.status_code, status)
                    self.assertIsInstance(answer.json(), str)

    def test_front_door(self):
        bearer = f"Bearer {MAPPING_TOKEN}"
        table = [
            (404, "POST", "/", {}), (404, "POST", "/map/update/", {}), (404, "GET", "/map/update", {}),
            (404, "OPTIONS", "/map/update", {}), (404, "POST", "/api/artifact_reports", {}),
            (401, "POST", "/map/update", {"Authorization": None}),
            (401, "POST", "/map/update", {"Authorization": bearer.replace("B", "b")}),
            (401, "POST", "/map/update", {"Authorization": "Bearer  " + MAPPING_TOKEN}),
            (422, "POST", "/map/update", {"Content-Type": "application/json; charset=utf-8"}),
            (422, "POST", "/map/update", {"Content-Type": "text/plain"}),
            (422, "POST", "/map/update", {"Content-Encoding": "gzip"}),
            (422, "POST", "/map/update", {"Content-Encoding": "deflate"}),
        ]
        with CommandPost() as post:
            for status, method, path, headers in table:
                with self.subTest(method=method, path=path, headers=headers):
                    answer = post.mapping_request(method, path, grid(), headers)
                    self.assertEqual((answer.status_code, answer.headers["Content-Type"]),
                                     (status, "application/json"))
                    self.assertNotIn("WWW-Authenticate", answer.headers)

    def test_harmless_violations_are_accepted_and_recorded(self):
        unseen = {"r": 1, "g": 0.5, "b": 0, "a": 0}
        red, point = {"r": 1, "g": 0, "b": 0, "a": 1}, {"x": 0, "y": 0, "z": 0}
        table = [
            ("markers/update", marker(color=unseen), "markers[0].color.a: a marker with 0 is invisible (ICD 6.6)"),
            ("markers/update", marker(color=unseen, type=8, points=[point], colors=[unseen]),
             "markers[0].color.a: a marker with 0 is invisible (ICD 6.6)"),
            ("markers/update", marker(color=unseen, type=8, points=[point], colors=[red]), None),
            ("markers/update", marker(color=unseen, type=10, mesh_use_embedded_materials=True), None),
            ("markers/update", marker(color=unseen, action=2), None),
            ("markers/update", marker(type=5, points=[point]), "markers[0].points: a line list has two points for each line"),
            ("markers/update", marker(type=5, points=[point, point]), None),
            ("markers/update", marker(type=9, text=""), "markers[0].text: a text marker without text"),
            ("markers/update", marker(scale={"x": 1, "y": -1, "z": 1}), "markers[0].scale: negative"),
            ("state/update", state("X1", "X2", "X1"), "poses: 'X1' is given twice"),
            ("state/update", state("X1", "X3"), "name: 'X3' is not on the roster (ICD 2)"),
            ("map/update", grid(name="X3"), "name: 'X3' is not on the roster (ICD 2)"),
            ("map/update", grid(name="X1"), None),
            ("map/update", changed(grid(), name=DROP), None),
        ]
        for manner in ((), ("--as-measured",)):
            with CommandPost("--roster", "X1,X2", *manner) as post:
                told = []
                for path, body, sentence in table:
                    with self.subTest(sentence, manner=manner, path=path):
                        status = post.mapping_request("POST", "/" + path, body).status_code
                        if body.get("name", "") or path != "map/update" or not manner:
                            self.assertEqual(status, 200)
                        told += [sentence] if sentence else []
                        self.assertEqual([each["sentence"] for each in post.record()["violations"]], told)

    def test_body_beyond_the_limit_gets_the_page_of_a_proxy(self):
        with CommandPost("--limit-bytes", "1000") as post:
            self.assertEqual(post.map(grid()).status_code, 200)
            answer = post.mapping_request("POST", "/markers/update", marker(text="x" * 1000))
            self.assertEqual((answer.status_code, answer.headers["Content-Type"]), (413, "text/html"))
            self.assertEqual(post.record()["violation_count"], 0)

    def test_serious_violation_counts_after_many_harmless_ones(self):
        with CommandPost() as post:
            unseen = marker(color={"r": 1, "g": 0, "b": 0, "a": 0})["markers"] * 30
            bad = marker(color={"r": 2, "g": 0, "b": 0, "a": 1})["markers"]
            answer = post.mapping_request("POST", "/markers/update", {"markers": [*unseen, *bad]})
            self.assertEqual((answer.status_code, answer.json()), (422, "markers[30].color.r: expected 0 to 1 (ICD 6.6)"))

    def test_stamps_that_go_back_are_rejected_per_uri(self):
        with CommandPost() as post:
            def stamped(stamp):
                return post.map(changed(grid(), msg__header__stamp=stamp))
            self.assertEqual(stamped(100.5).status_code, 200)
            self.assertEqual(stamped(100.25).json(),
                             "msg.header.stamp: runs backward, 100.25 after 100.5 (ICD 6.2)")
            self.assertEqual(stamped(100.5).status_code, 200)
            self.assertEqual(post.mapping_request("POST", "/state/update", state("X1")).status_code, 200)
            two = {"markers": [*marker(header__stamp=9)["markers"], *marker(header__stamp=8)["markers"]]}
            self.assertEqual(post.mapping_request("POST", "/markers/update", two).status_code, 422)
            self.assertEqual(post.mapping_request("POST", "/markers/update", marker()).status_code, 200,
                             "what was refused does not count")
            self.assertEqual(post.record()["violation_count"], 2)

    def test_the_display_deletes_markers_with_an_empty_ns(self):
        with CommandPost() as post:
            def take(*markers):
                message = {"markers": [each for one in markers for each in one["markers"]]}
                self.assertEqual(post.mapping_request("POST", "/markers/update", message).status_code, 200)
                return post.record()["violation_count"]
            unnamed = marker(ns="", id=1)
            self.assertEqual(take(unnamed, marker(), marker()), 0)
            self.assertEqual(take(marker(), marker(), marker()), 0, "as many as before")
            self.assertEqual(take(marker()), 1, "two fewer: ids 1 and 2 are deleted")
            self.assertEqual(take(unnamed, marker()), 1)
            self.assertEqual(take(marker(ns="", id=1, action=2)), 1, "its sender has deleted it")

    def test_more_than_one_a_second_for_a_uri_is_429(self):
        with CommandPost(rate=None) as post:
            bodies = {"/map/update": grid(), "/state/update": state("X1"), "/markers/update": marker()}
            for path, body in bodies.items():  # each URI has its own timer
                statuses = two_at_once(lambda path=path, body=body: post.mapping_request("POST", path, body))
                self.assertEqual(statuses, [200, 429], path)
            time.sleep(1)
            for path, body in bodies.items():
                self.assertEqual(post.mapping_request("POST", path, body).status_code, 200, path)
