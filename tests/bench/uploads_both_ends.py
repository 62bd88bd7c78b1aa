"""A robot that posts a map, and the Command Post that finally gets it."""

import socket
import subprocess
import sys
import threading
import time

from uploads_ways import HERE, TOKEN, free_port


def upload(port, kind, body, mbit):
    """Posts it with that many Mbit/s. Returns when its last byte was sent and when it was answered."""
    head = (f"POST /map/update HTTP/1.1\r\nHost: adit\r\nAuthorization: Bearer {TOKEN}\r\nContent-Type: {kind}\r\n"
            f"Content-Length: {len(body)}\r\n\r\n").encode()
    step, each = 65536, 65536 * 8 / (mbit * 1e6)
    with socket.create_connection(("127.0.0.1", port)) as robot:
        robot.sendall(head)
        due = time.monotonic()
        for at in range(0, len(body), step):
            due = max(due + each, time.monotonic() - 0.01)
            time.sleep(max(0, due - time.monotonic()))
            robot.sendall(memoryview(body)[at:at + step])
        sent = time.monotonic()
        answer = robot.recv(4096)
        if b" 200 " not in answer[:16]:
            raise RuntimeError(f"answered {answer[:400]!r}")
        return sent, time.monotonic()


class Post:
    """The Command Post, and each request's first byte, last byte and size."""

    def __init__(self):
        self.port, self.arrivals = free_port(), []
        self.process = subprocess.Popen([sys.executable, "-B", HERE / "uploads_post.py", str(self.port)], stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            self.arrivals.append([float(word) for word in line.split()])
