"""A scoring endpoint that answers reports as it is told, one word for each, with what only a bad Command Post says.

    python3 scripted_post.py ADDRESS:PORT LOG WORD [WORD ...]

A word is "ok" (201, recorded), a status ("404": with an HTML page) or a status and a JSON string ("422:Missing field").
After the last word all are "ok". The run's status is answered by what was recorded. Each report becomes a line of LOG.
"""

import http.server
import json
import sys
import threading
import time

words = sys.argv[3:]
lock = threading.Lock()
began = time.monotonic()
recorded = 0


class ScriptedPost(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_GET(self):
        status = {"score": 0, "run_clock": time.monotonic() - began, "remaining_reports": 20 - recorded}
        self.answer(200, json.dumps({**status, "current_team": "adit"}))

    def do_POST(self):
        global recorded
        report = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        with lock:
            with open(sys.argv[2], "a", encoding="utf-8") as log:
                log.write(json.dumps(report) + "\n")
            word = words.pop(0) if words else "ok"
            recorded += word == "ok"
        if word == "ok":
            made = {"url": "http://<ipaddress>:<port>/api/artifact_reports/1", "id": recorded, **report,
                    "submitted_datetime": "2021-09-24T00:00:00", "run_clock": time.monotonic() - began, "team": "adit",
                    "run": "1", "report_status": "scored", "score_change": 0}
            return self.answer(201, json.dumps(made))
        status, _, sentence = word.partition(":")
        if sentence:
            return self.answer(int(status), json.dumps(sentence))
        return self.answer(int(status), "<h1>From something in between</h1>", "text/html")

    def answer(self, status, content, content_type="application/json"):
        self.send_response(status)
        self.send_header("Content-Type", content_type)
        self.send_header("Content-Length", str(len(content)))
        if status in (401, 407):
            self.send_header("WWW-Authenticate", "Bearer")
        self.end_headers()
        self.wfile.write(content.encode())

    def log_message(self, *_):
        pass


address, _, port = sys.argv[1].rpartition(":")
server = http.server.ThreadingHTTPServer((address, int(port)), ScriptedPost)
print("listening", flush=True)
server.serve_forever()
