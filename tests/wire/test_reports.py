"""Artifact reports: on disk first, one at a time, the Command Post's own answer, and nothing but JSON for the client."""

import concurrent.futures
import contextlib
import json
import pathlib
import shutil
import signal
import sqlite3
import sys
import tempfile
import time
import unittest

import requests

import hosts
import messages
import programs
from programs import Stage, wait_until

REPORT = {"x": 1011.242, "y": -244.433, "z": -10.011, "type": "backpack", "name": "robot1"}
HEADERS = {"Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"}


def setUpModule():
    hosts.needs_namespaces()


def submit(stage, report=None, timeout=30):
    return requests.post(stage.box.url + "/api/artifact_reports", data=json.dumps(report or REPORT), headers=HEADERS,
                         timeout=timeout)


def states(stage):
    """The states of all reports as they are on disk: read from a copy, as aditd keeps the ledger to itself."""
    with tempfile.TemporaryDirectory() as copy:
        for file in stage.box.state.glob("ledger.sqlite*"):
            shutil.copy(file, copy)
        with contextlib.closing(sqlite3.connect(f"{copy}/ledger.sqlite")) as ledger:
            return [row[0] for row in ledger.execute("SELECT state FROM report ORDER BY number")]


class ScriptedPost(programs.Program):
    def __init__(self, network, folder, *words):
        self.seen = folder / "scripted.jsonl"
        script = pathlib.Path(__file__).with_name("scripted_post.py")
        super().__init__(network, network.post, folder / "scripted.log",
                         [sys.executable, "-B", script, f"{hosts.SCORING}:{programs.PORT}", self.seen, *words])
        wait_until(lambda: "listening" in self.said(), "the scripted Command Post")

    def reports(self):
        if not self.seen.exists():
            return []
        lines = [json.loads(line) for line in self.seen.read_text().splitlines()]
        return [content for method, _, content in lines if method == "POST"]


