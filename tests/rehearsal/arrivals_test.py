"""The age of maps at their arrival, and the share of posted maps that arrived."""

import struct
import time
import unittest

from command_post import CommandPost, changed, grid, marker

BASE = 101


def now_ms():
    return int(time.time() * 1000)


def row(posted, left=0.0):
    """A row of 20 cells, two of them unknown, that begins with a date as adit-robots writes it."""
    digits = [posted // BASE ** power % BASE for power in (4, 3, 2, 1, 0)]
    cells = bytes([13, 87, 42, 61, 99, *digits, *8 * [0], 255, 255])
    return changed(grid(cells, width=20, height=1), msg__info__origin__position={"x": left, "y": 0.0, "z": 0.0})


def cloud(*dates):
    """One point for each date."""
    data = b"".join(struct.pack("<fffI", 1, 2, n, date % 2 ** 32) for n, date in enumerate(dates))
    fields = [{"name": name, "offset": 4 * i, "datatype": 7, "count": 1} for i, name in enumerate("xyz")]
    fields.append({"name": "posted_ms", "offset": 12, "datatype": 6, "count": 1})
    return {"type": "PointCloud2", "name": "X1",
            "msg": {"fields": fields, "is_bigendian": False, "point_step": 16, "data": data}}


class Markers(unittest.TestCase):
    def test_scene_is_compared_with_that_of_the_robots(self):
        with CommandPost() as post:
            two = {"markers": [marker(ns=ns, id=1)["markers"][0] for ns in ("R1/path", "R2/path")]}
            self.assertEqual(post.mapping_request("POST", "/markers/update", two).status_code, 200)
            x = two["markers"][0]["pose"]["position"]["x"]

            def differences(*standing):
                told = [{"robot": "R1", "kind": "markers", "standing": [
                    {"ns": ns, "id": number, "x": at} for ns, number, at in standing]}]
                answer = post.tell("posted", told).json()
                self.assertEqual((answer["markers"]["here"], answer["markers"]["posted"]), (2, len(standing)))
                self.assertIn(f"; {answer['markers']['difference_count']} differ", answer["table"])
                return answer["markers"]["differences"]

            self.assertEqual(differences(("R1/path", 1, x)), [])
            self.assertEqual(differences(("R1/path", 1, x), ("R1/path", 2, x)), ["marker 2 of R1/path is missing"])
            self.assertEqual(differences(("R1/path", 1, x + 1)), [f"marker 1 of R1/path is at x {x:f}, not {x + 1:f}"])
            self.assertEqual(differences(("R1/path", 1, x), ("R2/path", 2, x)),
                             ["marker 2 of R2/path is missing", "marker 1 of R2/path was deleted"])
            answer = post.tell("posted", [{"robot": "R1", "kind": "markers", "standing": [{"ns": "a", "id": "b", "x": 1}]}])
            self.assertEqual(answer.status_code, 422)
            self.assertIn("[0].standing[0].id: expected an integer", answer.json())


class Arrivals(unittest.TestCase):
    def setUp(self):
        self.post = self.enterContext(CommandPost())

    def only(self):
        (arrived,) = self.post.record()["maps"]
        return arrived

    def test_age_of_a_grid_is_that_of_its_newest_date(self):
        self.assertEqual(self.post.map(row(now_ms() - 60_000)).status_code, 200)
        arrived = self.only()
        self.assertEqual((arrived["robot"], arrived["kind"], arrived["maps"]), ("X1", "grid", 1))
        for name in ("p50", "p99", "most"):
            self.assertGreaterEqual(arrived[name], 59.9)
            self.assertLess(arrived[name], 600)  # a busy machine takes its time
        self.assertIsNone(arrived["share"])

    def test_age_of_a_cloud_is_that_of_its_newest_point_and_points_count_once(self):
        old, new = now_ms() - 3_600_000, now_ms() - 60_000
        whole = (old, old, new)
        data = cloud(*whole)["msg"]["data"]
        points = sorted(2 * [data[at:at + 16] for at in range(0, len(data), 16)], reverse=True)  # joined, and in an order
        for message in (cloud(old, old), cloud(*whole), changed(cloud(*whole), msg__data=b"".join(points))):
            self.assertEqual(self.post.map_cbor(message).status_code, 200)
        answer = self.post.tell("posted", [{"robot": "X1", "kind": "cloud", "amount": 4, "newest": new + 2000}])
        self.assertEqual(answer.status_code, 200, answer.text)
        arrived = self.only()
        self.assertEqual((arrived["arrived"], arrived["posted"], arrived["share"]), (3, 4, 0.75))
        self.assertEqual((arrived["maps"], arrived["behind"], arrived["most"]), (3, 2, 3600))
        self.assertLess(arrived["p50"], 3600)
        self.assertIn("75.0%", answer.json()["table"])
        self.assertIn("75.0%", self.post.stop()[1])

    def test_place_with_many_points_counts_once(self):
        posted = now_ms()
        near = cloud(posted, posted, posted)  # a metre apart
        self.post.map_cbor(near)
        self.post.map_cbor(changed(near, msg__data=near["msg"]["data"].replace(struct.pack("<f", 1), struct.pack("<f", 1.04), 1)))
        told = {"robot": "X1", "kind": "cloud", "amount": 8, "places": 4, "newest": posted}
        self.assertIn("75.0%", self.post.tell("posted", [told]).json()["table"])
        self.assertEqual(self.only()["places"], 0.75)

    def test_cells_of_several_maps_count_once(self):
        posted = now_ms()
        self.post.map(row(posted))            # 18 known cells of 0.2 m
        self.post.map(row(posted, left=1.0))  # five cells on: five more
        self.assertEqual(self.only()["arrived"], 23)

    def test_map_without_a_date_is_ignored(self):
        self.post.map(grid())
        self.assertEqual(self.post.record()["maps"], [])

    def test_incomplete_list_of_posted_maps_is_rejected(self):
        whole = {"robot": "X1", "kind": "grid", "amount": 1, "newest": 1}
        for name in whole:
            answer = self.post.tell("posted", [{key: value for key, value in whole.items() if key != name}])
            self.assertEqual(answer.status_code, 422)
            self.assertIn(name, answer.text)
        self.assertEqual(self.post.tell("posted", {}).status_code, 422)
