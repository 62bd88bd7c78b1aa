"""A mapping endpoint that refuses clouds with a point at x = 13, with the status it is told.

    python3 picky_post.py ADDRESS:PORT LOG STATUS

Each request becomes a line of LOG: the status it was answered with, and the x of its points.
"""

import gzip
import http.server
import json
import struct
import sys

import cbor2

POINT_STEP = 12


class PickyPost(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_POST(self):
        message = cbor2.loads(self.rfile.read(int(self.headers["Content-Length"])))["msg"]
        data = gzip.decompress(message["data"]) if message["compression"] == "gzip" else message["data"]
        points = [struct.unpack_from("<f", data, at)[0] for at in range(0, len(data), POINT_STEP)]
        status = int(sys.argv[3]) if 13.0 in points else 200
        with open(sys.argv[2], "a", encoding="utf-8") as log:
            log.write(json.dumps([status, points]) + "\n")
        answer = b"null" if status == 200 else b'"not this one"'
        self.send_response(status)
        self.send_header("Content-Length", str(len(answer)))
        self.end_headers()
        self.wfile.write(answer)

    def log_message(self, *_):
        pass


address, _, port = sys.argv[1].rpartition(":")
server = http.server.ThreadingHTTPServer((address, int(port)), PickyPost)
print("listening", flush=True)
server.serve_forever()
