"""aditd gets its sockets from systemd, which keeps the others, so no connecting client is lost during a restart. The tests play
systemd (activation.py). On loopback."""

import collections
import contextlib
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import tempfile
import threading
import time
import unittest

import activation
import hosts
import programs
from activation import TOKEN, listening
from ports import free_port

CODE, PASSWORD = "31415926", "correct horse battery"
NOBODY = {"address": "127.0.0.1", "port": 9}  # discard: nobody listens there


def settings(*listen):
    return {"version": 1, "command_post": {"scoring": NOBODY, "mapping": NOBODY},
            "team": {"connections": 256, "connections_per_address": 256,
                     "listen": [{"address": address, "port": port} for address, port in listen]}}


def ask(port, method="GET", path="/adit/run", body=None, address="127.0.0.1"):
    connection = http.client.HTTPConnection(address, port, timeout=60)
    try:
        headers = {**TOKEN, "Content-Type": "application/json"} if body is not None else TOKEN
        connection.request(method, path, None if body is None else json.dumps(body), headers)
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


PROMPT = 0.5  # seconds: who is so slow to ask, on a busy machine, may find the service stopped


class Clients(threading.Thread):
    """Opens a connection every 5 ms in its own thread, and records each outcome."""

    EVERY = 0.005

    def __init__(self, port):
        super().__init__()
        self.port, self.ended = port, False
        self.answered, self.refused, self.cut, self.troubles = 0, 0, 0, []
        self.lock, self.visits = threading.Lock(), []

    def run(self):
        due = time.monotonic()
        while not self.ended:
            visit = threading.Thread(target=self.visit)
            visit.start()
            self.visits.append(visit)
            due += self.EVERY
            time.sleep(max(0.0, due - time.monotonic()))

    def visit(self):
        began = time.monotonic()
        for _ in range(2):  # as any client of HTTP, again where a connection ends without an answer
            try:
                status, _ = ask(self.port, path="/icon.svg")
            except ConnectionRefusedError:
                with self.lock:
                    self.refused += 1
                return
            except (ConnectionError, http.client.BadStatusLine):
                with self.lock:
                    self.cut += time.monotonic() - began < PROMPT
                continue
            except OSError as trouble:
                with self.lock:
                    self.troubles.append(repr(trouble))
                return
            with self.lock:
                self.answered += status == 200
            return

    def go_on(self):
        """Waits until more connections were answered, and all earlier ones. No client is cut off twice, by one end and by the next."""
        before, came = self.answered, len(self.visits)
        programs.wait_until(lambda: self.answered > before + 50 and not any(each.is_alive() for each in self.visits[:came]),
                            "more clients to be answered")

    def stop(self):
        self.ended = True
        self.join()
        for visit in self.visits:
            visit.join()


