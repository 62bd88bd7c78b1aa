"""A request that meets a fault: its bytes, the answer, and the record."""

import json
import time
import unittest

from command_post import SCORING_TOKEN, CommandPost, connect
from patience import wait_until

REPORT = {"x": 1.5, "y": -2.0, "z": 0.25, "type": "Drill"}
BODY = json.dumps(REPORT).encode()
REPORT_BYTES = (f"POST /api/artifact_reports HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {SCORING_TOKEN}\r\n"
                f"Content-Type: application/json\r\nContent-Length: {len(BODY)}\r\n\r\n").encode() + BODY
STATUS_BYTES = f"GET /api/status HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {SCORING_TOKEN}\r\n\r\n".encode()


def exchange(where, sent=REPORT_BYTES):
    """All bytes until the connection ends, and its end: "closed" or "reset"."""
    received = b""
    with connect(where) as stream:
        stream.sendall(sent)
        try:
            while piece := stream.recv(65536):
                received += piece
        except ConnectionResetError:
            return received, "reset"
    return received, "closed"


def recorded(post, report=None):
    """How often the record has that report of the client."""
    report = report or REPORT
    return sum(1 for one in post.record()["reports"]
               if one["by"] == "client" and all(one[name] == value for name, value in report.items()))


class OneRequest(unittest.TestCase):
    """A Command Post with a transcript, and its handling of one request."""

    def setUp(self):
        self.post = self.enterContext(CommandPost(transcript=True))

    def fault_of_last_line(self):
        return self.post.lines()[-1]["rehearsed_fault"]

    def expect_before(self, end, is_so, why):
        """Passes if `end` is over, because this machine may be busy."""
        self.assertTrue(is_so() or time.monotonic() >= end, why)

    def wait_until_recorded(self):
        wait_until(lambda: recorded(self.post), "it to be recorded")
