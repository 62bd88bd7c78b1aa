"""A Command Post that accepts and records every request: both endpoints on one port of loopback."""

import contextlib
import http.server
import json
import socket
import threading
import time


class CommandPost:
    """Listens until close()."""

    def __init__(self):
        self.requests, self.clients, self.lock = [], [], threading.Lock()  # (path, token, body, when)
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self.thread = threading.Thread(target=self.server.serve_forever, args=(0.02,), daemon=True)
        self.thread.start()

    @property
    def address(self):
        return {"address": "127.0.0.1", "port": self.server.server_port}

    def heard(self, path):
        """The bodies received at `path`, each with its token."""
        with self.lock:
            return [(token, body) for at, token, body, _ in self.requests if at == path]

    def times(self, path):
        with self.lock:
            return [when for at, _, _, when in self.requests if at == path]

    def close(self):
        """Closes everything, connections too, as if its plug were pulled."""
        self.server.shutdown()
        self.server.server_close()
        for client in self.clients:
            with contextlib.suppress(OSError):
                client.shutdown(socket.SHUT_RDWR)

    def _handler(self):
        post = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def setup(self):
                post.clients.append(self.request)
                super().setup()

            def do_GET(self):
                self.answer(200, {"score": 0, "remaining_reports": 25, "current_team": "adit", "run_clock": 12.5})

            def do_POST(self):
                body = self.body()
                if self.path != "/api/artifact_reports":
                    return self.answer(200, None, body)
                return self.answer(201, {**json.loads(body), "url": "http://127.0.0.1/1", "id": 1,
                                         "submitted_datetime": "2026-01-01T00:00:00Z", "run_clock": 12.5, "team": "adit", "run": "1",
                                         "report_status": "scored", "score_change": 1}, body)

            def body(self):
                return self.rfile.read(int(self.headers.get("Content-Length", 0)))

            def answer(self, status, document, body=None):
                body = self.body() if body is None else body
                token = self.headers.get("Authorization", "").removeprefix("Bearer ")
                with post.lock:
                    post.requests.append((self.path, token, body, time.monotonic()))
                text = json.dumps(document).encode()
                self.send_response(status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(text)))
                self.end_headers()
                self.wfile.write(text)

            def log_message(self, *_):
                pass

        return Handler
