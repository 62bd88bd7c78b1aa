"""The cost of a state with ten poses, posted 200 times per second on one connection, through each way."""

import http.client
import json
import statistics
import time

from uploads_maps import POSE, header
from uploads_ways import TOKEN

COUNT, STEP = 600, 0.005  # posts, seconds
HEADERS = {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"}


def cpu_of_states(way, first):
    """Microseconds of CPU time per post."""
    client, before = http.client.HTTPConnection("127.0.0.1", way.port, timeout=30), way.cpu()
    for number in range(first, first + COUNT):
        poses = [{"name": f"r{i}", **POSE, "position": {"x": i + 0.001 * number, "y": 2.5, "z": 0.125}} for i in range(10)]
        client.request("POST", "/state/update", json.dumps({"header": header(number * STEP), "poses": poses}), HEADERS)
        answer = client.getresponse()
        text = answer.read()
        if answer.status != 200:
            raise RuntimeError(f"{way.name} answered {answer.status} {text[:300]!r}")
        time.sleep(STEP)
    client.close()
    return (way.cpu() - before) * 1e3 / COUNT


def play(ways, rounds):
    print(f"\n**a state of ten poses, JSON**, the median of {rounds}\n\n| way | CPU us for each post |\n| --- | --- |", flush=True)
    found = {way.name: [] for way in ways}
    for number in range(rounds + 1):  # the first is not counted
        for way in ways:
            found[way.name].append(cpu_of_states(way, 1 + number * COUNT))
    for name, figures in found.items():
        print(f"| {name} | {statistics.median(figures[1:]):.0f} |", flush=True)
