"""Artifact reports: on disk first, one at a time, the Command Post's answer, and nothing but JSON for the client."""

import concurrent.futures
import contextlib
import json
import pathlib
import signal
import sys
import time
import unittest

import requests

import hosts
import maps
import messages
import programs
from programs import Stage, wait_until
from reporting import QUICK, REPORT, another, at_once, began, left_unanswered, sendings, submit

PATIENT = {**QUICK, "command_post__timeouts__scoring_answer_ms": 20000}  # towards the Command Post
TOKEN = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
SILENCE = "answer-after=60"  # recorded, and no answer comes
DEAF = "record-after=60"  # not recorded while a test lasts, and no answer comes


def setUpModule():
    hosts.needs_namespaces()


class ScriptedPost(programs.Program):
    def __init__(self, stage, *words):
        self.seen = stage.folder / "scripted.jsonl"
        script = pathlib.Path(__file__).with_name("scripted_post.py")
        super().__init__(stage.network, stage.network.post, stage.folder / "scripted.log",
                         [sys.executable, "-B", script, f"{hosts.SCORING}:{programs.PORT}", self.seen, *words])
        wait_until(lambda: "listening" in self.said(), "the scripted Command Post")

    def reports(self):
        return [json.loads(line) for line in self.seen.read_text().splitlines()] if self.seen.exists() else []


@contextlib.contextmanager
def scripted(*words):
    """The box, and a Command Post that answers as these words say."""
    with Stage(post_options=None, **{**QUICK, "reports__answer_within_ms": 600000}) as stage:
        stage.scripted = ScriptedPost(stage, *words)
        try:
            wait_until(lambda: requests.get(stage.box.url + "/api/status", headers=TOKEN, timeout=30).status_code == 200,
                       "the box to know the run")  # at once: it was alone for a moment
            yield stage
        finally:
            stage.scripted.stop(signal.SIGKILL)


class Answers(unittest.TestCase):
    def is_json(self, answer, status):
        self.assertEqual(answer.status_code, status, answer.text)
        self.assertEqual(answer.headers["Content-Type"], "application/json")
        self.assertNotIn("WWW-Authenticate", answer.headers)
        self.assertIsInstance(answer.json(), (str, dict))

    def test_the_client_gets_the_command_posts_own_status_and_bytes(self):
        with scripted() as stage:
            answer = submit(stage, {**REPORT, "name": "robot1"})
            self.is_json(answer, 201)
            self.assertEqual(answer.json()["url"], "http://<ipaddress>:<port>/api/artifact_reports/1")
            self.assertIn('": ', answer.text, "its spaces too")
            self.assertEqual(stage.scripted.reports(), [REPORT], "the robot's name stays here")
            self.assertEqual(stage.box.on_disk(), ["answered"])

    def test_a_report_that_the_command_post_will_not_have_is_refused_and_may_be_posted_again(self):
        for word, said in (("422:Missing field: 'y'", "Missing field: 'y'"), ("400:No JSON.", "No JSON."),
                           ("413:too large", "too large")):
            with self.subTest(word), scripted(word) as stage:
                answer = submit(stage)
                self.is_json(answer, int(word[:3]))
                self.assertIn(said, answer.json())
                self.assertEqual(stage.box.on_disk(), ["refused"])
                self.is_json(submit(stage), 201)
                self.assertEqual(len(stage.scripted.reports()), 2)

    def test_where_nobody_may_enter_the_report_is_kept_and_its_client_told_at_once(self):
        for word in ("401:Invalid token.", "403", "404", "405", "407"):
            with self.subTest(word), scripted(word) as stage:
                told = submit(stage)  # which waits for less than the box would
                self.is_json(told, 503)
                self.assertIn("is kept and waiting", told.json())
                self.is_json(submit(stage), 201)
                self.assertEqual(len(stage.scripted.reports()), 2)

    def test_an_answer_that_may_be_anybodys_is_not_believed(self):
        for word in ("302", "400", "408", "502", "503", "200", "201"):
            with self.subTest(word), scripted(word) as stage:
                self.is_json(submit(stage), 201)
                self.assertEqual(stage.box.on_disk("SELECT tries FROM report"), [1])
                self.assertEqual(len(stage.scripted.reports()), 2)

    def test_status_is_answered_from_what_is_known_for_a_second(self):
        with Stage() as stage:
            url = began(stage).box.url + "/api/status"
            before, began_at = len(stage.post.requests("/api/status")), time.monotonic()
            first = requests.get(url, headers=TOKEN, timeout=30)
            self.assertEqual((first.status_code, first.json()["remaining_reports"]), (200, 45))
            told = {requests.get(url, headers=TOKEN, timeout=30).text for _ in range(20)} - {first.text}
            asked = len(stage.post.requests("/api/status")) - before
            self.assertLessEqual(asked, 1 + time.monotonic() - began_at)
            wait_until(lambda: len(stage.post.requests("/api/status")) - before >= len(told), "each new one to be the Command Post's")

    def test_status_without_a_command_post_is_a_json_error(self):
        with Stage(post_options=None) as stage:
            answer = requests.get(stage.box.url + "/api/status", headers=TOKEN, timeout=60)
            self.assertIn(answer.status_code, (502, 503))
            self.assertIsInstance(answer.json(), str)


