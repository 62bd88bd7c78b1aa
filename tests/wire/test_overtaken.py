"""Uploads of one client that overtake each other: the second one is accepted while the first one is still on its way."""

import gzip
import http.client
import time
import unittest
import urllib.parse

import requests

import maps
import messages
from messages import Style
from programs import wait_until
from python_post import stage_of

CBOR = Style("cbor")
CELL, SIDE = 0.5, 8


class SlowUpload:
    """Half of a message has been sent."""

    def __init__(self, url, uri, message):
        address = urllib.parse.urlsplit(url)
        self.content = messages.body(message, CBOR)
        self.connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
        self.connection.putrequest("POST", uri)
        for name, value in {**messages.headers(CBOR), "Content-Length": str(len(self.content))}.items():
            self.connection.putheader(name, value)
        self.connection.endheaders()
        self.half = len(self.content) // 2
        self.connection.send(self.content[:self.half])

    def end(self):
        """Sends the rest, and returns the answer's status."""
        self.connection.send(self.content[self.half:])
        return self.connection.getresponse().status


def window(column, value):
    """Cells of one value, whose first column is `column`."""
    return maps.Grid(f"window of {value}", SIDE, SIDE, CELL, (column * CELL, 0.0, 0.0), bytes([value]) * SIDE * SIDE)


def cells_of(updates):
    """The cells that a Command Post has after these grids."""
    cells = {}
    for update in updates:
        message = update["msg"]
        info, origin = message["info"], message["info"]["origin"]["position"]
        data = gzip.decompress(message["data"]) if message.get("compression") == "gzip" else message["data"]
        for place, value in enumerate(data):
            row, column = divmod(place, info["width"])
            cells[round(origin["x"] / CELL) + column, round(origin["y"] / CELL) + row] = value
    return cells


class TestOvertaken(unittest.TestCase):
    def send(self, uri, older, newer):
        """`older` begins first and ends last."""
        slow = SlowUpload(self.stage.box.url, uri, older)
        time.sleep(0.5)
        with requests.Session() as session:
            self.assertEqual(messages.post(session, self.stage.box.url, uri, newer, CBOR).status_code, 200)
            time.sleep(2)  # the newer one is delivered
        self.assertEqual(slow.end(), 200)

    def test_the_newer_message_stands(self):
        self.stage, post = stage_of(self)
        now = time.time()
        self.send("/map/update", messages.map_update(window(0, 10), "ugv1", now - 8, CBOR),
                  messages.map_update(window(3, 20), "ugv1", now, CBOR))
        wait_until(lambda: len(cells_of(post.messages("/map/update"))) == SIDE * (SIDE + 3), "all cells", within=10)
        cells = cells_of(post.messages("/map/update"))
        for (column, row), value in cells.items():
            self.assertEqual(value, 20 if column >= 3 else 10, (column, row))

        def state(x, seconds):
            pose = {"name": "ugv1", "position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": dict(maps.IDENTITY)}
            return {"header": messages.header(seconds, CBOR), "poses": [pose]}
        self.send("/state/update", state(1.0, now - 8), state(2.0, now))

        def marker(action, seconds):
            return {"markers": [{"header": messages.header(seconds, CBOR), "ns": "finds", "id": 1, "type": 1, "action": action,
                                 "pose": {"position": dict.fromkeys("xyz", 0.0), "orientation": dict(maps.IDENTITY)},
                                 "scale": dict.fromkeys("xyz", 1.0), "color": dict.fromkeys("rgba", 1.0)}]}
        self.send("/markers/update", marker(0, now - 8), marker(2, now))
        time.sleep(3)
        self.assertEqual({pose["position"]["x"] for update in post.messages("/state/update") for pose in update["poses"]}, {2.0})
        self.assertEqual([each["action"] for update in post.messages("/markers/update") for each in update["markers"]], [2])


if __name__ == "__main__":
    unittest.main()
