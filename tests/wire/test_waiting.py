"""An unplugged cable delays messages and loses none; overlapping networks stay separate; no socket listens towards the Command Post."""

import subprocess
import time
import unittest

import requests

import hosts
import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

CBOR = Style("cbor")
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}


def pose(name, x):
    return {"poses": [{"name": name, "position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}


class Waiting(unittest.TestCase):
    def stage(self, **overrides):
        stage = self.enterContext(Stage(**overrides))
        self.addCleanup(lambda: self.assertEqual(stage.post.violations() if stage.post else [], []))
        self.session = requests.Session()
        return stage

    def post(self, stage, uri, message):
        answer = messages.post(self.session, stage.box.url, uri, message, CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def post_map(self, stage, source, name):
        self.post(stage, "/map/update", messages.map_update(source, name, time.time(), CBOR))

    def taken(self, stage, uri):
        return [request for request in stage.post.requests(uri) if request["status"] == 200]

    def cloud_bytes(self, stage, name):
        return sum(request["message"]["msg"]["data"]["bytes"] for request in self.taken(stage, "/map/update")
                   if request["message"]["name"] == name)

    def test_a_pulled_cable_delays_and_loses_nothing(self):
        stage = self.stage(command_post__timeouts__mapping_answer_ms=2000, command_post__timeouts__connect_ms=500)
        self.post_map(stage, maps.made_cloud(100), "r1")
        wait_until(lambda: self.cloud_bytes(stage, "r1") == 1200, "the first cloud")
        stage.network.pull_cable()
        for number in range(3):
            self.post_map(stage, maps.made_cloud(100, seed=number), "r1")
            self.post(stage, "/state/update", pose("r1", float(number)))
        time.sleep(3)
        stage.network.pull_cable(False)
        wait_until(lambda: self.cloud_bytes(stage, "r1") >= 4800, "what came while the cable was out")
        wait_until(lambda: any(item["position"]["x"] == 2.0 for request in self.taken(stage, "/state/update")
                               for item in request["message"]["poses"]), "the last pose")

    def test_networks_that_overlap_do_not_touch(self):
        stage = self.stage(team_net="10.100.1")
        self.post_map(stage, maps.made_grid(10, 10), "r1")
        wait_until(lambda: self.taken(stage, "/map/update"), "the map")
        answer = requests.get(stage.box.url + "/api/status", timeout=30, headers=messages.headers(Style()))
        self.assertEqual(answer.status_code, 200)

    def test_no_port_is_open_to_the_command_post(self):
        stage = self.stage()
        for address in (hosts.BOX_DARPA, stage.network.box_address):
            stage.network.start(stage.network.post, "ip", "route", "replace", "default", "via", hosts.BOX_DARPA).wait()
            knock = f"import socket; socket.create_connection(('{address}', {programs.PORT}), 2)"
            tried = stage.network.start(stage.network.post, "/usr/bin/python3", "-c", knock, stderr=subprocess.PIPE)
            said = tried.communicate()[1].decode()
            self.assertNotEqual(tried.returncode, 0)
            self.assertRegex(said, "refused|timed out")
