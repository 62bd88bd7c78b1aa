"""The tables of firmware/doors/intake/clients/refusals.md: requests, and the status and sentence with which Adit rejects each."""

import copy
import gzip
import json
import re

import cbor2
import requests

import maps
import messages
import programs
from programs import Stage
from reporting import QUICK, REPORT, began, submit

JSON = messages.Style()
GRID = messages.map_update(maps.made_grid(80, 60), "r1", 5.0, JSON)
CLOUD = messages.map_update(maps.made_cloud(100), "r1", 5.0, JSON)
PLACE = {"position": {"x": 1, "y": 2, "z": 3}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
STATE = {"header": {"stamp": 5.0, "frame_id": "darpa"}, "poses": [{"name": "r1", **PLACE}]}
MARKERS = {"markers": [{"ns": "path", "id": 1, "type": 2, "action": 0, "pose": PLACE, "scale": {"x": 1, "y": 1, "z": 1},
                        "color": {"r": 1, "g": 0, "b": 0, "a": 1}}]}
MISSING = object()


def changed(message, path, value):
    """A copy with the member at `path` ("msg.info.width") set or removed."""
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


# (URI, message, field, value)
FIELDS = [
    ("/map/update", GRID, "type", "Octomap"),
    ("/map/update", GRID, "type", MISSING),
    ("/map/update", GRID, "name", "a name too long"),
    ("/map/update", GRID, "msg.header.frame_id", "world"),
    ("/map/update", GRID, "msg.header.stamp", -1),
    ("/map/update", GRID, "msg.info.width", 79),
    ("/map/update", GRID, "msg.info.width", "80"),
    ("/map/update", GRID, "msg.info.height", 0),
    ("/map/update", GRID, "msg.info.resolution", 0),
    ("/map/update", GRID, "msg.info.resolution", 1e39),
    ("/map/update", GRID, "msg.info.origin.position.y", MISSING),
    ("/map/update", GRID, "msg.compression", "lz4"),
    ("/map/update", GRID, "msg.compression", "gzip"),
    ("/map/update", GRID, "msg.data", "not base64!"),
    ("/map/update", GRID, "msg.data", MISSING),
    ("/map/update", GRID, "msg.data", [101] * 4800),
    ("/map/update", GRID, "msg.data", ["a"] * 4800),
    ("/map/update", GRID, "msg", MISSING),
    ("/map/update", CLOUD, "msg.point_step", 0),
    ("/map/update", CLOUD, "msg.point_step", 11),
    ("/map/update", CLOUD, "msg.point_step", 13),
    ("/map/update", CLOUD, "msg.fields.0.offset", 4294967295),
    ("/map/update", CLOUD, "msg.fields.1.name", "w"),
    ("/map/update", CLOUD, "msg.fields.2.datatype", 5),
    ("/map/update", CLOUD, "msg.fields.2.datatype", 9),
    ("/map/update", CLOUD, "msg.fields.0.datatype", 8),
    ("/map/update", CLOUD, "msg.fields.0.count", 0),
    ("/map/update", CLOUD, "msg.fields.0.count", 2),
    ("/map/update", CLOUD, "msg.fields.1.name", "x"),
    ("/map/update", CLOUD, "msg.fields", []),
    ("/state/update", STATE, "poses", MISSING),
    ("/state/update", STATE, "poses.0.name", MISSING),
    ("/state/update", STATE, "poses.0.name", "bad-name"),
    ("/state/update", STATE, "poses.0.position.x", "1"),
    ("/state/update", STATE, "poses.0.orientation.w", 1e-9),
    ("/state/update", STATE, "header.stamp", "now"),
    ("/state/update", STATE, "header.stamp", 1800000000000),
    ("/state/update", STATE, "header.frame_id", "map"),
    ("/markers/update", MARKERS, "markers", MISSING),
    ("/markers/update", MARKERS, "markers.0.type", 99),
    ("/markers/update", MARKERS, "markers.0.id", 1.5),
    ("/markers/update", MARKERS, "markers.0.ns", 5),
    ("/markers/update", MARKERS, "markers.0.points", [{"x": 1}]),
    ("/markers/update", MARKERS, "markers.0.action", 1),
    ("/markers/update", MARKERS, "markers.0.pose", MISSING),
    ("/markers/update", MARKERS, "markers.0.color.a", 2),
    ("/markers/update", MARKERS, "markers.0.lifetime", -1),
    ("/markers/update", MARKERS, "markers.0.lifetime", 1e300),
    ("/api/artifact_reports", REPORT, "y", MISSING),
    ("/api/artifact_reports", REPORT, "x", "1"),
    ("/api/artifact_reports", REPORT, "type", "test"),
    ("/api/artifact_reports", REPORT, "type", "Cellphone"),
    ("/api/artifact_reports", REPORT, "type", 5),
]

SHORT = {**QUICK, "reports__answer_within_ms": 300}
STATE_BODY = json.dumps(STATE)
TAGGED = cbor2.dumps({**STATE, "poses": [{**STATE["poses"][0], "position": {"x": cbor2.CBORTag(4, [-1, 15]), "y": 2, "z": 3}}]})
REFERENCES = cbor2.dumps({"poses": [STATE["poses"][0]] * 2}, string_referencing=True)
UTF_16 = STATE_BODY.encode("utf-16")
POSE = STATE["poses"][0]
TWO_BAD = json.dumps({"poses": [{**POSE, "name": 1}, POSE, {**POSE, "position": {}}]})

# (row title, method, URI, body, additional headers)
REQUESTS = [
    ("a wrong token", "POST", "/state/update", STATE_BODY, {"Authorization": "Bearer wrong"}),
    ("no token", "POST", "/state/update", STATE_BODY, {"Authorization": None}),
    ("`Basic` for `Bearer`", "POST", "/state/update", STATE_BODY, {"Authorization": "Basic dGVhbTp4"}),
    ("a URI that the ICD does not have", "POST", "/map/updates", "{}", {}),
    ("`GET /map/update`", "GET", "/map/update", None, {}),
    ("`Content-Type: text/plain`", "POST", "/state/update", STATE_BODY, {"Content-Type": "text/plain"}),
    ("a report as CBOR", "POST", "/api/artifact_reports", b"\xa0", {"Content-Type": "application/cbor"}),
    ("`Content-Encoding: br`", "POST", "/state/update", STATE_BODY, {"Content-Encoding": "br"}),
    ("`Content-Encoding: gzip` without gzip", "POST", "/state/update", STATE_BODY, {"Content-Encoding": "gzip"}),
    ("gzip without `Content-Encoding`", "POST", "/state/update", gzip.compress(STATE_BODY.encode()), {}),
    ("half a JSON document", "POST", "/state/update", '{"poses": [', {}),
    ("half a CBOR document", "POST", "/state/update", b"\xa1", {"Content-Type": "application/cbor"}),
    ("`NaN` in JSON", "POST", "/api/artifact_reports", '{"x": NaN}', {}),
    ("UTF-16", "POST", "/state/update", UTF_16, {}),
    ("CBOR as JSON", "POST", "/state/update", cbor2.dumps(STATE), {}),
    ("JSON as CBOR", "POST", "/state/update", STATE_BODY, {"Content-Type": "application/cbor"}),
    ("a list around the message", "POST", "/state/update", "[]", {}),
    ("a state of 2 MB", "POST", "/state/update", b" " * 2_000_000, {}),
    ("a CBOR tag that changes the value", "POST", "/state/update", TAGGED, {"Content-Type": "application/cbor"}),
    ("CBOR with string references", "POST", "/state/update", REFERENCES, {"Content-Type": "application/cbor"}),
    ("a report without members", "POST", "/api/artifact_reports", "{}", {}),
    ("a grid without `msg` around it", "POST", "/map/update", json.dumps({**GRID["msg"], "type": "OccupancyGrid"}), {}),
    ("a pose in a member `pose`, as in ROS", "POST", "/state/update", json.dumps({"poses": [{"name": "r1", "pose": PLACE}]}), {}),
    ("three poses, two of them wrong", "POST", "/state/update", TWO_BAD, {}),
    ("a member twice", "POST", "/api/artifact_reports", '{"x": 1, "y": 2, "z": 3, "type": "Rope", "x": 4}', {}),
    ("`Adit-Resubmit: maybe`", "POST", "/api/artifact_reports", json.dumps(REPORT), {"Adit-Resubmit": "maybe"}),
]

# Rejections that need many clients, a full disk or a stop, and have their own tests: (row title, status, the code's
# sentence).
ELSEWHERE = [
    ("a map, if the queue is full", 429, "the queue is full: N maps, N MB; this map was not accepted, send it again later"),
    ("markers, if the queue is full", 429,
     "not accepted: the queue of markers is full (queues.marker_bytes); send it again later"),
    ("markers that partly replace queued markers, if the queue is full", 429,
     "N of N markers were accepted, because they replace queued markers; the queue has no room for new markers"
     " (queues.marker_bytes); send them again later"),
    ("a state with new robots, if 1,000 are queued", 429, "not accepted: too many robots; send it again later"),
    ("a report, if 1,000 are queued", 429, "N reports are queued already; this report was not accepted"),
    ("a report, if the disk is full", 503, "the report could not be stored and was not accepted; post it again"),
    ("a map, if Adit has no memory to store it", 503, "Adit cannot store this map; send it again later"),
    ("a request, if too many arrive at once", 503, "too many requests at once, from this address or in total; try again"),
    ("a state or report, if too many bytes arrive at once", 503,
     "too many bytes at once, from this address or in total; send this message again later"),
    ("a map, if too many bytes arrive at once", 429, "too many maps at once; send this map again later"),
    ("markers, if too many bytes arrive at once", 429, "too many markers at once; send these markers again later"),
    ("any message while aditd stops", 503, "the box is stopping; this message was not accepted, send it again"),
    ("a body that arrives too slowly", 408, "the body of the request took too long"),
    ("a token after many wrong ones", 429,
     "too many wrong tokens from this address; this token was not checked; try again in a second"),
    ("any message, after a fault inside Adit", 500, "Adit could not finish this request and may have accepted it; send it again"),
]


def shown(value):
    if value is MISSING:
        return "left out"
    long = isinstance(value, list) and len(value) > 2
    return f"`{json.dumps(value[:2])[:-1]}, ...]`" if long else f"`{json.dumps(value)}`"


def ask(stage, method, uri, body=None, headers=()):
    given = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json", **dict(headers)}
    return requests.request(method, stage.box.url + uri, data=body, headers=given, timeout=30)


def of_requests():
    """For each URI: the row titles with the answers."""
    with Stage() as stage:
        began(stage)
        yield "any", [(what, ask(stage, method, uri, body, headers)) for what, method, uri, body, headers in REQUESTS]
        for uri in ("/api/artifact_reports", "/map/update", "/state/update", "/markers/update"):
            fields = [each[1:] for each in FIELDS if each[0] == uri]
            yield uri, [(f"`{path}` {shown(value)}", ask(stage, "POST", uri, json.dumps(changed(message, path, value))))
                        for message, path, value in fields]


def of_reports():
    """Row titles with the answers to a report or a status that the Command Post has not answered."""
    with Stage(post_options=None, **SHORT) as stage:
        yield "a report, if the Command Post cannot be reached", submit(stage)
        yield "a status, if the Command Post cannot be reached", ask(stage, "GET", "/api/status")
    with Stage(**{**SHORT, "reports__doubt_for_ms": 20000}) as stage:
        began(stage).post.will("drop")
        yield "a report whose answer is lost, while Adit asks for the status", submit(stage)
    with Stage(**SHORT, reports__review="all") as stage:
        began(stage)
        yield "a report that is held for the operator", submit(stage)
        stage.box.judge(1, "withdraw")
        yield "a report that the operator has withdrawn", submit(stage)


def sentence(answer):
    """The sentence, with "(why)" in place of a varying reason in parentheses."""
    return re.sub(r"\((?!the setting)[^)]*\)", "(why)", answer.json()).partition(": no route")[0]


def table():
    lines = []

    def row(*cells):
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")

    def group(title, rows):
        row(title, "status", "sentence")
        row("---", "---", "---")
        for what, status, said in rows:
            row(what, status, f"`{said}`")
        lines.append("")

    for uri, answers in of_requests():
        title = "any URI" if uri == "any" else f"`{uri}`"
        group(title, [(what, answer.status_code, answer.json()) for what, answer in answers])
    group("no answer from the Command Post", [(what, answer.status_code, sentence(answer)) for what, answer in of_reports()])
    group("no mistake of the client", ELSEWHERE)
    return "\n".join(lines)
