"""A relay that a team writes in an hour: LISTEN MAPPING SCORING. It answers maps, states and markers at once, keeps the newest body
of each URI, and sends one of each per second. It passes on reports and the status."""

import http.client
import http.server
import sys
import threading
import time

KEPT = ("/map/update", "/state/update", "/markers/update")
newest = {}
changed = threading.Condition()


class Desk(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path not in KEPT:
            return self.pass_on(body)
        with changed:
            newest[self.path] = (body, self.passed())
            changed.notify_all()
        return self.reply(200, b"null")

    def do_GET(self):
        self.pass_on(None)

    def passed(self):
        names = ("Authorization", "Content-Type", "Content-Encoding")
        return {name: self.headers[name] for name in names if name in self.headers}

    def pass_on(self, body):
        scoring = http.client.HTTPConnection(sys.argv[3], timeout=30)
        scoring.request(self.command, self.path, body, self.passed())
        answer = scoring.getresponse()
        self.reply(answer.status, answer.read())
        scoring.close()

    def reply(self, status, body):
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


def send(path):
    """Requests start a little more than a second apart."""
    mapping = http.client.HTTPConnection(sys.argv[2], timeout=30)
    while True:
        with changed:
            changed.wait_for(lambda: path in newest)
            body, headers = newest.pop(path)
        started = time.monotonic()
        try:
            mapping.request("POST", path, body, headers)
            mapping.getresponse().read()
        except OSError:
            mapping.close()
        time.sleep(max(0, started + 1.02 - time.monotonic()))


for each in KEPT:
    threading.Thread(target=send, args=(each,), daemon=True).start()
address, port = sys.argv[1].split(":")
http.server.ThreadingHTTPServer((address, int(port)), Desk).serve_forever()
