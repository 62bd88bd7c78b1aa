"""A Command Post that serves one connection at a time: Python's single-threaded server, with keep-alive, for both endpoints."""

import gzip
import http.server
import json
import threading
import time
import unittest

import cbor2
import requests

import hosts
import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until
from reporting import another, submit

CBOR = Style("cbor")
SECONDS = 12
POINTS = 50  # of a cloud


class Serial(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def answer(self, status, body):
        content = json.dumps(body).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def run_clock(self):
        return time.monotonic() - self.server.began

    def do_GET(self):
        got = self.server.got
        got.append((self.path, None))
        count = len(self.server.reports())
        self.answer(200, {"score": count, "run_clock": self.run_clock(), "remaining_reports": 20 - count, "current_team": "subt"})

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        is_report = self.path == "/api/artifact_reports"
        message = json.loads(body) if is_report else cbor2.loads(body)
        self.server.got.append((self.path, message))
        reply = {**message, "run": "1", "team": "subt", "run_clock": self.run_clock(), "score_change": 1,
                 "report_status": "scored", "submitted_datetime": "2021-09-21T12:00:00Z", "url": "", "id": 1} if is_report else None
        self.answer(201 if is_report else 200, reply)

    def log_message(self, *_):
        pass


class SerialPost(http.server.HTTPServer):
    def __init__(self):
        self.got, self.began = [], time.monotonic()
        super().__init__((hosts.SCORING, programs.PORT), Serial)
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def messages(self, uri):
        return [message for path, message in list(self.got) if path == uri]

    def reports(self):
        return self.messages("/api/artifact_reports")

    def points(self):
        found = 0
        for update in self.messages("/map/update"):
            message = update["msg"]
            data = gzip.decompress(message["data"]) if message.get("compression") == "gzip" else message["data"]
            found += len(data) // message["point_step"]
        return found


class TestSerial(unittest.TestCase):
    def test_all_messages_arrive(self):
        rates = {f"command_post__rates__{kind}_hz": 1 for kind in ("reports", "status", "map", "state", "markers")}
        stage = self.enterContext(Stage(post_options=None, command_post__mapping={"address": hosts.SCORING, "port": programs.PORT},
                                        **rates))
        post = stage.network.made_in(stage.network.post, SerialPost)
        wait_until(stage.box.knows_the_run, "the box to know the run")
        session, sent = requests.Session(), []
        for number in range(2 * SECONDS):
            cloud = messages.map_update(maps.made_cloud(POINTS, number), "r1", time.time(), CBOR)
            state = {"poses": [{"name": "r1", "position": {"x": float(number), "y": 0.0, "z": 0.0},
                                "orientation": dict(maps.IDENTITY)}]}
            for uri, message in (("/map/update", cloud), ("/state/update", state)):
                self.assertEqual(messages.post(session, stage.box.url, uri, message, CBOR).status_code, 200)
            if number % 8 == 4:
                sent.append(another(number))
                self.assertEqual(submit(stage, sent[-1]).status_code, 201)
            time.sleep(0.5)
        counts = {uri: len(post.messages(uri)) for uri in ("/map/update", "/state/update", "/api/artifact_reports", "/api/status")}
        print(f"in {SECONDS} s:", counts)
        self.assertGreater(counts["/map/update"], SECONDS / 2)
        self.assertGreater(counts["/state/update"], SECONDS / 2)
        wait_until(lambda: post.points() == 2 * SECONDS * POINTS, "all clouds")
        wait_until(lambda: post.messages("/state/update")[-1]["poses"][0]["position"]["x"] == 2 * SECONDS - 1, "the last state")
        self.assertEqual([{name: report[name] for name in programs.FIELDS} for report in post.reports()], sent)
        answer = requests.get(stage.box.url + "/api/status", timeout=30, headers=messages.headers(CBOR))
        self.assertEqual(answer.json()["score"], len(sent))


if __name__ == "__main__":
    unittest.main()
