"""The worst honest robot, KIND HOST PORT TOKEN: posts a large, hardly compressible message each second, until it is stopped."""

import http.client
import json
import random
import sys
import time

import cbor2
from uploads_maps import POSE, grid, header

UNIT = {"x": 1.0, "y": 1.0, "z": 1.0}
CHANCE = random.Random(6)


def noise(at):
    """A grid of 2500 x 2500 cells with one of two random values."""
    cells = CHANCE.randbytes(2500 * 2500).translate(bytes(100 * (value & 1) for value in range(256)))
    return cbor2.dumps(grid(2500, cells, at) | {"name": "worst"})


def organised(at):
    """A camera's cloud of 640 x 480 points with padding, 9.8 MB, in which all bits of all numbers are random."""
    width, height = 640, 480
    point = [{"name": name, "offset": 4 * place, "datatype": 7, "count": 1} for place, name in enumerate("xyz")]
    fields = [*point, {"name": "rgb", "offset": 16, "datatype": 6, "count": 1}]
    data = bytearray(CHANCE.randbytes(32 * width * height))
    for place in (3, 7, 11):  # of each coordinate the highest byte: values near one, never infinite
        data[place::32] = b"\x3f" * (width * height)
    msg = {"fields": fields, "is_bigendian": False, "point_step": 32, "row_step": 32 * width, "width": width, "height": height,
           "is_dense": True, "data": bytes(data)}
    return cbor2.dumps({"type": "PointCloud2", "name": "worst", "msg": {"header": header(at), **msg}})


def marker(at, number, **fields):
    return {"header": header(at), "ns": "worst", "id": number, "action": 0, "pose": POSE, "scale": UNIT,
            "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0}, **fields}


def points(at):
    """A CUBE_LIST of 50,000 points, each with a colour."""
    places = [{"x": CHANCE.random(), "y": CHANCE.random(), "z": CHANCE.random()} for _ in range(50_000)]
    colors = [{"r": CHANCE.random(), "g": CHANCE.random(), "b": CHANCE.random(), "a": 1.0} for _ in range(50_000)]
    return json.dumps({"markers": [marker(at, 0, type=6, points=places, colors=colors)]}).encode()


def markers(at):
    """As many markers as fit into the 8.4 MB of one message, nearly."""
    return json.dumps({"markers": [marker(at, number, type=1) for number in range(25_000)]}).encode()


def main(kind, host, port, token):
    uri = "/markers/update" if kind in (points, markers) else "/map/update"
    form = "application/json" if kind in (points, markers) else "application/cbor"
    first = time.time()
    once, answers = kind(first), {}
    began, posted = time.monotonic(), 0
    while True:
        at = time.time()
        body = once.replace(json.dumps(first).encode(), json.dumps(at).encode()) if form.endswith("json") else kind(at)
        connection = http.client.HTTPConnection(host, port, timeout=60)
        try:
            connection.request("POST", uri, body, {"Authorization": f"Bearer {token}", "Content-Type": form})
            answer = connection.getresponse()
            status, text = answer.status, answer.read()
        except (BrokenPipeError, ConnectionResetError):  # a proxy that answers 429 before it has read the body
            status, text = "closed", b""
        connection.close()
        if status not in (200, 429, "closed"):
            sys.exit(f"answered {status} {text[:300]!r}")
        answers[status] = answers.get(status, 0) + 1
        print(answers, flush=True)
        posted += 1
        time.sleep(max(0, began + posted - time.monotonic()))


if __name__ == "__main__":
    main(globals()[sys.argv[1]], sys.argv[2], int(sys.argv[3]), sys.argv[4])
