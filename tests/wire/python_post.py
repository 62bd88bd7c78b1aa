"""A Command Post of Python's http.server, for both endpoints. It serves one connection at a time, with keep-alive."""

import gzip
import http.server
import json
import threading
import time

import cbor2

import hosts
import programs


class Handler(http.server.BaseHTTPRequestHandler):
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
        self.server.got.append((self.path, None))
        count = len(self.server.reports())
        self.answer(200, {"score": count, "run_clock": self.run_clock(), "remaining_reports": 20 - count, "current_team": "subt"})

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        is_report = self.path == "/api/artifact_reports"
        message = json.loads(body) if is_report else cbor2.loads(body)
        if status := self.server.rejects(self.path, message):
            return self.answer(status, {"detail": "rejected"})
        self.server.got.append((self.path, message))
        reply = {**message, "run": "1", "team": "subt", "run_clock": self.run_clock(), "score_change": 1,
                 "report_status": "scored", "submitted_datetime": "2021-09-21T12:00:00Z", "url": "", "id": 1} if is_report else None
        return self.answer(201 if is_report else 200, reply)

    def log_message(self, *_):
        pass


class PythonPost(http.server.HTTPServer):
    """Accepted messages are in messages()."""

    def __init__(self):
        self.got, self.began = [], time.monotonic()
        self.rejects = lambda path, message: 0  # the status of a rejection
        super().__init__((hosts.SCORING, programs.PORT), Handler)
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


def stage_of(case):
    """A box whose endpoints are one PythonPost, and the PythonPost. Each URI may have a message a second."""
    rates = {f"command_post__rates__{kind}_hz": 1 for kind in ("reports", "status", "map", "state", "markers")}
    stage = case.enterContext(programs.Stage(
        post_options=None, command_post__mapping={"address": hosts.SCORING, "port": programs.PORT}, **rates))
    post = stage.network.made_in(stage.network.post, PythonPost)
    programs.wait_until(stage.box.knows_the_run, "the box to know the run")
    return stage, post
