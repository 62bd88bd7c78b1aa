"""The measure of the mapping endpoint's rate (--counts): first bytes, last bytes, or answers."""

import json
import subprocess
import time
import unittest

from command_post import MAPPING_TOKEN, CommandPost, connect, read_answer, state

INTERVAL = 1.0  # seconds: --rate 1
BODY = json.dumps(state("A")).encode()
HEAD = (f"POST /state/update HTTP/1.1\r\nHost: here\r\nAuthorization: Bearer {MAPPING_TOKEN}\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(BODY)}\r\n\r\n").encode()


def posted(stream, takes=0.0):
    """The status of a request whose last byte leaves that much later than its first, and the time at which it left."""
    stream.sendall(HEAD + BODY[:-1])
    time.sleep(takes)
    left = time.monotonic()
    stream.sendall(BODY[-1:])
    return read_answer(stream)[0], left


def two(counts, first_takes=0.0, second_takes=0.0):
    """The statuses of two requests, the second right after the answer to the first. Repeats both if this machine was too slow."""
    for _ in range(20):
        with CommandPost("--counts", counts, rate=1 / INTERVAL) as post, connect(post.mapping) as stream:
            first, left = posted(stream, first_takes)
            second, _ = posted(stream, second_takes)
            if time.monotonic() - left - second_takes < INTERVAL / 2:
                return [first, second]
    raise AssertionError("two requests take too long")


class Counts(unittest.TestCase):
    def test_starts(self):
        self.assertEqual(two("starts"), [200, 429])
        self.assertEqual(two("starts", first_takes=INTERVAL), [200, 200])
        self.assertEqual(two("starts", second_takes=INTERVAL), [200, 429])

    def test_last_bytes(self):
        self.assertEqual(two("last-bytes", first_takes=INTERVAL), [200, 429])
        self.assertEqual(two("last-bytes", second_takes=INTERVAL), [200, 200])

    def test_answers(self):
        self.assertEqual(two("answers", first_takes=INTERVAL), [200, 429])
        self.assertEqual(two("answers", second_takes=INTERVAL), [200, 429])
        with CommandPost("--counts", "answers", rate=1 / INTERVAL) as post, connect(post.mapping) as stream:
            self.assertEqual(posted(stream)[0], 200)
            time.sleep(INTERVAL)
            self.assertEqual(posted(stream)[0], 200)

    def test_another_word_is_rejected(self):
        with CommandPost() as post:
            done = subprocess.run([*post.command, "--counts", "never"], capture_output=True, text=True, timeout=30,
                                  check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--counts: expected starts, last-bytes or answers, got 'never'", done.stderr)
