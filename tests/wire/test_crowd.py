"""Unauthenticated clients that hold sockets, and stations with more connections than allowed. Clients with a token are still served,
and rejected connections get the reason."""

import contextlib
import itertools
import re
import socket
import threading
import unittest

import requests

import hosts
import programs
from programs import Stage, wait_until
from reporting import REPORT, began, submit

ADDRESSES = [f"192.168.7.{number}" for number in range(21, 25)]
SOCKETS = 64
TOKEN = f"Authorization: Bearer {programs.TEAM_TOKEN}\r\n"


def begun(box, source, path, length, headers=""):
    """A connection in the middle of a POST of that many bytes."""
    connection = socket.create_connection((box.network.box_address, box.port), 30, source_address=(source, 0))
    connection.sendall(f"POST {path} HTTP/1.1\r\nHost: {box.network.box_address}\r\nContent-Type: application/json\r\n{headers}"
                       f"Content-Length: {length}\r\n\r\n{{".encode())
    return connection


class Strangers(threading.Thread):
    """64 sockets from four addresses, each in a log-in that gets a byte now and then. Closed ones are reopened."""

    def __init__(self, box):
        super().__init__(daemon=True)
        self.box, self.over, self.opened = box, threading.Event(), 0

    def run(self):
        held = []
        sources = itertools.cycle(ADDRESSES)
        while not self.over.wait(0.2):
            still = []
            for connection in held:
                try:
                    connection.send(b" ")
                    still.append(connection)
                except OSError:
                    connection.close()
            held = still
            with contextlib.suppress(OSError):
                while len(held) < SOCKETS:
                    held.append(begun(self.box, next(sources), "/adit/login", 4000))
                    self.opened += 1
        for connection in held:
            connection.close()

    def stop(self):
        self.over.set()
        self.join(30)


class Crowd(unittest.TestCase):
    def stage(self, **overrides):
        stage = began(self.enterContext(Stage(**overrides)))
        for address in ADDRESSES:
            hosts.ip("address", "add", f"{address}/24", "dev", "eth0")
        return stage

    def metric(self, stage, name):
        text = requests.get(stage.box.url + "/metrics", timeout=30, headers={"Authorization": TOKEN.partition(" ")[2].strip()}).text
        return float(re.search(rf"^{re.escape(name)} (\S+)$", text, re.MULTILINE)[1])

    def test_reports_are_answered_while_unauthenticated_clients_hold_sockets(self):
        stage = self.stage()
        strangers = Strangers(stage.box)
        strangers.start()
        self.addCleanup(strangers.stop)
        wait_until(lambda: strangers.opened >= 2 * SOCKETS, "the strangers to come again")
        kept = requests.Session()
        for number in range(1, 6):
            self.assertEqual(submit(stage, {**REPORT, "x": 100.0 * number}).status_code, 201)
            answer = kept.get(stage.box.url + "/api/status", timeout=30, headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"})
            self.assertEqual(answer.status_code, 200)
        self.assertEqual(len(stage.post.recorded()), 5)
        self.assertGreaterEqual(self.metric(stage, 'adit_connections_ended_total{why="gave_way"}'), SOCKETS)
        self.assertEqual(self.metric(stage, 'adit_connections_ended_total{why="no_room"}'), 0)
        self.assertIn("unauthenticated", [alarm["id"] for alarm in stage.box.ask("GET /adit/run")[1]["alarms"]])
        wait_until(lambda: "too many unauthenticated connections" in stage.box.output(), "a line of the log")
        self.assertLessEqual(stage.box.output().count("too many unauthenticated connections"), 2, "one a minute")

    def test_address_with_too_many_requests_is_told_so(self):
        stage = self.stage(team__connections_per_address=4)
        busy = [self.enterContext(begun(stage.box, ADDRESSES[0], "/map/update", 100_000, TOKEN)) for _ in range(4)]
        wait_until(lambda: self.metric(stage, "adit_connections") - self.metric(stage, "adit_connections_unauthenticated") > 4,
                   "those and who asks")
        with begun(stage.box, ADDRESSES[0], "/state/update", 1000, TOKEN) as more:
            told = more.makefile("rb").read().decode()
        self.assertRegex(told, r"^HTTP/1.1 503 ")
        self.assertIn("Retry-After: 1\r\n", told)
        self.assertIn('"too many requests at once', told)
        self.assertEqual(stage.box.ask("GET /api/status")[0], 200, "others are served")
        self.assertIn("clients_refused", stage.box.alarms())
        self.assertEqual(self.metric(stage, 'adit_connections_ended_total{why="no_room"}'), 1)
        self.assertEqual(len(busy), 4)
