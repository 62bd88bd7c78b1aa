"""Every value of every kind of message arrives unchanged, and no other value does."""

import copy
import itertools
import random
import struct

import cbor2
import requests

import maps
import messages
import programs
from delivered import Delivered
from messages import Style
from programs import wait_until

POSITION = {"x": 1.25, "y": -2.0, "z": 11.0}
TURNED = {"x": 0.0, "y": -0.0, "z": 0.6, "w": 0.8}
POSE = {"position": POSITION, "orientation": TURNED}
NOWHERE = {"position": dict.fromkeys("xyz", 0.0), "orientation": maps.IDENTITY}
JSON, CBOR, CBOR_IN_GZIP = Style(), Style("cbor"), Style("cbor", body="gzip")

# struct's letter and an example value for each datatype of PointField, with a fraction if possible.
DATATYPES = {1: ("b", -5), 2: ("B", 250), 3: ("h", -300), 4: ("H", 60000), 5: ("i", -70000), 6: ("I", 4000000000),
             7: ("f", 0.5), 8: ("d", 1e-3)}


def as_bytes(value):
    """Writes every text as a byte string, as CBOR libraries of Python 2 do."""
    if isinstance(value, str):
        return value.encode()
    if isinstance(value, dict):
        return {as_bytes(key): as_bytes(member) for key, member in value.items()}
    return [as_bytes(element) for element in value] if isinstance(value, list) else value


def as_whole_numbers(value):
    """Writes every 11.0 as 11, as untyped programs do."""
    if isinstance(value, dict):
        return {key: as_whole_numbers(member) for key, member in value.items()}
    if isinstance(value, list):
        return [as_whole_numbers(element) for element in value]
    whole = isinstance(value, float) and value.is_integer() and abs(value) < 2**53 and str(value) != "-0.0"
    return int(value) if whole else value


# Not 256, because cbor2 would write references to texts for it.
REMARKS = (0, 1, 21, 22, 23, 28, 32, 33, 34, 35, 36, 39, 41, 64, 68, 72, 258, 259, 275, 55799)
OTHER_TAGS = (2, 3, 4, 5, 6, 16, 19, 20, 24, 25, 29, 31, 37, 63, 65, 85, 55798, 55800, 2**40)


def tagged(value, tags):
    """Puts each value under the next tag that only annotates, and sometimes a key."""
    if isinstance(value, dict):
        value = {tagged(key, tags) if number % 3 == 2 else key: tagged(member, tags)
                 for number, (key, member) in enumerate(value.items())}
    elif isinstance(value, list):
        value = [tagged(element, tags) for element in value]
    return cbor2.CBORTag(next(tags), value)


# All encodings of the same message: a name, its style, and a function that makes the bytes.
ENCODINGS = (
    ("json", JSON, lambda message: messages.body(message, JSON)),
    ("cbor", CBOR, cbor2.dumps),
    ("cbor in gzip", CBOR_IN_GZIP, lambda message: messages.body(message, CBOR_IN_GZIP)),
    ("shortest floats", CBOR, lambda message: cbor2.dumps(message, canonical=True)),
    ("texts as bytes", CBOR, lambda message: cbor2.dumps(as_bytes(message))),
    ("tags", CBOR, lambda message: cbor2.dumps(tagged(message, itertools.cycle(REMARKS)))),
    ("whole numbers in json", JSON, lambda message: messages.body(as_whole_numbers(message), JSON)),
    ("whole numbers in cbor", CBOR, lambda message: cbor2.dumps(as_whole_numbers(message))),
)


LIFETIME = 3000.0  # seconds


def whole_lifetime(marker, lifetime=LIFETIME):
    """The marker as if it had spent no time in Adit's queue."""
    return marker | {"lifetime": lifetime} if lifetime - 100 < marker["lifetime"] <= lifetime else marker


def whole_marker(kind):
    """Every member of ROS's Marker. If `kind` is odd, no member has its default value."""
    color = {"r": 1.0, "g": 0.5, "b": 0.25, "a": 1.0}
    odd = kind % 2 == 1
    return {"header": {"frame_id": "darpa"}, "ns": f"paths/{kind}", "id": kind - 6, "type": kind, "action": 0,
            "pose": POSE, "scale": {"x": 0.05, "y": 11.0, "z": 1e-3}, "color": color, "lifetime": LIFETIME,
            "text": "n\u00f6de \u2714", "frame_locked": odd,
            "points": [{"x": float(n), "y": -0.1 * n, "z": 1e6} for n in range(6)], "colors": [color] * 6,
            "mesh_resource": "package://robots/husky.dae", "mesh_use_embedded_materials": odd}


