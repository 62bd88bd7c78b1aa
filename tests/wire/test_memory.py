"""Messages that are short as bytes and long in memory use little memory, and other clients are answered meanwhile. Rejected messages
are not stored, and memory of a peak is returned."""

import concurrent.futures
import contextlib
import json
import pathlib
import re
import unittest
import zlib

import cbor2
import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

BODY = 8 << 20
CBOR, JSON = "application/cbor", "application/json"
HEAD = b"\xa1\x67markers"
STATE = {"header": {"stamp": 1.0, "frame_id": "darpa"}, "poses": []}
POSE = {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
CLIENTS, ROUNDS = 8, 2
REST = 64 << 20  # bytes: all of it, beside what waits
BOMB = 300  # MiB: more than a map may be


def filled(head, one, tail, count=BODY):
    count = min(count, (BODY - len(head) - len(tail)) // len(one))
    return head + one * count + tail


# The largest bodies that are read, and the largest that fit.
HOSTILE = [
    (CBOR, filled(HEAD + b"\x9f\xbf", b"\x60\x00", b"\xff\xff", 999_000)),
    (CBOR, filled(HEAD + b"\x9f", b"\xa1\x60\x00", b"\xff", 499_000)),
    (CBOR, filled(HEAD + b"\x9f", b"\xa1\x66action\x02", b"\xff", 499_000)),
    (JSON, filled(b'{"markers":[{"":0', b',"":0', b"}]}", 998_000)),
    (CBOR, filled(HEAD + b"\x9f", b"\x00", b"\xff")),
    (CBOR, filled(HEAD + b"\x9f", b"\xa0", b"\xff")),
    (JSON, filled(b'{"markers":[0', b",0", b"]}")),
    (JSON, filled(b'{"markers":[{}', b",{}", b"]}")),
]


def bomb(head, filler, tail):
    """A map of 300 MiB as a gzip body of 300 kB."""
    packer = zlib.compressobj(9, wbits=31)
    return b"".join([packer.compress(head), *(packer.compress(filler * (1 << 20)) for _ in range(BOMB)), packer.compress(tail),
                     packer.flush()])


def bombs():
    """Rejected by the announced length, while inflating, and at the end of the data."""
    cloud = messages.map_update(maps.Cloud("none", maps.XYZ, 12, b""), None, 1.0, Style("cbor"))
    head = cbor2.dumps(cloud)
    head = head[:head.rindex(b"\x64data") + 5]
    yield CBOR, "gzip", bomb(head + b"\x5a" + (BOMB << 20).to_bytes(4, "big"), b"\0", b"")
    before, _, after = json.dumps({**cloud, "msg": {**cloud["msg"], "data": "HERE"}}).partition("HERE")
    yield JSON, "gzip", bomb(before.encode(), b"AAAA", after.encode())
    cloud["msg"] |= {"data": bomb(b"", b"\0", b""), "compression": "gzip"}
    yield CBOR, "identity", cbor2.dumps(cloud)


def largest_markers():
    """A marker with the maximum number of points and colors."""
    color = {"r": 0.1, "g": 0.2, "b": 0.3, "a": 0.9}
    marker = {"ns": "voxels", "id": 1, "type": 6, "action": 0, "pose": POSE, "scale": {"x": 1, "y": 1, "z": 1},
              "color": color, "points": [{"x": n / 7, "y": -n / 7, "z": 0.3} for n in range(100_000)]}
    yield JSON, json.dumps({"markers": [marker]}).encode()
    yield CBOR, cbor2.dumps({"markers": [marker | {"colors": [color] * 100_000}]})


class Memory(unittest.TestCase):
    def resident(self, stage, name):
        status = pathlib.Path(f"/proc/{stage.box.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(rf"{name}:\s+(\d+) kB", status)[1]) << 10

    def peak(self, stage):
        return self.resident(stage, "VmHWM")

    def test_many_rejected_maps_are_not_stored(self):
        with Stage() as stage, concurrent.futures.ThreadPoolExecutor(24) as clients:
            if self.peak(stage) > REST // 2:
                self.skipTest("a sanitizer's own memory is counted, too")

            def post(kind, coding, body):
                headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": kind,
                           "Content-Encoding": coding}
                with contextlib.suppress(requests.ConnectionError):  # answered, and closed, before its body was whole
                    return requests.post(stage.box.url + "/map/update", data=body, headers=headers,
                                         timeout=300).status_code
                return 413

            answers = list(clients.map(post, *zip(*list(bombs()) * 8)))
            self.assertLessEqual(set(answers), {413, 422, 429})
            peak = self.peak(stage)
            print(f"at most {peak >> 20} MiB", end=" ", flush=True)
            self.assertLess(peak, REST)

    def test_large_message_of_markers_is_not_parsed_into_a_tree(self):
        with Stage() as stage:
            if self.peak(stage) > REST // 2:
                self.skipTest("a sanitizer's own memory is counted, too")
            headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
            for kind, body in [*HOSTILE, *largest_markers()]:
                answer = requests.post(stage.box.url + "/markers/update", data=body, timeout=300,
                                       headers=headers | {"Content-Type": kind})
                peak = self.peak(stage)
                print(f"{answer.status_code} at {peak >> 20} MiB", end=" ", flush=True)
                self.assertLess(peak, REST, body[:40])
            self.assertEqual(answer.status_code, 200, answer.text)

    def test_many_hostile_markers_at_once(self):
        with Stage() as stage, concurrent.futures.ThreadPoolExecutor(CLIENTS) as clients:
            if self.peak(stage) > REST // 2:
                self.skipTest("a sanitizer's own memory is counted, too")

            def post(kind, body):
                headers = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": kind}
                return requests.post(stage.box.url + "/markers/update", data=body, headers=headers, timeout=120)

            under_way = [clients.submit(post, *each) for each in HOSTILE * ROUNDS]
            answered = 0
            while not all(each.done() for each in under_way):
                answer = messages.post(requests.Session(), stage.box.url, "/state/update", STATE, Style())
                self.assertEqual(answer.status_code, 200, answer.text)
                answered += 1
            self.assertGreater(answered, 0)
            self.assertIsNone(stage.box.process.poll())
            peak = self.peak(stage)
            print(f"at most {peak >> 20} MiB", end=" ", flush=True)
            self.assertLess(peak, 2 * REST, "with the bodies that wait for their turn")
            self.assertLessEqual({each.result().status_code for each in under_way}, {413, 422, 429})
            wait_until(lambda: self.resident(stage, "RssAnon") < REST // 2, "it to give back what it took")
