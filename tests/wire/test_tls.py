"""TLS at the team's port 443 by a real stunnel before aditd: clients, the end of connections, hostile clients, and the client's true
address."""

import contextlib
import json
import os
import re
import select
import signal
import socket
import ssl
import struct
import subprocess
import unittest

import requests

import hosts
import programs
import stunnel
from hostile import SEEDS
from programs import wait_until
from reporting import another, began, submit
from stunnel import SERVICES, SecureStage, closing_all

OTHERS = [f"192.168.7.{number}" for number in range(21, 25)]
BEARER = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
TOKEN = f"Authorization: Bearer {programs.TEAM_TOKEN}\r\n"
HALF_OPEN = 500  # twice the connections that stunnel serves
HELLO = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"  # the begin of a TLS handshake


def head(stage, path="/adit/run", headers=TOKEN, method="GET"):
    return f"{method} {path} HTTP/1.1\r\nHost: {stage.network.box_address}\r\n{headers}\r\n".encode()


def everything(connection):
    """All bytes until the other side ends."""
    with contextlib.suppress(ssl.SSLEOFError, ConnectionResetError):
        return b"".join(iter(lambda: connection.recv(65536), b""))
    return b""


class Tls(unittest.TestCase):
    def setUp(self):
        stunnel.needs_stunnel()

    def stage(self, **overrides):
        stage = began(self.enterContext(SecureStage(**overrides)))
        for address in OTHERS:
            hosts.ip("address", "add", f"{address}/24", "dev", "eth0")
        return stage

    def metric(self, stage, name):
        text = requests.get(stage.box.url + "/metrics", timeout=30, headers=BEARER).text
        return float(re.search(rf"^{re.escape(name)} (\S+)$", text, re.MULTILINE)[1])

    def no_connection_is_left(self, stage):
        """Besides that of the question itself."""
        wait_until(lambda: self.metric(stage, "adit_connections") == 1, "the end of the others")