def said(marker):
    """Without members that have ROS's default, which are not sent."""
    return {name: value for name, value in marker.items() if value is not False}


def fields_of(datatypes, counts):
    fields, offset = [], 0
    for number, (datatype, count) in enumerate(zip(datatypes, counts, strict=True)):
        fields.append(maps.field(f"f{number}" if number > 2 else "xyz"[number], offset, datatype, count))
        offset += struct.calcsize(DATATYPES[datatype][0]) * count
    return fields, offset


def every_datatype(order):
    """A cloud of 60 points with a field of each datatype, one field of several values, and three bytes of padding."""
    datatypes = (7, 7, 7, 1, 2, 3, 4, 5, 6, 8)
    counts = (1, 1, 1, 1, 3, 2, 1, 1, 1, 2)
    fields, step = fields_of(datatypes, counts)
    data = b""
    for n in range(60):
        for datatype, count in zip(datatypes, counts, strict=True):
            letter, value = DATATYPES[datatype]
            data += struct.pack(f"{order}{count}{letter}", *[value + (n if datatype > 6 else n % 5)] * count)
        data += b"\xa5\x00\x5a"
    return maps.Cloud(f"every datatype {order}", fields, step + 3, data, is_bigendian=order == ">")


class Fidelity(Delivered):
    """With a strict Command Post. test_fidelity_long.py repeats it with one that behaves like the real ones."""

    def test_grids(self):
        grid = maps.made_grid(80, 60)
        info = {"resolution": 0.25, "width": 80, "height": 60, "origin": POSE}
        update = {"type": "OccupancyGrid", "name": "r1", "msg": {"header": {"frame_id": "darpa"}, "info": info}}
        for name, style, encode in ENCODINGS:
            message = copy.deepcopy(update)
            message["msg"]["data"] = messages.bulk(grid, style)
            with self.subTest(name):
                arrived = self.deliver("/map/update", None, style, encode(message))
                self.same_map(arrived, update, grid.data, {"info": info})

    def test_recorded_maps(self):
        found = maps.recorded()
        if not found:
            self.skipTest("ADIT_MAPS names no folder of recorded maps")
        for source in found:
            for style in (JSON, Style("json", "gzip"), CBOR, Style("cbor", "gzip"), Style("cbor", body="gzip", ros=True)):
                with self.subTest(style=str(style), map=source.label):
                    update = messages.map_update(source, "replay", self.seconds, style)
                    self.same_map(self.deliver("/map/update", update, style), update, source.data, source.head())

    def test_any_token_is_accepted(self):
        for token in (programs.TEAM_TOKEN, programs.SCORING_TOKEN, programs.MAPPING_TOKEN):
            answer = messages.post(self.session, self.stage.box.url, "/state/update", {"poses": [{"name": "r1", **POSE}]}, JSON, token)
            self.assertEqual(answer.status_code, 200)

    def check_cloud(self, cloud, origin, going_up):
        """Posts `cloud` and expects `going_up`, bytes, with that origin; None: without an origin."""
        message = {"type": "PointCloud2", "name": "r1",
                   "msg": {"header": {"frame_id": "darpa"}, **cloud.head(), **({"origin": origin} if origin else {})}}
        head = {"fields": cloud.fields, "is_bigendian": False, "point_step": cloud.point_step,
                **({"origin": origin} if origin else {})}
        for name, style, encode in ENCODINGS:
            whole = copy.deepcopy(message)
            whole["msg"]["data"] = messages.bulk(cloud, style)
            with self.subTest(name, cloud=cloud.label, origin=bool(origin)):
                self.same_map(self.deliver("/map/update", None, style, encode(whole)), message, going_up, head)

    def test_clouds_of_either_byte_order_with_an_origin_and_without(self):
        little, big = every_datatype("<"), every_datatype(">")
        for cloud in (little, big):
            for origin in (None, POSE):
                self.check_cloud(cloud, origin, little.data)

    def test_states(self):
        poses = [{"name": "r1", **POSE}, {"name": "R_2", "position": {"x": 1e-300, "y": 1e300, "z": 0.1}, "orientation":
                 {"x": 0.5, "y": -0.5, "z": 0.7071067811865476, "w": 0.001}}]
        update = {"header": {"frame_id": "darpa"}, "poses": poses}
        for name, style, encode in ENCODINGS:
            with self.subTest(name):
                arrived = self.deliver("/state/update", None, style, encode(update))
                arrived["header"] = self.without_stamp(arrived["header"])
                others = [pose for pose in arrived["poses"] if pose["name"] not in ("r1", "R_2")]
                arrived["poses"] = sorted((pose for pose in arrived["poses"] if pose not in others),
                                          key=lambda pose: pose["name"] != "r1")
                self.same(arrived, update)

    def test_markers_of_every_type(self):
        update = {"markers": [whole_marker(kind) for kind in range(12)]}
        for name, style, encode in ENCODINGS:
            with self.subTest(name):
                arrived = self.deliver("/markers/update", None, style, encode(update))
                for marker in arrived["markers"]:
                    marker["header"] = self.without_stamp(marker["header"])
                arrived["markers"] = [whole_lifetime(marker) for marker in arrived["markers"]]
                self.same(arrived, {"markers": [said(marker) for marker in update["markers"]]})

    def test_markers_that_are_deleted(self):
        markers = [{"action": 2, "ns": "paths/1", "id": -5}, {"action": 3}, {"action": 2, "ns": "", "id": 2**31 - 1}]
        arrived = self.deliver("/markers/update", {"markers": markers[:1]}, CBOR)["markers"]
        arrived += self.deliver("/markers/update", {"markers": markers[1:2]}, JSON)["markers"]
        arrived += self.deliver("/markers/update", {"markers": markers[2:]}, JSON)["markers"]
        for marker, sent in zip(arrived, markers, strict=True):
            marker["header"] = self.without_stamp(marker["header"])
            namespace = sent.get("ns") or ("" if sent["action"] == 3 else "unnamed")
            self.same(marker, {"header": {"frame_id": "darpa"}, "ns": namespace, "id": sent.get("id", 0),
                               "type": 0, "action": sent["action"], "pose": NOWHERE,
                               "scale": dict.fromkeys("xyz", 0.0), "color": dict.fromkeys("rgba", 0.0),
                               "lifetime": 0.0, "text": ""})

    def test_durations_and_stamps_in_each_form(self):
        marker = said(whole_marker(1)) | {"ns": "spacing"}
        forms = [(1000.25, 3000.5)]
        for seconds, nanoseconds in (("secs", "nsecs"), ("sec", "nanosec"), ("sec", "nsec")):
            forms.append(({seconds: 1000 + len(forms), nanoseconds: 0}, {seconds: 3000, nanoseconds: 500000000}))
        arrived = []
        for (stamp, lifetime), style in zip(forms, (JSON, CBOR, JSON, CBOR), strict=True):
            marker |= {"header": {"stamp": stamp}, "lifetime": lifetime}
            arrived += self.deliver("/markers/update", {"markers": [marker]}, style)["markers"]
        self.same([whole_lifetime(one, 3000.5)["lifetime"] for one in arrived], [3000.5] * 4)
        stamps = [one["header"]["stamp"] for one in arrived]
        for stamp, after in zip(stamps, (0, 0.75, 1.75, 2.75), strict=True):
            self.assertAlmostEqual(stamp - stamps[0], after, places=5)

    def test_an_empty_frame_counts_as_absent(self):
        for header in ({"frame_id": ""}, {"frame_id": None}, {}, None):
            for style in (JSON, CBOR):
                with self.subTest(header=header, style=str(style)):
                    update = {"header": header, "poses": [{"name": "r1", **POSE}]}
                    self.assertEqual(self.deliver("/state/update", update, style)["header"]["frame_id"], "darpa")
                    markers = {"markers": [said(whole_marker(2)) | {"header": header}]}
                    arrived = self.deliver("/markers/update", markers, style)["markers"][0]
                    self.assertEqual(arrived["header"]["frame_id"], "darpa")
                    grid = messages.map_update(maps.made_grid(3, 2), "r1", 0, style)
                    grid["msg"]["header"] = header
                    arrived = self.deliver("/map/update", grid, style)["msg"]
                    self.assertEqual(arrived["header"]["frame_id"], "darpa")

    def test_a_tag_that_changes_a_meaning_is_named_and_rejected(self):
        for tag in OTHER_TAGS:
            for at, value in (("x", cbor2.CBORTag(tag, 5)), ("z", cbor2.CBORTag(1, cbor2.CBORTag(tag, b"\x05")))):
                update = {"poses": [{"name": "r1", "position": {**POSITION, at: value}, "orientation": TURNED}]}
                answer = messages.post(self.session, self.stage.box.url, "/state/update", update, CBOR)
                with self.subTest(tag=tag, at=at):
                    self.assertEqual(answer.status_code, 422)
                    self.assertIn(f"position.{at}: ", answer.json())

    def test_the_good_parts_of_a_state(self):
        bad = {"name": "r9", "position": {**POSITION, "y": "far"}, "orientation": TURNED}
        good = [{"name": f"r{n}", "position": {**POSITION, "x": float(n)}, "orientation": TURNED} for n in (1, 2, 3)]
        update = {"poses": [good[0], bad, good[1], POSE, *[bad] * 10, good[2]]}
        # As from a relay under Python 2: every text, keys too, is a byte string.
        for style, content, got in ((JSON, messages.body(update, JSON), "a string"),
                                    (CBOR, cbor2.dumps(as_bytes(update)), "a byte string")):
            far = f"position.y: expected a number, got {got}"
            sentences = [f"poses[1].{far}", "poses[3].name: missing", *[f"poses[{n}].{far}" for n in range(4, 12)]]
            refused = "; ".join([*sentences, "and 2 more like these (the other 3 were accepted)"])
            with self.subTest(str(style)):
                poses = self.deliver("/state/update", None, style, content, (422, f'"{refused}"'))["poses"]
                self.assertNotIn("r9", [pose["name"] for pose in poses])
                names = [pose["name"] for pose in good]
                self.same(sorted((pose for pose in poses if pose["name"] in names), key=lambda pose: pose["name"]), good)

    def test_the_good_parts_of_markers(self):
        good = [said(whole_marker(kind)) for kind in (4, 5)]
        bad = {**good[0], "points": [{"x": 1, "y": 2}]}
        answered = (422, '"markers[1].points[0].z: missing (the other 2 were accepted)"')
        arrived = self.deliver("/markers/update", {"markers": [good[0], bad, good[1]]}, CBOR, answered=answered)
        for marker in arrived["markers"]:
            marker["header"] = self.without_stamp(marker["header"])
        arrived["markers"] = [whole_lifetime(marker) for marker in arrived["markers"]]
        self.same(arrived, {"markers": good})

    def test_reports_and_their_answers(self):
        coordinates = ([11.0, -7.0, 0.0], [1e3, 1e21, -0.0], [0.1, 1e-7, 123456789.125])
        for at, kind in zip(coordinates, ("Rope", "drill", "VENT"), strict=True):
            report = dict(zip("xyz", at, strict=True)) | {"type": kind}
            other = report | {"x": report["x"] + 2}
            for sent, arrives in ((report, report), ({**as_whole_numbers(other), "name": "r1"}, {**other, "name": "r1"})):
                resubmit = {"Adit-Resubmit": "yes"}
                answer = self.session.post(self.stage.box.url + "/api/artifact_reports", json=sent, timeout=60,
                                           headers={**messages.headers(JSON), **resubmit})
                self.assertEqual(answer.status_code, 201, answer.text)
                arrived = self.stage.post.requests("/api/artifact_reports")[-1]
                self.same(arrived["message"], arrives)
                self.assertEqual(answer.text, arrived["answer"])

    def test_the_status(self):
        answer = requests.get(self.stage.box.url + "/api/status", headers=messages.headers(JSON), timeout=30)
        self.assertIn(answer.text, [request["answer"] for request in self.stage.post.requests("/api/status")])


