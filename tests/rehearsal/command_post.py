"""Starts the real adit-rehearsal for a test, and makes messages for it."""

import base64
import copy
import gzip
import json
import os
import re
import signal
import socket
import struct
import subprocess
import tempfile
import time

import cbor2
import requests

from patience import patient

SCORING_TOKEN = "flux230{showroom"
MAPPING_TOKEN = "dark-adit#000042"


class CommandPost:
    """`with CommandPost("--as-measured") as post:` The rate limit is off unless options say otherwise."""

    def __init__(self, *options, artifacts=None, transcript=False, rate=0):
        self.folder = tempfile.TemporaryDirectory()
        for name, token in (("scoring", SCORING_TOKEN), ("mapping", MAPPING_TOKEN)):
            self.write(f"{name}.token", token + "\n")
        self.transcript = os.path.join(self.folder.name, "transcript")
        any_port = "127.0.0.1:0"
        self.command = [os.path.join(os.environ["ADIT_BIN"], "adit-rehearsal"), "--scoring", any_port, "--mapping", any_port,
                        "--control", any_port, "--secrets", self.folder.name, *options]
        if rate is not None:
            self.command += ["--rate", str(rate)]
        if artifacts is not None:
            self.command += ["--artifacts", self.write("artifacts.csv", artifacts)]
        if transcript:
            self.command += ["--transcript", self.transcript]

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def __enter__(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.first_line = self.process.stdout.readline()
        match = re.fullmatch(r"adit-rehearsal: scoring (\S+) mapping (\S+) control (\S+)\n", self.first_line)
        if match is None:
            self.process.kill()
            raise RuntimeError(self.first_line + self.process.communicate()[1])
        self.scoring, self.mapping, self.control = match.groups()
        return self

    def __exit__(self, *_):
        err = self.stop()[2] if self.process.poll() is None else ""
        self.process.stdout.close()
        self.process.stderr.close()
        self.folder.cleanup()
        if self.process.returncode not in (0, 3):  # 3: killed by a message, as the measured server is
            raise AssertionError(f"exit code {self.process.returncode}: {err}")

    def stop(self, how=signal.SIGTERM):
        """Returns the exit code and the output."""
        self.process.send_signal(how)
        out, err = self.process.communicate(timeout=patient(90))
        return self.process.returncode, out, err

    # The scoring endpoint
    def status(self, **headers):
        return self.scoring_request("GET", "/api/status", None, headers)

    def report(self, body, **headers):
        return self.scoring_request("POST", "/api/artifact_reports", body, headers)

    def scoring_request(self, method, path, body=None, headers=None, **how):
        all_headers = {"Authorization": f"Bearer {SCORING_TOKEN}"}
        if body is not None:
            all_headers["Content-Type"] = "application/json"
        return self.request(self.scoring, method, path, body, {**all_headers, **(headers or {})}, **how)

    # The mapping endpoint
    def map(self, body, **headers):
        return self.mapping_request("POST", "/map/update", body, headers)

    def mapping_request(self, method, path, body=None, headers=None, **how):
        """A body of bytes is sent unchanged, any other as JSON."""
        all_headers = {"Authorization": f"Bearer {MAPPING_TOKEN}", "Content-Type": "application/json"}
        return self.request(self.mapping, method, path, body, {**all_headers, **(headers or {})}, **how)

    def map_cbor(self, body):
        return self.map(cbor2.dumps(body), **{"Content-Type": "application/cbor"})

    def request(self, where, method, path, body, headers, **how):
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        headers = {name.replace("_", "-"): value for name, value in headers.items()}
        with requests.Session() as session:  # a connection of its own
            session.trust_env = False
            return session.request(method, f"http://{where}{path}", data=data, headers=headers, timeout=patient(60), **how)

    # The control port
    def tell(self, action, body=None):
        return self.request(self.control, "POST", "/" + action, body, {})

    def faults(self, **queues):
        """post.faults(reports=["record-then-drop", "ok"], status=["500"])"""
        answer = self.tell("faults", queues)
        if answer.status_code != 200:
            raise AssertionError(answer.text)

    def faults_left(self):
        return self.request(self.control, "GET", "/faults", None, {}).json()

    def record(self):
        return self.request(self.control, "GET", "/record", None, {}).json()

    def lines(self, name="requests.jsonl"):
        with open(os.path.join(self.transcript, name), encoding="utf-8") as file:
            return [json.loads(line) for line in file]


def two_at_once(first, second=None):
    """The statuses of two requests within a second: `first()` and `second()`, or `first()` twice. Repeats both if this machine took
    longer."""
    for _ in range(20):
        begun = time.monotonic()
        statuses = [first().status_code, (second or first)().status_code]
        if time.monotonic() - begun < 1:
            return statuses
        time.sleep(1)
    raise AssertionError("two requests take longer than a second")


def connect(where):
    """A bare TCP connection."""
    host, port = where.rsplit(":", 1)
    return socket.create_connection((host, int(port)), timeout=patient(30))


def read_answer(stream):
    """Reads one answer from a bare connection: its status, its headers (lower case) and its body; None at the end."""
    reader = stream.makefile("rb")
    first = reader.readline().decode()
    if not first:
        return None
    headers = {}
    for line in iter(lambda: reader.readline().decode().strip(), ""):
        name, value = line.split(":", 1)
        headers[name.lower()] = value.strip()
    return int(first.split()[1]), headers, reader.read(int(headers.get("content-length", 0)))


POSE = {"position": {"x": 1.5, "y": -2.0, "z": 0.25}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}


def changed(message, **changes):
    """A copy of `message` with members set by path: changed(grid(), msg__info__width=3). DROP removes a member."""
    result = copy.deepcopy(message)
    for path, value in changes.items():
        *parents, last = (int(part) if part.isdigit() else part for part in path.split("__"))
        place = result
        for part in parents:
            place = place[part]
        if value is DROP:
            del place[last]
        else:
            place[last] = value
    return result


DROP = object()


def coded(data, cbor, compression):
    data = gzip.compress(data) if compression == "gzip" else data
    return data if cbor else base64.b64encode(data).decode()


def grid(cells=bytes([0, 100, 255, 50, 19, 20]), width=3, height=2, name="X1", cbor=False, compression="none"):
    return {"type": "OccupancyGrid", "name": name,
            "msg": {"header": {"stamp": 1.0, "frame_id": "darpa"},
                    "info": {"resolution": 0.2, "width": width, "height": height, "origin": POSE},
                    "data": coded(cells, cbor, compression), "compression": compression}}


def fields(datatype=7, size=4, names=("x", "y", "z")):
    return [{"name": name, "offset": i * size, "datatype": datatype, "count": 1} for i, name in enumerate(names)]


POINTS = struct.pack("<6f", 1, 2, 3, 4, 5, 6)


def cloud(data=POINTS, point_step=12, schema=None, name="X2", cbor=False, compression="none"):
    return {"type": "PointCloud2", "name": name,
            "msg": {"header": {"stamp": 1.0, "frame_id": "darpa"}, "origin": POSE, "fields": schema or fields(),
                    "is_bigendian": False, "point_step": point_step,
                    "data": coded(data, cbor, compression), "compression": compression}}


def state(*names):
    return {"header": {"stamp": 1.0, "frame_id": "darpa"}, "poses": [{"name": name, **POSE} for name in names]}


def marker(**changes):
    whole = {"header": {"stamp": 1.0, "frame_id": "darpa"}, "ns": "artifacts", "id": 7, "type": 2, "action": 0,
             "pose": POSE, "scale": {"x": 1, "y": 1, "z": 1}, "color": {"r": 1, "g": 0.5, "b": 0, "a": 1},
             "lifetime": 0, "text": "backpack"}
    return {"markers": [changed(whole, **changes)]}