class Sockets(unittest.TestCase):
    def manager(self, *doors):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-sockets-")))
        programs.secrets_folder(folder / "secrets")
        manager = activation.ServiceManager(folder, doors)
        self.addCleanup(manager.close)
        return manager

    def started(self, document, *doors):
        manager = self.manager(*doors)
        manager.ready(manager.start(document))
        return manager

    def restart(self, manager, number, document=None):
        manager.process.send_signal(number)
        manager.process.wait(programs.patient(30))
        manager.ready(manager.start(document))

    def is_refused(self, port):
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", port), 2).close()

    def test_serves_socket_units_instead_of_its_own(self):
        door = listening()
        port = door.getsockname()[1]
        manager = self.started(settings(("127.0.0.1", port)), door)
        self.assertEqual(ask(port)[0], 200)
        self.assertEqual(manager.log().count("listening "), 1)
        self.assertEqual(manager.store, [], "systemd has it already")

    def test_serves_socket_units_that_the_settings_do_not_name(self):
        door, own = listening(), free_port()
        self.started(settings(("127.0.0.1", own)), door)
        for port in (door.getsockname()[1], own):
            self.assertEqual(ask(port)[0], 200)

    def test_stores_its_sockets_in_systemd_and_restores_them(self):
        port = free_port()
        manager = self.started(settings(("127.0.0.1", port), ("127.0.0.1", 0)))
        programs.wait_until(lambda: len(manager.store) == 2, "two sockets to keep")
        names = [name for name, _ in manager.store]
        self.assertEqual(names, [f"listen--127.0.0.1-{port}", "listen--127.0.0.1-0"])
        drawn = manager.store[1][1].getsockname()[1]
        for number in (signal.SIGTERM, signal.SIGKILL):
            self.restart(manager, number)
            self.assertEqual([ask(port)[0], ask(drawn)[0]], [200, 200])
            self.assertEqual([name for name, _ in manager.store], names, "it gave none twice")

    def test_closes_sockets_that_the_settings_no_longer_name(self):
        gone, stays = free_port(), free_port()
        manager = self.started(settings(("127.0.0.1", gone), ("127.0.0.1", stays)))
        programs.wait_until(lambda: len(manager.store) == 2, "two sockets to keep")
        self.restart(manager, signal.SIGTERM, settings(("127.0.0.1", stays)))
        programs.wait_until(lambda: len(manager.store) == 1, "one to be let go of")
        self.is_refused(gone)
        self.assertEqual(ask(stays)[0], 200)
        # Every address instead of one, at the same port: the old socket is in the way, and systemd has a copy.
        self.restart(manager, signal.SIGTERM, settings(("0.0.0.0", stays)))
        self.assertEqual(ask(stays, address="127.0.0.2")[0], 200)
        programs.wait_until(lambda: [name for name, _ in manager.store] == [f"listen--0.0.0.0-{stays}"], "the other one")

    def test_missing_address_is_awaited_if_another_socket_listens(self):
        door = listening()
        document = settings(("127.0.0.1", door.getsockname()[1]), ("192.0.2.1", free_port()))
        self.started(document, door)
        self.assertEqual(ask(door.getsockname()[1])[0], 200)
        manager = self.manager()
        manager.start(settings(("127.0.0.1", 0), ("192.0.2.1", free_port())))
        self.assertEqual(manager.process.wait(programs.patient(30)), 1)
        self.assertIn("Cannot assign requested address", manager.log())

    def test_stored_descriptor_that_is_no_socket_is_closed(self):
        manager = self.manager()
        manager.store.append(("listen--127.0.0.1-0", socket.socket(socket.AF_INET, socket.SOCK_DGRAM)))
        manager.ready(manager.start(settings(("127.0.0.1", 0))))
        self.assertIn("unusable socket", manager.log())
        programs.wait_until(lambda: [s.type for _, s in manager.store] == [socket.SOCK_STREAM], "a better one")

    def test_restart_rejects_no_client(self):
        """At 200 connections per second. A kill also cuts the connections that were already accepted."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            door = listening()
            manager = self.started(settings(("127.0.0.1", door.getsockname()[1])), door)
            clients = Clients(door.getsockname()[1])
            clients.start()
            clients.go_on()
            manager.process.send_signal(number)
            manager.process.wait(programs.patient(30))
            came = len(clients.visits)
            programs.wait_until(lambda: len(clients.visits) > came + 10, "some to come while it is away")  # noqa: B023
            manager.ready(manager.start(None))
            clients.go_on()
            clients.stop()
            print(f"{number.name}: {clients.answered} answered, {clients.cut} cut")
            self.assertEqual((clients.refused, clients.troubles), (0, []))
            self.assertEqual(clients.answered, len(clients.visits))
            if number == signal.SIGTERM:
                self.assertEqual(clients.cut, 0)


    def resettable(self):
        """A manager of an aditd that can be reset, and the ports of its door and of its own socket."""
        door = listening()
        manager = self.manager(door)
        code = manager.folder / "secrets/label.code"
        code.write_text(CODE)
        code.chmod(0o600)
        own = free_port()
        manager.ready(manager.start(settings(("127.0.0.1", own)), WATCHDOG_USEC="10000000"))
        return manager, door.getsockname()[1], own

    def reset(self, port):
        for path, body in (("password", {"role": "operator", "code": CODE, "password": PASSWORD}),
                           ("reset", {"password": PASSWORD})):
            self.assertEqual(ask(port, "POST", f"/adit/{path}", body)[0], 200)

    def test_reset_restarts_the_process_and_rejects_no_client(self):
        manager, port, own = self.resettable()
        process = pathlib.Path(f"/proc/{manager.process.pid}")

        def descriptors():
            """Sockets, other kernel objects, and deleted files, because a file of the state may open late."""
            found = []
            for each in (process / "fd").iterdir():
                with contextlib.suppress(FileNotFoundError):  # closed since
                    found.append(re.sub(r"\d+", "", os.readlink(each)))
            return collections.Counter(each for each in found if ":[" in each or "(deleted)" in each)
        before, command = descriptors(), (process / "cmdline").read_bytes()
        clients = [Clients(port), Clients(own)]
        for each in clients:
            each.start()
        for _ in range(3):
            begun = len(manager.said)
            self.reset(port)
            manager.ready(begun)
            said = [line for _, line in manager.said[begun:]]
            self.assertLess(said.index("WATCHDOG_USEC=60000000"), said.index("READY=1"))
            for each in clients:
                each.go_on()
        for each in clients:
            each.stop()
            self.assertEqual((each.refused, each.cut, each.troubles), (0, 0, []))
        self.assertIsNone(manager.process.poll())
        self.assertEqual(((process / "comm").read_text(), (process / "cmdline").read_bytes()), ("aditd\n", command))
        programs.wait_until(lambda: descriptors() <= before, f"no descriptor besides {before}")
        self.assertFalse(manager.heard("STOPPING=1"))
        self.assertEqual([name for name, _ in manager.store], [f"listen--127.0.0.1-{own}"], "systemd keeps the same one")

class TeamPort(unittest.TestCase):
    """team0 disappears and comes back as another interface, like an adapter that is unplugged and plugged in."""

    def setUp(self):
        self.network = self.enterContext(hosts.Network())
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-port-")))
        programs.secrets_folder(folder / "secrets")
        inside = ["ip", "netns", "exec", self.network.box]
        self.manager = activation.ServiceManager(folder, inside=inside)
        self.addCleanup(self.manager.close)

    def door(self):
        hosts.enter(f"/run/netns/{self.network.box}")
        try:
            opened = socket.socket()
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, b"team0")
            opened.bind(("0.0.0.0", 80))
            opened.listen(1024)
            return opened
        finally:
            hosts.enter(f"/run/netns/{self.network.team}")

    def settings(self):
        document = settings((self.network.box_address, 8000))
        document["team"]["interface"] = "team0"
        return document

    def is_answered(self, port):
        try:
            return ask(port, address=self.network.box_address)[0] == 200
        except OSError:
            return False

    def replug(self):
        hosts.ip("-n", self.network.box, "link", "delete", "team0")
        time.sleep(1.5)
        self.assertIsNone(self.manager.process.poll(), "it goes on while the port is away")
        # It sees the port only once that has its address. Without the address and without systemd's sockets it ends,
        # and systemd restarts it.
        self.manager.process.send_signal(signal.SIGSTOP)
        self.network.plug_team()
        self.manager.process.send_signal(signal.SIGCONT)

    def test_is_listened_at_again(self):
        self.manager.ready(self.manager.start(self.settings()))
        self.assertTrue(self.is_answered(8000))
        self.replug()
        programs.wait_until(lambda: self.is_answered(8000), "an answer at the new port")
        self.assertIsNone(self.manager.process.poll())

    def test_ends_aditd_if_only_systemd_can_listen_there(self):
        self.manager.doors.append(self.door())
        self.manager.ready(self.manager.start(self.settings()))
        self.assertTrue(self.is_answered(80) and self.is_answered(8000))
        self.replug()
        self.assertEqual(self.manager.process.wait(programs.patient(30)), 0)
        self.manager.doors.append(self.door())  # as systemd restarts adit.socket; what it has of the old one is deaf
        self.manager.ready(self.manager.start(None))
        self.assertTrue(self.is_answered(80) and self.is_answered(8000))
        self.assertIn("its interface is gone", self.manager.log())