class Covered(Delivered):
    def test_the_covered_area_is_the_union_of_all_grids(self):
        """Cells of 0.1 m, none with its centre on the border of a square of 0.25 m."""
        cell, unknown = 0.1, 255
        squares = {}
        for number, (name, x, y) in enumerate((("ugv1", -3.08, 60.02), ("uav1", 1.92, 62.02), ("ugv1", -1.08, 61.02))):
            dice = random.Random(number)
            cells = bytes(dice.choice((0, 100, *[unknown] * 8)) for _ in range(80 * 60))
            grid = maps.Grid(name, 80, 60, cell, (x, y, 0.0), cells)
            self.deliver("/map/update", messages.map_update(grid, name, self.seconds, CBOR), CBOR)
            squares.setdefault(name, set()).update(
                (int((x + (at % 80 + 0.5) * cell) // 0.25), int((y + (at // 80 + 0.5) * cell) // 0.25))
                for at, value in enumerate(cells) if value != unknown)
        union = set().union(*squares.values())
        self.assertLess(len(union), sum(map(len, squares.values())))
        expected = {"square_metres": len(union) / 16, "whole": True,
                    "robots": [{"robot": name, "square_metres": len(squares[name]) / 16} for name in sorted(squares)]}

        def covered():
            answer = self.stage.box.ask("GET /adit/covered")[1]
            return {name: answer[name] for name in expected}

        wait_until(lambda: covered() == expected, f"{expected} in place of {covered()}", 30)
