"""A Command Post that is none, that lies about lengths, that storms, that fails at one robot's messages: nothing counts
as taken that was not, nothing is lost, and the box serves on."""

import concurrent.futures
import json
import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until
from reporting import QUICK, began, submit

CBOR = Style("cbor")
OVERWHELMING = ("length-huge", "chunk-huge", "header-flood", "endless-body", "1xx-flood", "json-deep")


def state(name, x=1.0):
    return {"poses": [{"name": name, "position": {"x": x, "y": 0.0, "z": 0.0},
                       "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}]}


def marker(number):
    pose = {key: value for key, value in state("r1")["poses"][0].items() if key != "name"}
    return {"markers": [{"ns": "m", "id": number, "type": 1, "action": 0, "pose": pose,
                         "scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "color": {"r": 1.0, "g": 0.0, "b": 0.0, "a": 1.0}}]}


class HostilePost(unittest.TestCase):
    def stage(self, **overrides):
        stage = self.enterContext(Stage(**overrides))
        self.session = requests.Session()
        return stage

    def send(self, stage, uri, message):
        answer = messages.post(self.session, stage.box.url, uri, message, CBOR)
        self.assertEqual((answer.status_code, answer.text), (200, "null"))

    def send_map(self, stage, name, seed=1):
        self.send(stage, "/map/update", messages.map_update(maps.made_cloud(100, seed=seed), name, time.time(), CBOR))

    def taken(self, stage, uri):
        return [request for request in stage.post.requests(uri)
                if request["status"] == 200 and not request["rehearsed_fault"]]

    def view(self, stage):
        return stage.box.ask("GET /adit/run")[1]

    def metric(self, stage, name):
        text = requests.get(stage.box.url + "/metrics", headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"},
                            timeout=30).text
        return [float(line.rsplit(" ", 1)[1]) for line in text.splitlines() if line.startswith(name)]

    def test_a_page_of_html_is_no_command_post_and_takes_nothing(self):
        stage = self.stage()
        stage.post.will(mapping=["html-200,for=600"])
        for seed in range(4):
            self.send_map(stage, "r1", seed)
        self.send(stage, "/state/update", state("r1"))
        self.send(stage, "/markers/update", marker(1))
        wait_until(lambda: "answers is no Command Post" in stage.box.attention(), "the alarm")
        mapping = next(row for row in self.view(stage)["endpoints"] if row["name"] == "mapping")
        self.assertIn("no Command Post", mapping["trouble"])
        self.assertGreater(mapping["foreign"], 0)
        self.assertGreater(sum(self.metric(stage, "adit_endpoint_foreign_total")), 0)
        stage.post.control("DELETE /faults")
        size = sum(len(maps.made_cloud(100, seed=seed).data) for seed in range(4))
        wait_until(lambda: sum(request["message"]["msg"]["data"]["bytes"]
                               for request in self.taken(stage, "/map/update")) == size, "all maps")
        wait_until(lambda: self.taken(stage, "/state/update") and self.taken(stage, "/markers/update"),
                   "state and markers")
        wait_until(lambda: "no Command Post" not in stage.box.attention(), "the end of the alarm")

    def test_no_answer_of_any_kind_ends_the_box(self):
        stage = began(self.stage(**QUICK))
        before = stage.box.process.pid
        for fault in OVERWHELMING:
            with self.subTest(fault):
                stage.post.will(status=[fault], mapping=[fault])
                stage.box.ask("GET /api/status")
                self.send_map(stage, "r1")
                wait_until(lambda: not any(stage.post.control("GET /faults")[aim] for aim in ("status", "mapping")),
                           f"{fault} to come")
        wait_until(lambda: len(self.taken(stage, "/map/update")) > 0 and
                   next(row for row in self.view(stage)["activities"] if row["kind"] == "cloud")["waiting"] == 0,
                   "the maps to be taken")
        self.assertEqual((stage.box.process.poll(), stage.box.process.pid), (None, before))

    def test_the_message_that_fails_alone_is_set_aside_and_sent_again_by_hand(self):
        stage = self.stage()
        stage.post.will(mapping=["500,robot=r2,for=600"])
        self.send_map(stage, "r2")
        aside = []
        for seed in range(300):  # others pass all the while
            self.send_map(stage, f"r{3 + seed % 3}", seed)
            aside = self.view(stage)["aside"]
            if aside:
                break
            time.sleep(0.2)
        self.assertEqual([(row["kind"], row["robot"], row["status"], row["overtaken"]) for row in aside],
                         [("cloud", "r2", 500, False)])
        self.assertIn("set aside", stage.box.attention())
        self.assertGreaterEqual(len([request for request in stage.post.requests("/map/update")
                                     if request["status"] == 500]), 4)
        stage.box.stop()
        stage.restart_box()
        kept = self.view(stage)["aside"]
        self.assertEqual([{**row, "at": 0} for row in kept], [{**row, "at": 0} for row in aside], "it outlives the service")
        self.assertAlmostEqual(kept[0]["at"], aside[0]["at"], places=2)  # how far the clocks are apart is measured again
        stage.post.control("DELETE /faults")
        number = aside[0]["number"]
        self.assertEqual(stage.box.ask(f"POST /adit/aside/{number}/send", body={}), (200, {"aside": number}))
        wait_until(lambda: any(request["message"]["name"] == "r2" for request in self.taken(stage, "/map/update")),
                   "the map, sent again")
        self.assertEqual(self.view(stage)["aside"], [])
        self.assertEqual(stage.box.ask(f"POST /adit/aside/{number}/discard", body={})[0], 409)

    def test_the_status_is_known_at_once_while_a_report_waits_for_its_answer(self):
        stage = began(self.stage(command_post__timeouts__scoring_answer_ms=60000, reports__answer_within_ms=60000))
        self.assertEqual(stage.box.ask("GET /api/status")[0], 200)
        time.sleep(1.1)  # so that it is not fresh
        stage.post.will("answer-after=60")
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            report = pool.submit(submit, stage)
            wait_until(lambda: any(row["state"] == "sending" for row in stage.box.reports()), "it to be sent")
            answer = requests.get(stage.box.url + "/api/status", timeout=30,
                                  headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"})
            self.assertEqual(answer.status_code, 200)
            self.assertLess(int(answer.headers["Age"]), 16)
            self.assertIn("remaining_reports", json.loads(answer.text))
            self.assertFalse(report.done(), "the report was waited for")
            stage.box.stop()  # which tells the client
