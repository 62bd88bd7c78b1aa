"""429 upon 429, and a Retry-After of sixty years: nothing is lost, nothing is set aside, and all goes on."""

import time
import unittest

import requests

import hosts
import maps
import messages
from messages import Style
from programs import Stage, wait_until
from reporting import QUICK, REPORT, began, submit

CBOR = Style("cbor")
SIXTY_YEARS = 2_000_000_000
ROBOTS = ("r1", "r2", "r3", "r4")


def setUpModule():
    hosts.needs_namespaces()


class Storm(unittest.TestCase):
    def send_map(self, stage, name, seed=1):
        answer = messages.post(requests.Session(), stage.box.url, "/map/update",
                               messages.map_update(maps.made_cloud(100, seed=seed), name, time.time(), CBOR), CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def names(self, stage, status):
        return [request["message"]["name"] if request["message"] else None
                for request in stage.post.requests("/map/update") if request["status"] == status]

    def throttled(self, stage):
        return sum(row["throttled"] for row in stage.box.ask("GET /adit/run")[1]["activities"])

    def test_all_maps_of_a_storm_are_taken_after_it(self):
        stage = self.enterContext(Stage())
        stage.post.will(mapping=["429=6"])
        for name in ROBOTS:
            self.send_map(stage, name)
        wait_until(lambda: set(self.names(stage, 200)) == set(ROBOTS), "all maps", 120)
        refused = len(self.names(stage, 429))
        self.assertEqual((refused, self.throttled(stage)), (6, 6))
        for seed in range(2, 5):  # the rate from before is back: none is refused, and each is taken
            for name in ROBOTS:
                self.send_map(stage, name, seed)
        wait_until(lambda: all(row["waiting"] == 0 for row in stage.box.ask("GET /adit/run")[1]["activities"]),
                   "the later maps", 120)
        self.assertEqual(len(self.names(stage, 429)), refused)
        self.assertEqual(stage.box.ask("GET /adit/run")[1]["aside"], [])

    def test_a_retry_after_of_sixty_years_is_no_end(self):
        stage = began(self.enterContext(Stage(**QUICK)))
        stage.post.will(f"429,retry-after={SIXTY_YEARS}", mapping=[f"429,retry-after={SIXTY_YEARS}"])
        self.send_map(stage, "r1")
        answer = submit(stage)
        self.assertIn(answer.status_code, (201, 503), answer.text)
        wait_until(lambda: self.names(stage, 200) == ["r1"], "the map", 120)
        wait_until(lambda: len(stage.post.recorded(REPORT)) == 1, "the report", 120)
        self.assertEqual([row["state"] for row in wait_until(
            lambda: [row for row in stage.box.reports() if row["state"] == "answered"], "its answer")], ["answered"])
        self.assertEqual(len(self.names(stage, 429)), 1)


if __name__ == "__main__":
    unittest.main()