class Reports(unittest.TestCase):
    def stage(self, *words, **overrides):
        """The box, and a scripted Command Post (none where there are no words)."""
        stage = self.enterContext(Stage(post_options=None, **overrides))
        if words:
            stage.scripted = ScriptedPost(stage.network, stage.folder, *words)
            self.addCleanup(stage.scripted.stop, signal.SIGKILL)
        return stage

    def test_the_client_gets_the_command_posts_own_status_and_bytes(self):
        stage = self.stage("ok")
        answer = submit(stage)
        self.assertEqual(answer.status_code, 201)
        self.assertEqual(answer.headers["Content-Type"], "application/json")
        self.assertEqual(answer.json()["url"], "http://<ipaddress>:<port>/api/artifact_reports/1")
        self.assertEqual(answer.json()["score_change"], 0)
        sent = json.loads(stage.scripted.reports()[0])
        self.assertEqual(sent, {key: REPORT[key] for key in ("x", "y", "z", "type")})
        self.assertEqual(states(stage), ["answered"])

    def test_every_error_is_json_whatever_the_command_post_sent(self):
        for word, status in (("html500", 500), ("html404", 404), ("422", 422), ("detail401", 401), ("garbage", 504),
                             ("half", 504), ("close", 504), ("reset", 504)):
            with self.subTest(word), Stage(post_options=None) as stage:
                post = ScriptedPost(stage.network, stage.folder, word)
                self.addCleanup(post.stop, signal.SIGKILL)
                answer = submit(stage)
                self.assertEqual(answer.status_code, status, answer.text)
                self.assertEqual(answer.headers["Content-Type"], "application/json")
                self.assertNotIn("WWW-Authenticate", answer.headers)
                self.assertIsInstance(answer.json(), (str, dict))
                self.assertEqual(len(post.reports()), 1)

    def test_a_report_whose_answer_was_lost_is_in_doubt_and_never_sent_again(self):
        stage = self.stage("reset", command_post__timeouts__scoring_answer_ms=500)
        self.assertIn("in doubt", submit(stage).json())
        self.assertEqual(states(stage), ["in doubt"])
        time.sleep(2.5)
        self.assertEqual(len(stage.scripted.reports()), 1)
        stage.box.stop(signal.SIGKILL)
        stage.restart_box()
        time.sleep(1.5)
        self.assertEqual(len(stage.scripted.reports()), 1)
        view = requests.get(stage.box.url + "/adit/run", timeout=5).json()
        self.assertIn("in doubt", " ".join(view["attention"]))

    def test_a_429_is_tried_again_until_it_is_recorded(self):
        stage = self.stage("429", "429", "ok")
        answer = submit(stage)
        self.assertEqual(answer.status_code, 201)
        self.assertEqual(len(stage.scripted.reports()), 3)

    def test_reports_go_one_at_a_time_and_not_faster_than_allowed(self):
        stage = self.stage("slow0.3", "slow0.3", "ok", command_post__rates__reports_hz=1)
        began = time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(3) as clients:
            answers = list(clients.map(lambda x: submit(stage, {**REPORT, "x": x}), (1, 2, 3)))
        self.assertEqual([answer.status_code for answer in answers], [201] * 3)
        self.assertGreater(time.monotonic() - began, 2.0)

    def test_a_report_waits_on_disk_while_the_command_post_is_away_and_its_client_is_told(self):
        stage = self.stage(reports__answer_within_ms=700)
        answer = submit(stage)
        self.assertEqual(answer.status_code, 503)
        self.assertIn("kept and waiting", answer.json())
        self.assertEqual(states(stage), ["waiting"])
        post = ScriptedPost(stage.network, stage.folder, "ok")
        self.addCleanup(post.stop, signal.SIGKILL)
        wait_until(lambda: states(stage) == ["answered"], "the report to be sent once there is a Command Post")
        self.assertEqual(len(post.reports()), 1)

    def test_a_report_survives_a_kill_and_goes_out_after_it(self):
        stage = self.stage()
        with concurrent.futures.ThreadPoolExecutor(1) as client:
            waiting = client.submit(lambda: self.assertRaises(requests.RequestException, submit, stage))
            wait_until(lambda: states(stage) == ["waiting"], "the report to be on disk")
            stage.box.stop(signal.SIGKILL)
            waiting.result()
        post = ScriptedPost(stage.network, stage.folder, "ok")
        self.addCleanup(post.stop, signal.SIGKILL)
        stage.restart_box()
        wait_until(lambda: states(stage) == ["answered"], "the report to go out")
        self.assertEqual(len(post.reports()), 1)

    def test_a_kill_while_an_answer_is_awaited_leaves_it_in_doubt(self):
        stage = self.stage("silence")
        with concurrent.futures.ThreadPoolExecutor(1) as client:
            waiting = client.submit(lambda: self.assertRaises(requests.RequestException, submit, stage))
            wait_until(stage.scripted.reports, "the report to arrive")
            stage.box.stop(signal.SIGKILL)
            waiting.result()
        stage.restart_box()
        self.assertEqual(states(stage), ["in doubt"])
        time.sleep(1.5)
        self.assertEqual(len(stage.scripted.reports()), 1)

    def test_sigterm_stops_within_a_second_with_a_report_under_way(self):
        stage = self.stage("silence")
        with concurrent.futures.ThreadPoolExecutor(1) as client:
            client.submit(lambda: self.assertRaises(requests.RequestException, submit, stage))
            wait_until(stage.scripted.reports, "the report to arrive")
            status, took = stage.box.stop()
        self.assertEqual(status, 0)
        self.assertLess(took, 1.5)

    def test_a_client_that_waits_is_told_when_the_service_stops(self):
        stage = self.stage()
        with concurrent.futures.ThreadPoolExecutor(1) as client:
            waiting = client.submit(submit, stage)
            wait_until(lambda: states(stage) == ["waiting"], "the report to be on disk")
            self.assertEqual(stage.box.stop()[0], 0)
        self.assertEqual(waiting.result().status_code, 503)
        self.assertIn("is kept", waiting.result().json())

    def test_a_report_that_comes_while_the_service_stops_is_refused_and_never_sent(self):
        stage = self.stage("slow0.6")
        with requests.Session() as kept, concurrent.futures.ThreadPoolExecutor(2) as clients:
            kept.get(stage.box.url + "/api/status", headers=HEADERS, timeout=5)  # a connection that stays
            under_way = clients.submit(submit, stage, {**REPORT, "x": 1})
            wait_until(stage.scripted.reports, "the first report to arrive")
            waiting = clients.submit(submit, stage, {**REPORT, "x": 2})
            wait_until(lambda: len(states(stage)) == 2, "the second to be on disk")
            stage.box.process.send_signal(signal.SIGTERM)
            time.sleep(0.1)
            late = kept.post(stage.box.url + "/api/artifact_reports", data=json.dumps({**REPORT, "x": 3}),
                             headers=HEADERS, timeout=5)
            self.assertEqual((late.status_code, under_way.result().status_code, waiting.result().status_code),
                             (503, 201, 503))
            self.assertIn("was not taken", late.json())
            self.assertIn("is kept", waiting.result().json())
        self.assertEqual(stage.box.stop()[0], 0)
        self.assertEqual(states(stage), ["answered", "waiting"])

    def test_status_is_answered_from_what_is_known_for_a_second(self):
        stage = self.stage("ok")
        url = stage.box.url + "/api/status"

        def asked():
            lines = [json.loads(line) for line in stage.scripted.seen.read_text().splitlines()]
            return len([line for line in lines if line[0] == "GET"])

        first = requests.get(url, headers=HEADERS, timeout=5)
        self.assertEqual((first.status_code, first.json()["remaining_reports"]), (200, 20))
        before = asked()
        for _ in range(20):
            self.assertEqual(requests.get(url, headers=HEADERS, timeout=5).json(), first.json())
        self.assertLessEqual(asked(), before + 1)

    def test_status_without_a_command_post_is_a_json_error(self):
        stage = self.stage()
        answer = requests.get(stage.box.url + "/api/status", headers=HEADERS, timeout=15)
        self.assertIn(answer.status_code, (502, 503))
        self.assertIsInstance(answer.json(), str)

    def test_a_report_overtakes_maps_that_fill_the_link(self):
        with Stage(command_post__budget_mbit=8) as stage:
            import maps
            session = requests.Session()
            cloud = maps.made_cloud(150000)
            answer = messages.post(session, stage.box.url, "/map/update",
                                   messages.map_update(cloud, "r1", 1.0, messages.Style("cbor")), messages.Style("cbor"))
            self.assertEqual(answer.status_code, 200)
            time.sleep(0.3)
            self.assertEqual(stage.post.requests("/map/update"), [], "the map is still on its way")
            self.assertEqual(submit(stage).status_code, 201)
            self.assertEqual(stage.post.requests("/map/update"), [], "the report did not wait for the map")
            wait_until(lambda: stage.post.requests("/map/update"), "the map to arrive")


if __name__ == "__main__":
    unittest.main()
