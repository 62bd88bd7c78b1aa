"""Artifact reports: they do not wait for maps, and clients get answers while the box or the Command Post restarts. Details:
dispatch/reports_clients_test and dispatch/reports_restart_test."""

import concurrent.futures
import json
import signal
import time
import unittest

import requests

import maps
import messages
import programs
from programs import Stage, wait_until
from reporting import QUICK, another, began, left_unanswered, sendings, submit

PATIENT = {**QUICK, "command_post__timeouts__scoring_answer_ms": 20000}  # towards the Command Post
TOKEN = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
SILENCE = "answer-after=60"  # recorded, and no answer comes
DEAF = "record-after=60"  # not recorded while a test lasts, and no answer comes


class Order(unittest.TestCase):
    def test_a_report_overtakes_maps_that_fill_the_link(self):
        with Stage(command_post__budget_mbit=1) as stage:
            cbor = messages.Style("cbor")
            update = messages.map_update(maps.made_cloud(150000), "r1", 1.0, cbor)
            answer = messages.post(requests.Session(), stage.box.url, "/map/update", update, cbor)
            self.assertEqual(answer.status_code, 200)
            time.sleep(0.3)
            self.assertEqual(stage.post.requests("/map/update"), [], "the map is still on its way")
            self.assertEqual(submit(stage).status_code, 201)
            self.assertEqual(stage.post.requests("/map/update"), [], "the report did not wait for the map")
            wait_until(lambda: stage.post.requests("/map/update"), "the map to arrive")


class Ends(unittest.TestCase):
    """The box or the Command Post restarts."""

    def arrives(self, stage):
        wait_until(lambda: sendings(stage) == 1 or stage.post.control("GET /faults")["reports"] == [],
                   "the report to arrive")

    def test_outcome_is_found_after_a_kill_while_sending(self):
        for fault, ends in ((SILENCE, "settled"), (DEAF, "answered")):
            with self.subTest(fault), Stage(**PATIENT) as stage:
                began(stage).post.will(fault)
                left_unanswered(stage)
                self.arrives(stage)
                stage.box.stop(signal.SIGKILL)
                self.assertEqual(stage.box.on_disk(), ["sending"])
                stage.restart_box()
                wait_until(lambda stage=stage, ends=ends: stage.box.on_disk() == [ends], "it to be found out")
                self.assertEqual(submit(stage).status_code, 201)
                self.assertEqual(len(stage.post.recorded()), 1)

    def test_sigterm_does_not_wait_for_a_report_in_flight(self):
        with Stage(**PATIENT) as stage:
            began(stage).post.will(SILENCE)
            with concurrent.futures.ThreadPoolExecutor(1) as client:
                waiting = client.submit(submit, stage)
                self.arrives(stage)
                self.assertEqual(stage.box.stop(), 0)
                self.assertEqual(waiting.result().status_code, 504)

    def test_waiting_client_is_answered_when_the_service_stops(self):
        with Stage(post_options=None) as stage, concurrent.futures.ThreadPoolExecutor(1) as client:
            waiting = client.submit(submit, stage)
            wait_until(lambda: stage.box.on_disk() == ["queued"], "the report to be on disk")
            self.assertEqual(stage.box.stop(), 0)
            self.assertEqual((waiting.result().status_code, waiting.result().headers["Adit-Report"]), (503, "1"))

    def test_report_during_a_stop_is_rejected_and_not_sent(self):
        # A status that is in flight when the Command Post stops would delay the report.
        with (Stage(**PATIENT | {"command_post__rates__status_hz": 0.01}) as stage, requests.Session() as kept,
              concurrent.futures.ThreadPoolExecutor(2) as clients):
            began(stage)
            kept.get(stage.box.url + "/api/status", headers=TOKEN, timeout=30)  # a connection that stays
            stage.post.process.send_signal(signal.SIGSTOP)
            under_way = clients.submit(submit, stage, another(1))
            wait_until(lambda: stage.box.on_disk() == ["sending"], "the first to be sent")
            waiting = clients.submit(submit, stage, another(2))
            wait_until(lambda: len(stage.box.on_disk()) == 2, "the second to be on disk")
            stage.box.process.send_signal(signal.SIGTERM)
            time.sleep(0.1)
            late = kept.post(stage.box.url + "/api/artifact_reports", data=json.dumps(another(3)),
                             headers={**TOKEN, "Content-Type": "application/json"}, timeout=30)
            stage.post.process.send_signal(signal.SIGCONT)
            self.assertEqual((late.status_code, under_way.result().status_code, waiting.result().status_code),
                             (503, 201, 503))
            self.assertIn("was not accepted", late.json())
            self.assertIn("Adit-Report", waiting.result().headers)
            self.assertEqual(stage.box.stop(), 0)
            self.assertEqual(stage.box.on_disk(), ["answered", "queued"])
