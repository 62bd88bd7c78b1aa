"""A Command Post that serves one connection at a time: Python's single-threaded server, with keep-alive, for both endpoints."""

import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import wait_until
from python_post import stage_of
from reporting import another, submit

CBOR = Style("cbor")
SECONDS = 12
POINTS = 50  # of a cloud


class TestSerial(unittest.TestCase):
    def test_all_messages_arrive(self):
        stage, post = stage_of(self)
        session, sent = requests.Session(), []
        for number in range(2 * SECONDS):
            cloud = messages.map_update(maps.made_cloud(POINTS, number), "r1", time.time(), CBOR)
            state = {"poses": [{"name": "r1", "position": {"x": float(number), "y": 0.0, "z": 0.0},
                                "orientation": dict(maps.IDENTITY)}]}
            for uri, message in (("/map/update", cloud), ("/state/update", state)):
                self.assertEqual(messages.post(session, stage.box.url, uri, message, CBOR).status_code, 200)
            if number % 8 == 4:
                sent.append(another(number))
                self.assertEqual(submit(stage, sent[-1]).status_code, 201)
            time.sleep(0.5)
        counts = {uri: len(post.messages(uri)) for uri in ("/map/update", "/state/update", "/api/artifact_reports", "/api/status")}
        print(f"in {SECONDS} s:", counts)
        self.assertGreater(counts["/map/update"], SECONDS / 2)
        self.assertGreater(counts["/state/update"], SECONDS / 2)
        wait_until(lambda: post.points() == 2 * SECONDS * POINTS, "all clouds")
        wait_until(lambda: post.messages("/state/update")[-1]["poses"][0]["position"]["x"] == 2 * SECONDS - 1, "the last state")
        self.assertEqual([{name: report[name] for name in programs.FIELDS} for report in post.reports()], sent)
        answer = requests.get(stage.box.url + "/api/status", timeout=30, headers=messages.headers(CBOR))
        self.assertEqual(answer.json()["score"], len(sent))


if __name__ == "__main__":
    unittest.main()
