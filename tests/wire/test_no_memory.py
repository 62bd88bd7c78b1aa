"""Memory that runs out in the middle of a request ends that request: it is answered, logged and counted, and the box serves
on."""

import pathlib
import re
import resource
import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

CBOR = Style("cbor")
LEFT = 24 << 20  # bytes that the process may still ask for


class NoMemory(unittest.TestCase):
    def setUp(self):
        self.stage = self.enterContext(Stage())
        self.box = self.stage.box

    def limit(self, more):
        """The process gets `more` bytes of address space beyond what it has; None: as much as it likes."""
        pid = self.box.process.pid
        self.assertEqual(pathlib.Path(f"/proc/{pid}/comm").read_text(encoding="ascii").strip(), "aditd")
        size = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
        if size > 1 << 40:
            self.skipTest("a sanitizer has taken the address space")
        most = resource.RLIM_INFINITY if more is None else size + more
        resource.prlimit(pid, resource.RLIMIT_AS, (most, resource.RLIM_INFINITY))

    def exceptions(self):
        text = requests.get(self.box.url + "/metrics", headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"},
                            timeout=30).text
        return int(float(re.search(r"^adit_exceptions_total (\S+)$", text, re.MULTILINE)[1]))

    def post(self, cloud, style=CBOR):
        return messages.post(requests.Session(), self.box.url, "/map/update",
                             messages.map_update(cloud, "r1", time.time(), style), style)

    def test_a_map_too_large_for_what_is_left_ends_alone(self):
        self.assertEqual(self.exceptions(), 0)
        large = maps.Cloud("large", maps.XYZ, 12, bytes(12 << 23))
        small = maps.made_cloud(100)
        # A body goes into its file as it comes, and is refused where that cannot be mapped; what its data inflates to is held.
        for style, throws in ((CBOR, False), (Style("cbor", body="gzip"), False), (Style("cbor", data="gzip"), True)):
            with self.subTest(str(style)):
                before = self.exceptions()
                self.limit(LEFT)
                try:
                    answer = self.post(large, style)
                    self.assertIn(answer.status_code, (500, 503))
                    self.assertIsInstance(answer.json(), str)
                except requests.ConnectionError:  # it was answered, and closed, before the body was whole
                    pass
                self.limit(None)
                if throws:
                    wait_until(lambda before=before: self.exceptions() > before, "it to be counted")
                    self.assertIn("std::bad_alloc", self.box.said())
                self.assertEqual(self.post(small).status_code, 200)
        wait_until(lambda: [request for request in self.stage.post.requests("/map/update") if request["status"] == 200],
                   "a map to be taken")
        self.assertIsNone(self.box.process.poll())
