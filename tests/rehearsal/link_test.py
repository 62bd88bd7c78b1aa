"""A Command Post behind a slow link."""

import time
import unittest
from concurrent.futures import ThreadPoolExecutor

from command_post import POINTS, CommandPost, cloud


class Link(unittest.TestCase):
    def test_all_connections_share_it(self):
        message = cloud(data=POINTS * 20_000)  # 5 Mbit as base64
        with CommandPost("--link", "10") as post, ThreadPoolExecutor() as pool:
            began = time.monotonic()
            answers = list(pool.map(lambda _: post.map(message).status_code, range(2)))
            self.assertEqual(answers, [200, 200])
            self.assertGreater(time.monotonic() - began, 0.9)

    def test_sender_waits_for_the_link(self):
        """The buffer before the slow link is small. Otherwise a client would count a map as sent too early."""
        message = cloud(data=POINTS * 100_000)
        with CommandPost("--link", "1") as post, ThreadPoolExecutor() as pool:
            sent = pool.submit(post.map, message)
            time.sleep(0.5)
            self.assertFalse(sent.done())
            self.assertEqual(post.record()["requests"], [])
            post.stop()
            self.assertIsNotNone(sent.exception())
