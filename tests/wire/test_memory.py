"""The service has half a gigabyte. What clients send together, however short it is in a body and long in memory, leaves
room in it, and the others are answered meanwhile."""

import concurrent.futures
import pathlib
import re
import unittest

import requests

import hosts
import messages
import programs
from messages import Style
from programs import Stage

MOST = 512 << 20  # bytes
BODY = 8 << 20
CBOR, JSON = "application/cbor", "application/json"
HEAD = b"\xa1\x67markers"
STATE = {"header": {"stamp": 1.0, "frame_id": "darpa"}, "poses": []}
CLIENTS, ROUNDS = 8, 2


def filled(head, one, tail, count=BODY):
    count = min(count, (BODY - len(head) - len(tail)) // len(one))
    return head + one * count + tail


# As much as is read at all, and as much as fits.
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


def setUpModule():
    hosts.needs_namespaces()


class Memory(unittest.TestCase):
    def peak(self, stage):
        status = pathlib.Path(f"/proc/{stage.box.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmHWM:\s+(\d+) kB", status)[1]) << 10

    def test_many_hostile_markers_at_once(self):
        with Stage() as stage, concurrent.futures.ThreadPoolExecutor(CLIENTS) as clients:
            if self.peak(stage) > MOST // 2:
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
            self.assertLess(peak, MOST)
            self.assertLessEqual({each.result().status_code for each in under_way}, {413, 422, 429})


if __name__ == "__main__":
    unittest.main()
