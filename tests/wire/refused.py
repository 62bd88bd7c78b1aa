"""The table of refusals in firmware/intake/clients/README.md: what is sent, and what Adit says to it."""

import copy
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
UTF_16 = STATE_BODY.encode("utf-16")
POSE = STATE["poses"][0]
TWO_BAD = json.dumps({"poses": [{**POSE, "name": 1}, POSE, {**POSE, "position": {}}]})

# (what is sent, method, URI, body, headers in addition)
REQUESTS = [
    ("another token, or none", "POST", "/state/update", STATE_BODY, {"Authorization": "Bearer wrong"}),
    ("a URI that the ICD does not have", "POST", "/map/updates", "{}", {}),
    ("`GET /map/update`", "GET", "/map/update", None, {}),
    ("`Content-Type: text/plain`", "POST", "/state/update", STATE_BODY, {"Content-Type": "text/plain"}),
    ("a report as CBOR", "POST", "/api/artifact_reports", b"\xa0", {"Content-Type": "application/cbor"}),
    ("`Content-Encoding: br`", "POST", "/state/update", STATE_BODY, {"Content-Encoding": "br"}),
    ("`Content-Encoding: gzip`, and it is not", "POST", "/state/update", STATE_BODY, {"Content-Encoding": "gzip"}),
    ("half a JSON document", "POST", "/state/update", '{"poses": [', {}),
    ("half a CBOR document", "POST", "/state/update", b"\xa1", {"Content-Type": "application/cbor"}),
    ("`NaN`, which JSON does not have", "POST", "/api/artifact_reports", '{"x": NaN}', {}),
    ("UTF-16", "POST", "/state/update", UTF_16, {}),
    ("CBOR as JSON", "POST", "/state/update", cbor2.dumps(STATE), {}),
    ("JSON as CBOR", "POST", "/state/update", STATE_BODY, {"Content-Type": "application/cbor"}),
    ("a list around the message", "POST", "/state/update", "[]", {}),
    ("a state of 2 MB", "POST", "/state/update", b" " * 2_000_000, {}),
    ("a CBOR tag that changes a meaning", "POST", "/state/update", TAGGED, {"Content-Type": "application/cbor"}),
    ("three poses, two of them wrong", "POST", "/state/update", TWO_BAD, {}),
    ("a member twice", "POST", "/api/artifact_reports", '{"x": 1, "y": 2, "z": 3, "type": "Rope", "x": 4}', {}),
    ("`Adit-Resubmit: maybe`", "POST", "/api/artifact_reports", json.dumps(REPORT), {"Adit-Resubmit": "maybe"}),
]

# What takes a crowd, a full disk or a stop to make, and has tests of its own: (what happened, status, the code's sentence).
ELSEWHERE = [
    ("a map, where the queue is full", 429, "the queue is full: N maps, N MB; this map was not accepted, send it again later"),
    ("markers, where as many wait as can", 429,
     "not accepted: the queue of markers is full (queues.marker_bytes); send it again later"),
    ("markers, of which some change others that wait, and there is no room for new ones", 429,
     "N of N markers were accepted, because they replace queued markers; the queue has no room for new markers"
     " (queues.marker_bytes); send them again later"),
    ("a state of more robots than any team has", 429, "not accepted: too many robots; send it again later"),
    ("a report, where 1,000 wait", 429, "N reports are queued already; this report was not accepted"),
    ("a report, where the disk is full", 503, "the report could not be stored and was not accepted; post it again"),
    ("a map, where there is no room to keep it", 503, "Adit cannot store this map; send it again later"),
    ("too many requests at once", 503, "too many requests at once, from this address or in total; try again"),
    ("too many bytes of states and reports at once", 503,
     "too many bytes at once, from this address or in total; send this message again later"),
    ("too many bytes of maps at once", 429, "too many maps at once; send this map again later"),
    ("too many bytes of markers at once", 429, "too many markers at once; send these markers again later"),
    ("whatever comes while Adit stops", 503, "aditd is stopping; this message was not accepted, send it again"),
    ("a body that comes too slowly", 408, "the body of the request took too long"),
    ("one of many wrong tokens", 429,
     "too many wrong tokens from this address; this token was not checked; try again in a second"),
    ("a fault of Adit's own", 500, "Adit could not finish this request and may have accepted it; send it again"),
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
    """Groups of what is sent and what was answered, by the URI."""
    with Stage() as stage:
        began(stage)
        yield "any", [(what, ask(stage, method, uri, body, headers)) for what, method, uri, body, headers in REQUESTS]
        for uri in ("/api/artifact_reports", "/map/update", "/state/update", "/markers/update"):
            fields = [each[1:] for each in FIELDS if each[0] == uri]
            yield uri, [(f"`{path}` {shown(value)}", ask(stage, "POST", uri, json.dumps(changed(message, path, value))))
                        for message, path, value in fields]


def of_reports():
    """What is told of a report that is not done yet, or is not to be."""
    with Stage(post_options=None, **SHORT) as stage:
        yield "the Command Post cannot be reached", submit(stage)
        yield "and the run's status is asked for", ask(stage, "GET", "/api/status")
    with Stage(**{**SHORT, "reports__doubt_for_ms": 20000}) as stage:
        began(stage).post.will("drop")
        yield "its answer is lost, and Adit still asks", submit(stage)
    with Stage(**SHORT, reports__review="all") as stage:
        began(stage)
        yield "it is held for the operator", submit(stage)
        stage.box.judge(1, "withdraw")
        yield "the operator withdrew it", submit(stage)


def sentence(answer):
    """Where it says why in brackets, that is left out: it depends on the day."""
    return re.sub(r"\((?!the setting)[^)]*\)", "(why)", answer.json()).partition(": no route")[0]


def table():
    lines = []

    def row(*cells):
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")

    def group(title, rows):
        row(title, "status", "sentence")
        row("---", "---", "---")
        for what, status, said in rows:
            row(what, status, said)
        lines.append("")

    for uri, answers in of_requests():
        title = "any of the URIs" if uri == "any" else f"`{uri}`"
        group(title, [(what, answer.status_code, answer.json()) for what, answer in answers])
    group("a report that waits", [(what, answer.status_code, sentence(answer)) for what, answer in of_reports()])
    group("what is nobody's mistake", ELSEWHERE)
    return "\n".join(lines)