class Order(unittest.TestCase):
    def test_reports_go_one_at_a_time_and_not_faster_than_allowed(self):
        with Stage(post_options=("--rate", "1"), command_post__rates__reports_hz=1) as stage:
            stage.post.will("answer-after=0.3")
            posted = time.monotonic()
            answers = at_once(*[lambda n=n: submit(stage, another(n)) for n in (1, 2, 3)])
            self.assertEqual([answer.status_code for answer in answers], [201] * 3)
            self.assertGreater(time.monotonic() - posted, 2.0)
            self.assertEqual([request["status"] for request in stage.post.requests("/api/artifact_reports")], [201] * 3)

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
    """The box, or the Command Post, comes and goes."""

    def arrives(self, stage):
        wait_until(lambda: sendings(stage) == 1 or stage.post.control("GET /faults")["reports"] == [],
                   "the report to arrive")

    def test_a_report_waits_on_disk_while_the_command_post_is_away_and_its_client_is_told(self):
        with Stage(post_options=None, reports__answer_within_ms=700) as stage:
            answer = submit(stage)
            self.assertEqual(answer.status_code, 503)
            self.assertIn("kept and waiting", answer.json())
            self.assertEqual(stage.box.on_disk(), ["waiting"])
            stage.post = programs.CommandPost(stage.network, stage.folder, "--rate", "0")
            wait_until(lambda: stage.box.on_disk() == ["answered"], "the report to be sent now")
            self.assertEqual(len(stage.post.recorded()), 1)

    def test_a_report_survives_a_kill_and_goes_out_after_it(self):
        with Stage(post_options=None) as stage:
            left_unanswered(stage)
            wait_until(lambda: stage.box.on_disk() == ["waiting"], "the report to be on disk")
            stage.box.stop(signal.SIGKILL)
            stage.post = programs.CommandPost(stage.network, stage.folder, "--rate", "0")
            stage.restart_box()
            wait_until(lambda: stage.box.on_disk() == ["answered"], "the report to go out")
            self.assertEqual(len(stage.post.recorded()), 1)

    def test_a_kill_while_an_answer_is_awaited_is_found_out_after_it(self):
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

    def test_sigterm_does_not_wait_for_a_report_under_way(self):
        with Stage(**PATIENT) as stage:
            began(stage).post.will(SILENCE)
            with concurrent.futures.ThreadPoolExecutor(1) as client:
                waiting = client.submit(submit, stage)
                self.arrives(stage)
                self.assertEqual(stage.box.stop(), 0)
                self.assertEqual(waiting.result().status_code, 504)
                self.assertIn("may or may not have been recorded", waiting.result().json())

    def test_a_client_that_waits_is_told_when_the_service_stops(self):
        with Stage(post_options=None) as stage, concurrent.futures.ThreadPoolExecutor(1) as client:
            waiting = client.submit(submit, stage)
            wait_until(lambda: stage.box.on_disk() == ["waiting"], "the report to be on disk")
            self.assertEqual(stage.box.stop(), 0)
            self.assertEqual(waiting.result().status_code, 503)
            self.assertIn("is kept", waiting.result().json())

    def test_a_report_that_comes_while_the_service_stops_is_refused_and_never_sent(self):
        with (Stage(**PATIENT) as stage, requests.Session() as kept,
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
            self.assertIn("was not taken", late.json())
            self.assertIn("is kept", waiting.result().json())
            self.assertEqual(stage.box.stop(), 0)
            self.assertEqual(stage.box.on_disk(), ["answered", "waiting"])
