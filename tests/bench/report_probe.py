"""Measures the time of reports: HOST PORT TOKEN SECONDS FIRST posts one every 20 ms on one connection, and prints each one's seconds
as JSON. The first report contains the number FIRST, so all reports differ."""

import json
import re
import socket
import sys
import time

STEP = 0.02  # seconds
host, port, token, seconds, first = sys.argv[1], int(sys.argv[2]), sys.argv[3], float(sys.argv[4]), int(sys.argv[5])
client = socket.create_connection((host, port), 30)
client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
took = []
for number in range(first, first + int(seconds / STEP)):
    until = time.monotonic() + STEP
    body = json.dumps({"x": float(number), "y": 0.0, "z": 0.0, "type": "Drill"})
    request = (f"POST /api/artifact_reports HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\n"
               f"Content-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n{body}").encode()
    began = time.monotonic()
    client.sendall(request)
    answer, length = b"", None
    while length is None or len(answer) < length:
        piece = client.recv(65536)
        if not piece:
            sys.exit(f"the connection ended: {answer!r}")
        answer += piece
        if length is None and b"\r\n\r\n" in answer:
            head = answer.partition(b"\r\n\r\n")[0]
            length = len(head) + 4 + int(re.search(rb"content-length: *(\d+)", head, re.IGNORECASE)[1])
    took.append(time.monotonic() - began)
    if b" 201 " not in answer[:16]:
        sys.exit(f"answered {answer!r}")
    time.sleep(max(0.0, until - time.monotonic()))
print(json.dumps(took[10:]))  # the first ones open connections
