"""Attackers with addresses of their own: slow heads, held sockets, floods, wrong tokens, and invalid messages. Each is a thread that
runs until stop()."""

import contextlib
import http.client
import itertools
import pathlib
import random
import socket
import threading

import programs

SEEDS = pathlib.Path(__file__).resolve().parents[1] / "fuzz/seeds"
URIS = ("/map/update", "/state/update", "/markers/update")


class Hostile(threading.Thread):
    """`sources`: the attacker's addresses."""

    pause = 0.2  # seconds between two turns

    def __init__(self, page, sources, seed=1):
        super().__init__(daemon=True)
        self.address, self.random = (page.network.box_address, page.port), random.Random(seed)
        self.sources, self.over, self.turns = itertools.cycle(sources), threading.Event(), 0

    def run(self):
        while not self.over.wait(self.pause):
            with contextlib.suppress(OSError, http.client.HTTPException):  # a box that is being restarted, or has enough of it
                self.turn()
                self.turns += 1
        self.end()

    def stop(self):
        self.over.set()
        self.join(60)

    def connect(self):
        return socket.create_connection(self.address, 5, source_address=(next(self.sources), 0))

    def post(self, uri, body, token, kind="application/json"):
        """Returns the status of the answer."""
        connection = http.client.HTTPConnection(*self.address, timeout=10, source_address=(next(self.sources), 0))
        with contextlib.closing(connection):
            connection.request("POST", uri, body, {"Authorization": f"Bearer {token}", "Content-Type": kind})
            answer = connection.getresponse()
            answer.read()
            return answer.status

    def end(self):
        pass


class Holds(Hostile):
    """Opens sockets, writes `begin` to each and then a byte now and then, and reopens closed ones."""

    begin, sockets = b"", 32

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.held = []

    def turn(self):
        for connection in list(self.held):
            try:
                connection.send(b" ")
            except OSError:
                self.held.remove(connection)
                connection.close()
        while len(self.held) < self.sockets:
            connection = self.connect()
            connection.sendall(self.begin)
            self.held.append(connection)

    def end(self):
        for connection in self.held:
            connection.close()


class SlowHeads(Holds):
    begin = b"GET /api/status HTTP/1.1\r\nHost: box\r\nX: "


class SlowLogins(Holds):
    begin = (b"POST /adit/login HTTP/1.1\r\nHost: box\r\nContent-Type: application/json\r\nContent-Length: 4000\r\n\r\n{")


class Guesses(Hostile):
    """Sends wrong tokens, each after the answer to the one before."""

    pause = 0.02

    def turn(self):
        self.post("/state/update", b"{}", f"guess-{self.random.random()}")


class Hangs(Hostile):
    """Begins a map with a valid token and hangs up within it."""

    def turn(self):
        with self.connect() as connection:
            connection.sendall(f"POST /map/update HTTP/1.1\r\nHost: box\r\nAuthorization: Bearer {programs.TEAM_TOKEN}\r\n"
                               "Content-Type: application/json\r\nContent-Length: 5000000\r\n\r\n"
                               '{"type":"OccupancyGrid","msg":{"data":"'.encode() + b"A" * self.random.randrange(100_000))


class BadMessages(Hostile):
    """Sends the fuzzers' seeds with changed bytes and a cut end, with a valid token. None of them is valid."""

    pause = 0.05

    def turn(self):
        kind = self.random.choice(("json", "cbor"))
        body = bytearray(self.random.choice(sorted((SEEDS / kind).iterdir())).read_bytes())
        for _ in range(self.random.randrange(4)):
            body[self.random.randrange(len(body))] = self.random.randrange(256)
        del body[len(body) // 2 + self.random.randrange(len(body) // 4):]
        status = self.post(self.random.choice((*URIS, "/api/artifact_reports")), bytes(body), programs.TEAM_TOKEN,
                           f"application/{kind}")
        assert status >= 400, f"half a message was answered {status}"


KINDS = (SlowHeads, SlowLogins, Guesses, Hangs, BadMessages)
