"""A relay that a team writes in an hour, LISTEN MAPPING TOKEN: converts each map to CBOR and gzip, answers, and sends it."""

import base64
import gzip
import http.server
import json
import sys
import threading

import cbor2
import requests

upstream = threading.Lock()  # one at a time
session = requests.Session()


def packed(body, kind):
    """The message for the Command Post."""
    update = cbor2.loads(body) if kind == "application/cbor" else json.loads(body)
    data = update["msg"]["data"]
    if isinstance(data, str):
        data = base64.b64decode(data)
    elif isinstance(data, list):
        data = bytes(value & 255 for value in data)
    update["msg"]["data"] = gzip.compress(data, 6)
    update["msg"]["compression"] = "gzip"
    return cbor2.dumps(update)


class Desk(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_POST(self):
        body = packed(self.rfile.read(int(self.headers["Content-Length"])), self.headers["Content-Type"])
        self.send_response(200)
        self.send_header("Content-Length", "4")
        self.end_headers()
        self.wfile.write(b"null")
        with upstream:
            session.post(f"http://{sys.argv[2]}/map/update", data=body, timeout=30,
                         headers={"Authorization": f"Bearer {sys.argv[3]}", "Content-Type": "application/cbor"})

    def log_message(self, *_):
        pass


address, port = sys.argv[1].split(":")
http.server.ThreadingHTTPServer((address, int(port)), Desk).serve_forever()
