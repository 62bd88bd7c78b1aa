"""How long reports take: HOST PORT TOKEN SECONDS FIRST posts one each 20 ms, on one connection, and prints what each took as
JSON, in seconds. The first has the number FIRST in it, so that no two are the same."""

import http.client
import json
import sys
import time

STEP = 0.02  # seconds
host, port, token, seconds, first = sys.argv[1], int(sys.argv[2]), sys.argv[3], float(sys.argv[4]), int(sys.argv[5])
headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}
client = http.client.HTTPConnection(host, port, timeout=30)
took = []
for number in range(first, first + int(seconds / STEP)):
    until = time.monotonic() + STEP
    body = json.dumps({"x": float(number), "y": 0.0, "z": 0.0, "type": "Drill"})
    began = time.monotonic()
    client.request("POST", "/api/artifact_reports", body, headers)
    answer = client.getresponse()
    answer.read()
    if answer.status != 201:
        sys.exit(f"answered {answer.status}")
    took.append(time.monotonic() - began)
    time.sleep(max(0.0, until - time.monotonic()))
print(json.dumps(took[10:]))  # the first ones open connections
