"""Alarms of who connects to the box."""

import contextlib
import socket

import hosts
import programs
from alarming import WithAlarms
from programs import wait_until

CROWD, STRANGERS = "192.168.7.21", "192.168.7.22"
MANY = 40  # connections
TOKEN = f"Authorization: Bearer {programs.TEAM_TOKEN}\r\n"


class Clients(WithAlarms):
    # Of a crowd it is told for a minute after the last one: so all three are made together.
    def test_clients_are_refused_wrong_tokens_shown_and_too_many_strangers_connected(self):
        stage = self.stage(team__connections_per_address=MANY)
        for address in (CROWD, STRANGERS):
            hosts.ip("address", "add", f"{address}/24", "dev", "eth0")
        self.assertEqual(stage.box.ask("GET /api/status", token="an-old-token")[0], 401)
        with contextlib.ExitStack() as held:
            for _ in range(MANY):
                held.enter_context(self.begun(stage, CROWD, "/map/update", TOKEN))
            wait_until(lambda: self.is_refused(stage), "one more to be refused")
            for _ in range(MANY):
                held.enter_context(self.begun(stage, STRANGERS, "/adit/login", ""))
            wait_until(lambda: self.alarm(stage, "strangers"), "strangers")
        self.sees(stage, "clients_refused", "bad", "robot", "Clients are refused", f"most of {CROWD}")
        self.sees(stage, "wrong_tokens", "ask", "robot", "Wrong tokens are shown", stage.network.team_address)
        self.sees(stage, "strangers", "wait", "robot", "Too many strangers are connected", STRANGERS)
        for name in ("clients_refused", "wrong_tokens", "strangers"):
            self.goes(stage, name, 90)

    def is_refused(self, stage):
        with self.begun(stage, CROWD, "/state/update", TOKEN) as more:
            more.settimeout(2)
            with contextlib.suppress(TimeoutError):
                return more.recv(100).startswith(b"HTTP/1.1 503")
        return False

    @staticmethod
    def begun(stage, address, path, headers):
        connection = socket.create_connection((stage.network.box_address, programs.PORT), 30, source_address=(address, 0))
        connection.sendall(f"POST {path} HTTP/1.1\r\nHost: {stage.network.box_address}\r\nContent-Type: application/json\r\n{headers}"
                           "Content-Length: 1000\r\n\r\n{".encode())
        return connection

    def test_an_unknown_robot_posts(self):
        stage = self.stage(robots=[{"name": "r1"}])
        self.robot(stage, "r9")
        self.sees(stage, "robot_unknown:r9", "ask", "robot", "Robot r9 is unknown", "set-up has r1")
        stage.box.save(lambda settings: settings["robots"].append({"name": "r9"}))
        self.goes(stage, "robot_unknown:r9")
