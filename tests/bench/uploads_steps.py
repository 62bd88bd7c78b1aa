"""How long one message of markers delays all others: the longest answer to a client that asks all the time."""

import concurrent.futures
import http.client
import json
import statistics
import time

from uploads_both_ends import Post
from uploads_ways import TOKEN, Adit

COUNT = 90_000  # markers that are deleted, of as many namespaces: nearly as many as one message may have
HEAD = "| way | the longest answer while nothing comes, ms | while 90,000 markers of as many namespaces come, ms |"


def message():
    marker = {"id": 0, "action": 2, "type": 0}
    return json.dumps({"markers": [{"header": {"stamp": 1000.0 + i / 1e5, "frame_id": "darpa"}, "ns": f"n{i}", **marker} for i in range(COUNT)]},
                      separators=(",", ":")).encode()


def post(port, body):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("POST", "/markers/update", body, {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"})
    answer = connection.getresponse()
    text = answer.read()
    if answer.status != 200:
        raise RuntimeError(f"answered {answer.status} {text[:300]!r}")


def longest_while(port, doing):
    """Milliseconds."""
    longest = 0.0
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        done = pool.submit(doing)
        while not done.done():
            began = time.monotonic()
            connection.request("GET", "/adit/about")
            connection.getresponse().read()
            longest = max(longest, time.monotonic() - began)
        done.result()
    return longest * 1000


def play(programs, rounds, folder):
    print(f"\n**a message of markers**, the median of {rounds}\n\n{HEAD}\n|{' --- |' * (HEAD.count('|') - 1)}", flush=True)
    body, there = message(), Post()
    folder.mkdir()
    for name, program in programs.items():
        idle, busy = [], []
        for number in range(rounds):
            way = Adit(name, folder / f"{name}{number}", there.port, program)
            try:
                idle.append(longest_while(way.port, lambda: time.sleep(1)))
                busy.append(longest_while(way.port, lambda way=way: post(way.port, body)))
            finally:
                way.process.terminate()
                way.process.wait()
        print(f"| {name} | {statistics.median(idle):.1f} | {statistics.median(busy):.1f} |", flush=True)
    there.process.kill()
