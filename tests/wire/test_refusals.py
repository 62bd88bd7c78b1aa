"""What the ICD forbids, and what kills a Command Post, is refused to its sender at once with a status and a sentence that
names the field, and never leaves."""

import copy
import gzip
import json
import unittest
import zlib

import cbor2
import requests

import hosts
import maps
import messages
import programs
from programs import Stage

JSON = messages.Style()
GRID = messages.map_update(maps.made_grid(80, 60), "r1", 5.0, JSON)
CLOUD = messages.map_update(maps.made_cloud(100), "r1", 5.0, JSON)
POSE = {"position": {"x": 1, "y": 2, "z": 3}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
STATE = {"header": {"stamp": 5.0, "frame_id": "darpa"}, "poses": [{"name": "r1", **POSE}]}
MARKERS = {"markers": [{"ns": "path", "id": 1, "type": 2, "action": 0, "pose": POSE, "scale": {"x": 1, "y": 1, "z": 1},
                        "color": {"r": 1, "g": 0, "b": 0, "a": 1}}]}
REPORT = {"x": 1.0, "y": 2.0, "z": 3.0, "type": "Backpack"}
MISSING = object()


def changed(message, path, value):
    """A copy with the member at `path` ("msg.info.width") set, or taken out."""
    made = copy.deepcopy(message)
    at = made
    *folders, last = [int(word) if word.isdigit() else word for word in path.split(".")]
    for name in folders:
        at = at[name]
    if value is MISSING:
        del at[last]
    else:
        at[last] = value
    return made


# (URI, message, field, value, words of the sentence)
FIELDS = [
    ("/map/update", GRID, "type", "Octomap", ["type", "OccupancyGrid", "PointCloud2"]),
    ("/map/update", GRID, "type", MISSING, ["type", "missing"]),
    ("/map/update", GRID, "name", "a name too long", ["name", "10"]),
    ("/map/update", GRID, "msg.header.frame_id", "world", ["msg.header.frame_id", "darpa", "world"]),
    ("/map/update", GRID, "msg.header.stamp", -1, ["msg.header.stamp"]),
    ("/map/update", GRID, "msg.info.width", 79, ["msg.info.width", "79 x 60 = 4740", "4800"]),
    ("/map/update", GRID, "msg.info.width", "80", ["msg.info.width", "string"]),
    ("/map/update", GRID, "msg.info.height", 0, ["msg.info.height"]),
    ("/map/update", GRID, "msg.info.resolution", 0, ["msg.info.resolution"]),
    ("/map/update", GRID, "msg.info.origin.position.y", MISSING, ["msg.info.origin.position.y", "missing"]),
    ("/map/update", GRID, "msg.compression", "lz4", ["msg.compression", "lz4"]),
    ("/map/update", GRID, "msg.compression", "gzip", ["msg.data", "gzip"]),
    ("/map/update", GRID, "msg.data", "not base64!", ["msg.data", "base64"]),
    ("/map/update", GRID, "msg.data", MISSING, ["msg.data", "missing"]),
    ("/map/update", GRID, "msg.data", [101] * 4800, ["msg.data", "101"]),
    ("/map/update", GRID, "msg.data", ["a"] * 4800, ["msg.data[0]", "integer", "string"]),
    ("/map/update", GRID, "msg", MISSING, ["msg", "missing"]),
    ("/map/update", CLOUD, "msg.point_step", 0, ["msg.point_step", "0"]),
    ("/map/update", CLOUD, "msg.point_step", 11, ["msg.fields[2]", "point_step"]),
    ("/map/update", CLOUD, "msg.point_step", 13, ["msg.data", "13"]),
    ("/map/update", CLOUD, "msg.fields.0.offset", 4294967295, ["msg.fields[0]"]),
    ("/map/update", CLOUD, "msg.fields.1.name", "w", ["msg.fields", "y"]),
    ("/map/update", CLOUD, "msg.fields.2.datatype", 5, ["msg.fields"]),
    ("/map/update", CLOUD, "msg.fields.2.datatype", 9, ["msg.fields[2].datatype"]),
    ("/map/update", CLOUD, "msg.fields.0.datatype", 8, ["msg.fields[1].datatype", "as for"]),
    ("/map/update", CLOUD, "msg.fields.0.count", 0, ["msg.fields[0].count"]),
    ("/map/update", CLOUD, "msg.fields.0.count", 2, ["msg.fields[0].count", "expected 1"]),
    ("/map/update", CLOUD, "msg.fields.1.name", "x", ["msg.fields", "one field", "got 2"]),
    ("/map/update", CLOUD, "msg.fields", [], ["msg.fields"]),
    ("/state/update", STATE, "poses", MISSING, ["poses", "missing"]),
    ("/state/update", STATE, "poses.0.name", MISSING, ["poses[0].name", "missing"]),
    ("/state/update", STATE, "poses.0.name", "bad-name", ["poses[0].name", "10", "bad-name"]),
    ("/state/update", STATE, "poses.0.position.x", "1", ["poses[0].position.x", "string"]),
    ("/state/update", STATE, "header.stamp", "now", ["header.stamp", "string"]),
    ("/state/update", STATE, "header.frame_id", "map", ["header.frame_id", "darpa"]),
    ("/markers/update", MARKERS, "markers", MISSING, ["markers", "missing"]),
    ("/markers/update", MARKERS, "markers.0.type", 99, ["markers[0].type", "99"]),
    ("/markers/update", MARKERS, "markers.0.id", 1.5, ["markers[0].id", "1.5"]),
    ("/markers/update", MARKERS, "markers.0.ns", 5, ["markers[0].ns", "string"]),
    ("/markers/update", MARKERS, "markers.0.points", [{"x": 1}], ["markers[0].points[0].y", "missing"]),
    ("/markers/update", MARKERS, "markers.0.action", 1, ["markers[0].action"]),
    ("/markers/update", MARKERS, "markers.0.pose", MISSING, ["markers[0].pose", "missing"]),
    ("/markers/update", MARKERS, "markers.0.color.a", 2, ["markers[0].color.a"]),
    ("/markers/update", MARKERS, "markers.0.lifetime", -1, ["markers[0].lifetime"]),
    ("/api/artifact_reports", REPORT, "y", MISSING, ["y", "missing"]),
    ("/api/artifact_reports", REPORT, "x", "1", ["x", "string"]),
    ("/api/artifact_reports", REPORT, "type", "test", ["type", "test"]),
    ("/api/artifact_reports", REPORT, "type", 5, ["type"]),
]

# (body, what it is): not JSON by RFC 8259, in a report's place
NOT_JSON = [(b"", "nothing"), (b"{", "cut short"), (b'{"x":01}', "a leading zero"), (b'{"x":1}{}', "trailing bytes"),
            (b'{"x":"\x01"}', "a raw control character"), (b'{"x":"\\q"}', "a bad escape"),
            (b'{"x":"\\ud800"}', "a lone surrogate"), (b'\xef\xbb\xbf{}', "a byte order mark"), (b'{"x":1}\x00', "a NUL"),
            (b"[" * 65 + b"]" * 65, "nesting over 64"), (b'{"x":NaN}', "NaN"), (b'{"x":"\xff"}', "no UTF-8")]


def setUpModule():
    hosts.needs_namespaces()


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stage = cls.enterClassContext(Stage())
        cls.session = requests.Session()

    def tearDown(self):
        sent = [request for request in self.stage.post.requests() if request["method"] == "POST"]
        self.assertEqual(sent, [], "nothing that was refused may leave")

    def send(self, uri, content, content_type="application/json", token=programs.TEAM_TOKEN, method="POST", **headers):
        headers = {"Authorization": f"Bearer {token}", "Content-Type": content_type,
                   **{name.replace("_", "-"): value for name, value in headers.items()}}
        return self.session.request(method, self.stage.box.url + uri, data=content, headers=headers, timeout=20)

    def refused(self, answer, status, words=()):
        self.assertEqual(answer.status_code, status, answer.text)
        self.assertEqual(answer.headers["Content-Type"], "application/json")
        sentence = answer.json()
        self.assertIsInstance(sentence, str)
        for word in words:
            self.assertIn(word, sentence)

    def test_each_field_by_its_name(self):
        for uri, message, path, value, words in FIELDS:
            formats = ("json",) if uri.startswith("/api") or value == "not base64!" else ("json", "cbor")
            for form in formats:
                with self.subTest(uri=uri, path=path, value=value if value is not MISSING else "missing", format=form):
                    made = changed(message, path, value)
                    if form == "cbor" and isinstance(made.get("msg", {}).get("data"), str):
                        made["msg"]["data"] = messages.base64.b64decode(made["msg"]["data"])
                    content = json.dumps(made).encode() if form == "json" else cbor2.dumps(made)
                    self.refused(self.send(uri, content, f"application/{form}"), 422, words)

    def test_the_sentence_of_the_icd_example(self):
        made = changed(GRID, "msg.data", messages.base64.b64encode(b"\0" * 4799).decode())
        answer = self.send("/map/update", json.dumps(made))
        self.assertEqual(answer.json(), "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799")

    def test_what_is_no_json(self):
        for uri in ("/api/artifact_reports", "/map/update", "/state/update"):
            for content, what in NOT_JSON:
                with self.subTest(what, uri=uri):
                    self.refused(self.send(uri, content), 400)

    def test_what_is_no_cbor(self):
        for content in (b"", b"\xa1", b"\x1c", b"\xff", b"\xa0\x00", b"\x5f\x61a\xff", b"\x61\xff", b"\x81" * 70):
            with self.subTest(content.hex()[:20]):
                self.refused(self.send("/map/update", content, "application/cbor"), 400)

    def test_a_member_given_twice(self):
        self.refused(self.send("/api/artifact_reports", b'{"x":1,"y":2,"z":3,"type":"Rope","x":4}'), 422, ["x", "twice"])

    def test_numbers_that_are_none(self):
        for value in (float("nan"), float("inf")):
            content = cbor2.dumps(changed(STATE, "poses.0.position.x", value))
            self.refused(self.send("/state/update", content, "application/cbor"), 422, ["poses[0].position.x"])

    def test_gzip_bombs_and_second_members(self):
        bomb = gzip.compress(b"\0" * (400 << 20), 9)
        whole = gzip.compress(b"\0" * 4800)
        for data, what, word in ((bomb, "a bomb", "4800 bytes of data, got more"), (whole * 2, "a second member", "msg.data"),
                                 (whole + b"\0", "a byte after its end", "msg.data"), (whole[:-3], "cut short", "msg.data")):
            with self.subTest(what):
                made = changed(changed(GRID, "msg.data", data), "msg.compression", "gzip")
                self.refused(self.send("/map/update", cbor2.dumps(made), "application/cbor"), 422, [word])
        cloud = changed(changed(CLOUD, "msg.data", bomb), "msg.compression", "gzip")
        self.refused(self.send("/map/update", cbor2.dumps(cloud), "application/cbor"), 422, ["msg.data"])

    def test_whole_bodies_that_are_bombs_or_lies(self):
        bomb = gzip.compress(b" " * (300 << 20) + b"{}", 9)
        self.assertIn(self.send("/state/update", bomb, Content_Encoding="gzip").status_code, (400, 413))
        self.refused(self.send("/state/update", b"no gzip", Content_Encoding="gzip"), 400, ["gzip"])
        self.refused(self.send("/state/update", zlib.compress(b"{}") + b"x", Content_Encoding="deflate"), 400)
        self.refused(self.send("/state/update", b"{}", Content_Encoding="br"), 422, ["Content-Encoding"])

    def test_tokens(self):
        body = json.dumps(STATE)
        for token in ("", "wrong", programs.TEAM_TOKEN + "x", programs.TEAM_TOKEN[:-1]):
            with self.subTest(token):
                answer = self.send("/state/update", body, token=token)
                self.refused(answer, 401)
                self.assertNotIn("WWW-Authenticate", answer.headers)
                self.assertNotIn(programs.TEAM_TOKEN, answer.text)
        self.refused(self.session.post(self.stage.box.url + "/state/update", data=body), 401)

    def test_a_large_body_without_a_token_is_not_taken_in(self):
        self.refused(self.send("/map/update", b"x" * (20 << 20), token="wrong"), 401)

    def test_content_types_uris_and_methods(self):
        body = json.dumps(STATE)
        self.refused(self.send("/state/update", body, "text/plain"), 422, ["Content-Type"])
        self.refused(self.send("/api/artifact_reports", cbor2.dumps(REPORT), "application/cbor"), 422, ["Content-Type"])
        self.refused(self.send("/map/updates", body), 404)
        self.refused(self.send("/state/update", None, method="GET"), 405)
        self.refused(self.send("/api/status", body), 405)

    def test_no_token_ever_shows(self):
        said = self.stage.box.said() + json.dumps(self.stage.box.ask("GET /adit/run"))
        for token in (programs.SCORING_TOKEN, programs.MAPPING_TOKEN, programs.TEAM_TOKEN):
            self.assertNotIn(token, said)

    def test_preflights_need_no_token(self):
        answer = self.session.options(self.stage.box.url + "/api/artifact_reports",
                                      headers={"Origin": "http://station", "Access-Control-Request-Method": "POST",
                                               "Access-Control-Request-Headers": "authorization,content-type"})
        self.assertEqual(answer.status_code, 204)
        self.assertEqual(answer.headers["Access-Control-Allow-Origin"], "*")
        self.assertIn("POST", answer.headers["Access-Control-Allow-Methods"])
        self.assertIn("authorization", answer.headers["Access-Control-Allow-Headers"].lower())
