"""The test of the mapping endpoint tells other servers from Command Posts, and shows no robot or marker to the organiser."""

import http.server
import shutil
import socketserver
import threading
import unittest

import hosts
from programs import CommandPost, Program, Stage, wait_until

FIRST_PORT = 8100
PAGE = b"<html><body>Welcome</body></html>"
JSON = {"Content-Type": "application/json"}


def to_all(status, body=b"", **headers):
    return lambda path: (status, headers, body)


def to_the_path_of_states(status, body):
    """A stand-in for a Command Post that knows only its own paths."""
    return lambda path: (status, JSON, body) if path == "/state/update" else (404, JSON, b'{"detail": "Not Found"}')


STAND_INS = {
    "422 to an empty state": to_the_path_of_states(422, b'"Missing field: \'poses\'"'),
    "200 to an empty state": to_the_path_of_states(200, b"null"),
    "400 to an empty state": to_the_path_of_states(400, b'{"detail": "no poses"}'),
}
# Each server with the words about it.
OTHERS = {
    "200 with nothing": (to_all(200), "POST /state/update with 200 and POST /adit-test, which no Command Post has, with 200"),
    "200 with JSON": (to_all(200, b'{"status": "ok"}', **JSON), "accepts any path"),
    "204": (to_all(204), "accepts any path"),
    "400 with nothing": (to_all(400), "accepts any path"),
    "415 with JSON": (to_all(415, b'"Unsupported Media Type"', **JSON), "accepts any path"),
    "422 with JSON": (to_all(422, b'{"detail": "bad request"}', **JSON), "accepts any path"),
    "200 with a page": (to_all(200, PAGE), "the answer is 200 with a body that is not JSON"),
    "a redirect to a login": (to_all(302, Location="http://10.0.0.1/login"), "the answer is 302 without a body"),
    "a router's 401": (to_all(401, PAGE, **{"WWW-Authenticate": 'Basic realm="router"'}), "the answer is 401 with a body that is not JSON"),
    "404 with a page": (to_all(404, PAGE), "the answer is 404 with a body that is not JSON"),
    "404 with JSON": (to_all(404, b'{"detail": "Not Found"}', **JSON), "the answer is 404: Not Found"),
}
NGINX = """daemon off; pid nginx.pid; error_log stderr; events {{}}
http {{
  access_log off;
  client_body_temp_path {at}; proxy_temp_path {at}; fastcgi_temp_path {at}; uwsgi_temp_path {at}; scgi_temp_path {at};
  server {{ listen {address}:8201; root /usr/share/nginx/html; }}
  server {{ listen {address}:8202; return 200; }}
  server {{ listen {address}:8203; default_type application/json; return 200 '{{}}'; }}
}}
"""


class Answers(http.server.BaseHTTPRequestHandler):
    """Gives `server.answer_to(path)` to each request: status, headers and body."""

    protocol_version = "HTTP/1.1"

    def answer(self):
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        self.server.got.append((self.command, self.path, body))
        status, headers, body = self.server.answer_to(self.path)
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        if status != 204:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    do_GET = do_POST = answer

    def log_message(self, *_):
        pass


class Files(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Banner(socketserver.StreamRequestHandler):
    """An SSH server's first line."""

    def handle(self):
        self.wfile.write(b"SSH-2.0-OpenSSH_9.2p1\r\n")


class OtherServers(unittest.TestCase):
    def setUp(self):
        self.stage = self.enterContext(Stage())
        wait_until(self.stage.box.knows_the_run, "the run to be known")
        self.port = FIRST_PORT

    def serves(self, handler, kind=http.server.ThreadingHTTPServer):
        """A server at the mapping endpoint's machine, at another port."""
        self.port += 1
        server = self.stage.network.made_in(self.stage.network.post, lambda: kind((hosts.MAPPING, self.port), handler))
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        return server

    def answers(self, answer_to):
        server = self.serves(Answers)
        server.answer_to, server.got = answer_to, []
        return server

    def step(self, port, address=hosts.MAPPING):
        """The step of the token, in a test of this address alone."""
        said = self.stage.box.ask("POST /adit/test", body={"mapping": {"address": address, "port": port}})
        self.assertEqual(said[0], 200, said)
        view = wait_until(lambda: not (view := self.stage.box.ask("GET /adit/test")[1])["running"] and view, "the test to end")
        steps = {step["name"]: step for step in view["endpoints"][0]["steps"]}
        self.assertEqual(steps["reach"]["state"], "good", steps)
        return steps["token"]

    def is_no_command_post(self, port, words, advice="This is no mapping endpoint: compare the mapping address and port", **at):
        step = self.step(port, **at)
        self.assertEqual(step["state"], "bad", step)
        self.assertIn(words, step["said"])
        self.assertIn(advice, step["advice"])

    def test_servers_that_are_no_command_post_fail(self):
        for name, (answer_to, words) in OTHERS.items():
            with self.subTest(name):
                server = self.answers(answer_to)
                self.is_no_command_post(server.server_port, words)
                self.assertEqual({(method, body) for method, _, body in server.got}, {("POST", b"{}")})
        with self.subTest("the scoring endpoint"):
            self.is_no_command_post(8000, "the answer is 404", address=hosts.SCORING)
        with self.subTest("Python's file server"):
            self.is_no_command_post(self.serves(Files).server_port, "the answer is 501 with a body that is not JSON")
        with self.subTest("an SSH server"):
            self.serves(Banner, socketserver.ThreadingTCPServer)
            self.is_no_command_post(self.port, "POST /state/update to", "compare the mapping port")

    def test_nginx_fails(self):
        program = shutil.which("nginx", path="/usr/sbin:/usr/bin")
        if program is None:
            self.skipTest("needs nginx")
        folder = self.stage.folder
        (folder / "nginx.conf").write_text(NGINX.format(at=folder, address=hosts.MAPPING))
        nginx = Program(self.stage.network, self.stage.network.post, folder / "nginx.log", [program, "-p", folder, "-c", folder / "nginx.conf"])
        self.addCleanup(nginx.stop)
        wait_until((folder / "nginx.pid").exists, nginx.output)
        self.is_no_command_post(8201, "the answer is 404 with a body that is not JSON")
        self.is_no_command_post(8202, "accepts any path")
        self.is_no_command_post(8203, "accepts any path")

    def test_command_posts_pass(self):
        for name, answer_to in STAND_INS.items():
            with self.subTest(name):
                step = self.step(self.answers(answer_to).server_port)
                self.assertEqual(step["state"], "good", step)
        for number, options in enumerate([(), ("--as-measured",), ("--slash",)]):
            with self.subTest(options):
                post = CommandPost(self.stage.network, self.stage.folder, *options, name=f"other{number}", port=9000 + number,
                                   control_port=9100 + number)
                self.addCleanup(post.stop)
                step = self.step(9000 + number)
                self.assertEqual(step["state"], "good", step)
                self.assertEqual([request for request in post.requests() if request["status"] == 200], [], "it accepts nothing")