class Clients(Tls):
    def test_usual_clients_report_and_read(self):
        stage = self.stage()
        url, trusted = stage.box.secure_url, str(stage.box.certificate)
        for number, version in enumerate((ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3), 1):
            stage.box.context.minimum_version = stage.box.context.maximum_version = version
            with stage.box.connect() as client:
                client.sendall(head(stage))
                self.assertTrue(client.recv(4096).startswith(b"HTTP/1.1 200"), version)
            curl = ["curl", "-sS", "--cacert", trusted, "--tls-max", f"1.{number + 1}", "-H", TOKEN.strip(), "-H", "Content-Type: application/json"]
            said = subprocess.run([*curl, "-w", "%{http_code}", "-d", json.dumps(another(number)), f"{url}/api/artifact_reports"],
                                  check=True, capture_output=True, text=True).stdout
            self.assertTrue(said.endswith("201"), said)
        with requests.Session() as session:
            session.headers.update(BEARER)
            options = {"timeout": 30, "verify": trusted}
            for number in range(3, 6):
                self.assertEqual(session.post(f"{url}/api/artifact_reports", json=another(number), **options).status_code, 201)
                self.assertEqual(session.get(f"{url}/api/status", **options).status_code, 200)
            self.assertEqual(session.get(f"{url}/icon.svg", **options).headers["Content-Type"], "image/svg+xml")
        self.assertEqual(len(stage.post.recorded()), 5)
        self.no_connection_is_left(stage)

    def test_older_tls_and_plain_http_are_rejected(self):
        stage = self.stage()
        for options, alert in ((["-tls1_1", "-cipher", "ALL@SECLEVEL=0"], "alert protocol version"),
                               (["-tls1_2", "-cipher", "ECDHE-ECDSA-AES256-SHA384"], "alert handshake failure")):  # CBC
            said = subprocess.run(["openssl", "s_client", "-connect", f"{stage.network.box_address}:443", *options],
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
            self.assertNotEqual(said.returncode, 0)
            self.assertIn(alert, said.stderr)
        with stage.box.connect_plain() as client:
            client.sendall(head(stage))
            self.assertNotIn(b"HTTP/1", everything(client))
        self.no_connection_is_left(stage)

    def test_connection_lives_through_a_key_update(self):
        stage = self.stage()
        first, last = (head(stage, "/icon.svg", headers) for headers in ("", "Connection: close\r\n"))
        command = ["openssl", "s_client", "-connect", f"{stage.network.box_address}:443", "-CAfile", stage.box.certificate, "-verify_return_error"]
        said = b""
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as client:
            # s_client sees its command K (KeyUpdate) only at the begin of what it reads at once, so each piece waits for the last one's answer.
            for piece, answer in ((first, b"HTTP/1.1 200 OK"), (b"K\n", b"KEYUPDATE"), (b"K\n", b"KEYUPDATE"), (last, b"HTTP/1.1 200 OK")):
                client.stdin.write(piece)
                client.stdin.flush()
                known = len(said)
                while answer not in said[known:]:
                    self.assertTrue(select.select([client.stdout], [], [], programs.patient(30))[0], said)
                    part = os.read(client.stdout.fileno(), 65536)
                    self.assertTrue(part, said)
                    said += part
            said += client.communicate(timeout=programs.patient(30))[0]
        self.assertIn(b"Verify return code: 0 (ok)", said)

    def test_heads_are_answered_as_over_http(self):
        """Whole requests, and those that the gate rejects."""
        stage = self.stage()
        statuses = []
        for seed in sorted((SEEDS / "heads").iterdir()):
            answers = []
            for client in (socket.create_connection((stage.network.box_address, stage.box.port), 30), stage.box.connect()):
                with client:
                    client.sendall(seed.read_bytes())
                    client.settimeout(programs.patient(30))
                    answers.append(client.recv(65536)[:12])
            self.assertEqual(*answers, seed.name)
            statuses.append(answers[0])
        self.assertIn(b"HTTP/1.1 400", statuses)

    def test_page_gets_events_also_from_the_next_process(self):
        stage = self.stage()

        def listens():
            client = stage.box.connect()
            client.sendall(head(stage, "/adit/events"))
            said = b""
            while b"\ndata:" not in said:
                piece = client.recv(65536)
                self.assertTrue(piece, said)
                said += piece
            return client

        page = listens()
        stage.box.manager.process.send_signal(signal.SIGTERM)
        stage.box.manager.process.wait(programs.STOPS_WITHIN)
        everything(page)
        page.close()
        waits = stage.box.connect()  # stunnel and the socket are there
        waits.sendall(head(stage, headers=TOKEN + "Connection: close\r\n"))
        stage.box.manager.ready(stage.box.manager.start(None))
        self.assertTrue(everything(waits).startswith(b"HTTP/1.1 200"))
        waits.close()
        listens().close()
        self.no_connection_is_left(stage)


class Ends(Tls):
    def test_client_that_ends_in_any_way_leaves_nothing(self):
        stage = self.stage()

        def close_notify(client):
            client.unwrap()

        def fin(client):
            socket.socket(fileno=client.detach()).close()

        def reset(client):
            plain = socket.socket(fileno=client.detach())
            plain.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            plain.close()

        for end in (close_notify, fin, reset):
            for sent in (b"", head(stage)[:20], head(stage, "/adit/events")):
                client = stage.box.connect(OTHERS[0])
                client.sendall(sent)
                if b"events" in sent:
                    client.recv(65536)
                with contextlib.suppress(OSError):  # events may come instead of the close_notify
                    end(client)
                client.close()
        self.no_connection_is_left(stage)

    def test_answer_comes_after_the_clients_close_notify(self):
        """A client that ends its direction may still read."""
        stage = self.stage()
        received, sent = ssl.MemoryBIO(), ssl.MemoryBIO()
        tls = stage.box.context.wrap_bio(received, sent, server_hostname=stage.network.box_address)
        with stage.box.connect_plain() as connection:

            def until_done(step):
                while True:
                    try:
                        return step()
                    except ssl.SSLWantReadError:
                        connection.sendall(sent.read())
                        received.write(connection.recv(65536))

            until_done(tls.do_handshake)
            tls.write(head(stage, "/icon.svg"))
            with self.assertRaises(ssl.SSLWantReadError):
                tls.unwrap()  # leaves the request and a close_notify to be sent at once
            self.assertTrue(until_done(lambda: tls.read(65536)).startswith(b"HTTP/1.1 200 OK"))

    def test_slow_clients_are_cut(self):
        stage = self.stage()
        with stage.box.connect(OTHERS[0]) as client:
            client.sendall(head(stage)[:20])
            self.assertIn(b"HTTP/1.1 408", everything(client))
        with stage.box.connect(OTHERS[0]) as client:
            client.sendall(head(stage, "/adit/openapi.json") * 80)  # more than all buffers on the way have room for
            wait_until(lambda: self.metric(stage, 'adit_connections_ended_total{why="slow"}') == 2, "the end of the reader")
        self.no_connection_is_left(stage)


class Addresses(Tls):
    def test_token_guard_and_log_have_the_clients_own(self):
        stage = self.stage()
        with closing_all() as held:
            for number in range(15):
                held.append(stage.box.connect(OTHERS[0]))
                held[-1].sendall(head(stage, "/api/status", f"Authorization: Bearer guess-{number}\r\nConnection: close\r\n"))
            self.assertIn(b"429", {everything(client)[9:12] for client in held}, "the guard counts the guesses of this address")
        with stage.box.connect(OTHERS[1]) as client:
            client.sendall(head(stage, "/api/status", "Authorization: Bearer guess\r\nConnection: close\r\n"))
            self.assertEqual(everything(client)[9:12], b"401")
        wait_until(lambda: f"most from {OTHERS[0]}" in stage.box.output(), "a line of the log")
        self.assertNotIn("127.0.0.1", re.sub("listening.*", "", stage.box.output()))

    def test_each_has_its_share(self):
        stage = self.stage(team__connections_per_address=4)
        with closing_all() as held:
            for _ in range(4):
                held.append(stage.box.connect(OTHERS[0]))
                held[-1].sendall(head(stage, "/map/update", TOKEN + "Content-Type: application/json\r\nContent-Length: 100000\r\n", "POST"))
            wait_until(lambda: self.metric(stage, "adit_connections") - self.metric(stage, "adit_connections_unauthenticated") > 4, "those")
            for source, status in ((OTHERS[0], b"503"), (OTHERS[1], b"200")):
                with stage.box.connect(source) as client:
                    client.sendall(head(stage, headers=TOKEN + "Connection: close\r\n"))
                    self.assertEqual(everything(client)[9:12], status)

    def test_firewall_lets_no_other_user_claim_one(self):
        hosts.needs_other_users()
        stage = self.stage()
        inside = ["ip", "netns", "exec", stage.network.box]
        subprocess.run([*inside, "nft", "-D", 'others="accept"', "-f", SERVICES / "adit-nftables.conf"], check=True)
        claim = ["/usr/bin/python3", "-c", "import socket; s = socket.create_connection(('127.0.0.1', 8443), 5);"
                 "s.sendall(b'PROXY TCP4 10.9.9.9 10.0.0.1 1 443\\r\\nGET /icon.svg HTTP/1.1\\r\\nHost: 10.0.0.1\\r\\n\\r\\n');"
                 "print(s.recv(99)[:12])"]
        as_nobody = ["setpriv", "--reuid=65534", "--clear-groups"]

        def said(*before):
            return subprocess.run([*inside, *before, *claim], capture_output=True, text=True, check=False)
        self.assertIn("TimeoutError", said(*as_nobody).stderr)
        self.assertEqual(said().stdout, "b'HTTP/1.1 200'\n")
        subprocess.run([*inside, "nft", "add", "element", "inet", "adit", "tls_users", "{ 65534 }"], check=True)
        self.assertEqual(said(*as_nobody).stdout, "b'HTTP/1.1 200'\n", "as adit-tls.service does for its user")


class Hostile(Tls):
    def test_half_open_handshakes_hold_up_no_report(self):
        stage = self.stage()
        with closing_all() as held:
            kept = stage.box.connect()
            held.append(kept)
            for _ in range(HALF_OPEN):
                with contextlib.suppress(OSError):
                    held.append(stage.box.connect_plain(OTHERS[0]))
                    held[-1].sendall(HELLO)
            self.assertEqual(submit(stage, another(1)).status_code, 201)
            body = json.dumps(another(2)).encode()
            kept.sendall(head(stage, "/api/artifact_reports",
                              f"{TOKEN}Content-Type: application/json\r\nContent-Length: {len(body)}\r\n", "POST") + body)
            self.assertTrue(kept.recv(4096).startswith(b"HTTP/1.1 201"))
            self.assertLessEqual(self.metric(stage, "adit_connections"), 3, "aditd sees no handshake")
            wait_until(lambda: self.is_answered(stage), "the end of the handshakes", within=20)

    def is_answered(self, stage):
        with contextlib.suppress(OSError), stage.box.connect(timeout=5) as client:
            client.sendall(head(stage))
            return client.recv(4096).startswith(b"HTTP/1.1 200")
        return False

    def test_broken_records_end_only_their_connection(self):
        stage = self.stage()
        kept = self.enterContext(stage.box.connect())
        for sent in (b"", b"\0" * 5000, HELLO + b"\xff" * 600, b"\x16\x03\x01\xff\xff" + b"x" * 20000, b"\x15\x03\x03\x00\x02\x02\x28",
                     b"\x80\x2e\x01\x00\x02", b"PROXY TCP4 10.9.9.9 10.0.0.1 1 443\r\n"):
            with stage.box.connect_plain(OTHERS[0]) as client:
                client.sendall(sent)
                with contextlib.suppress(OSError):  # it may have ended already
                    client.shutdown(socket.SHUT_WR)
                everything(client)
        client = stage.box.connect(OTHERS[0])
        with socket.socket(fileno=client.detach()) as plain:  # past its TLS
            plain.settimeout(programs.patient(30))
            plain.sendall(b"\x17\x03\x03\x00\x20" + b"x" * 32)
            everything(plain)
        with stage.box.connect(OTHERS[0]) as client:
            client.sendall(b"PROXY TCP4 10.9.9.9 10.0.0.1 1 443\r\n" + head(stage))
            self.assertTrue(everything(client).startswith(b"HTTP/1.1 400"), "a client cannot claim another address")
        kept.sendall(head(stage))
        self.assertTrue(kept.recv(4096).startswith(b"HTTP/1.1 200"))


if __name__ == "__main__":
    unittest.main()
