"""Sends messages one by one through a box, and compares each with the message at the Command Post."""

import copy
import time
import unittest
import zlib

import requests

import messages
from programs import Stage, wait_until


SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 8: 8}  # of PointField's datatypes


def size_of(field):
    return SIZES[field["datatype"]] * field["count"]


def points_of(head, data):
    """For each point the bytes of its fields, in the order of the field list."""
    return [b"".join(data[at + field["offset"]:at + field["offset"] + size_of(field)] for field in head["fields"])
            for at in range(0, len(data), head["point_step"])]


def put_together(head, in_order):
    """`head` with those fields one after the other, laid out in the order `in_order`."""
    offsets, end = {}, 0
    for field in in_order:
        offsets[field["name"]] = end
        end += size_of(field)
    fields = [{**field, "offset": offsets[field["name"]]} for field in head["fields"]]
    return {**head, "fields": fields, "point_step": end}


def without_padding(head):
    """The cloud as Adit sends it."""
    return put_together(head, sorted(head["fields"], key=lambda field: field["offset"]))


def tight_list(head):
    """The cloud as a picture of the transcript has it."""
    return put_together(head, head["fields"])


class Delivered(unittest.TestCase):
    """Tests that share one network. A violation that the strict Command Post finds fails the test."""

    post_options = ("--rate", "0")

    @classmethod
    def setUpClass(cls):
        cls.stage = cls.enterClassContext(Stage(post_options=cls.post_options))
        cls.session = requests.Session()
        cls.seconds = time.time()

    def tearDown(self):
        self.assertEqual(self.stage.post.violations(), [])

    def deliver(self, uri, message, style, content=None, answered=(200, "null")):
        """Posts the message, or `content` instead, and returns the one request that reached the Command Post for it."""
        before = len(self.stage.post.requests(uri))
        answer = messages.post(self.session, self.stage.box.url, uri, message, style, content=content)
        self.assertEqual((answer.status_code, answer.text), answered)
        self.assertEqual(answer.headers["Access-Control-Allow-Origin"], "*")
        arrived = wait_until(lambda: self.stage.post.requests(uri)[before:], f"{style} to arrive", 30)
        self.assertEqual(len(arrived), 1)
        self.check_canonical(arrived[0])
        type(self).seconds = max(self.seconds + 0.5, time.time())  # later than what Adit stamped itself
        return arrived[0]["message"]

    def check_canonical(self, request):
        self.assertEqual(request["status"], 200, request["answer"])
        self.assertEqual(request["content_type"], "application/cbor")
        self.assertIsNone(request["content_encoding"])
        self.assertFalse(request["expect"])

    def same(self, arrived, expected, where=""):
        """Compares every value and its type: 11.0 is not 11."""
        self.assertIs(type(arrived), type(expected), f"{where}: {arrived} for {expected}")
        if isinstance(expected, dict):
            self.assertEqual(sorted(arrived), sorted(expected), where)
            for key, value in expected.items():
                self.same(arrived[key], value, f"{where}.{key}")
        elif isinstance(expected, list):
            self.assertEqual(len(arrived), len(expected), where)
            for at, value in enumerate(expected):
                self.same(arrived[at], value, f"{where}[{at}]")
        else:
            self.assertEqual(arrived, expected, where)
            self.assertEqual(str(arrived), str(expected), where)  # -0.0 is not 0.0

    def without_stamp(self, header):
        header = dict(header)
        self.assertIs(type(header.pop("stamp")), float)
        return header

    def same_map(self, arrived, update, data, head):
        """`head`: the members of msg except for header and data. The points of a cloud are the same, without padding, in any order."""
        arrived = copy.deepcopy(arrived)
        msg = arrived["msg"]
        msg["header"] = self.without_stamp(msg["header"])
        self.assertIn(msg.pop("compression"), ("gzip", "none"))
        file = msg["data"].pop("file", None)  # where the transcript has its picture
        said = {"bytes": len(data), "crc32": zlib.crc32(data)}
        if update["type"] == "PointCloud2":
            points = sorted(points_of(head, data))
            head = without_padding(head)
            said = {"bytes": len(points) * head["point_step"], "crc32": msg["data"]["crc32"]}
            picture = (self.stage.post.transcript / file).read_bytes().partition(b"DATA binary\n")[2]
            self.assertEqual(sorted(points_of(tight_list(head), picture)), points)
        self.same(arrived, {"type": update["type"], "name": update.get("name", ""),
                            "msg": {**head, "header": {"frame_id": "darpa"}, "data": said}})
