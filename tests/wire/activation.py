"""Plays systemd for aditd: passes listening sockets, receives notifications, and stores file descriptors."""

import array
import contextlib
import fcntl
import json
import os
import pathlib
import socket
import subprocess
import threading
import time

import programs

TOKEN = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
# exec keeps the shell's process number, so LISTEN_PID is right (sd_listen_fds(3)).
HAND_OVER = 'export LISTEN_PID=$$; exec "$@" {moves}'
FIRST_HIGH = 100  # where descriptors wait for the shell to move them down


def listening():
    opened = socket.socket()
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    opened.bind(("127.0.0.1", 0))
    opened.listen(1024)
    return opened


def start_with(command, given, log, inside=(), **environment):
    """Starts a program with (name, socket) pairs as from systemd. `inside`: a command prefix that runs it in its network namespace."""
    high = [fcntl.fcntl(each.fileno(), fcntl.F_DUPFD, FIRST_HIGH) for _, each in given]
    moves = " ".join(f"{3 + at}<&{fd} {fd}<&-" for at, fd in enumerate(high))
    names = {"LISTEN_FDS": str(len(given)), "LISTEN_FDNAMES": ":".join(name for name, _ in given)} if given else {}
    with open(log, "ab") as output:
        process = subprocess.Popen([*inside, "bash", "-c", HAND_OVER.format(moves=moves), "-", *command], pass_fds=high,
                                   stdout=output, stderr=output, env={**os.environ, **names, **environment})
    for fd in high:
        os.close(fd)
    return process


class ServiceManager:
    """systemd's part for one service with a socket unit."""

    def __init__(self, folder, doors=(), inside=(), tls=()):
        """`doors`: the socket unit's sockets; `tls`: those of adit-tls-plain.socket. `inside`: of start_with()."""
        self.folder, self.doors, self.inside, self.tls = folder, list(doors), list(inside), list(tls)
        self.store = []  # (name, socket), as FDSTORE=1 has it
        self.said = []  # every assignment of every notification, with the time
        self.process = None
        self.notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.notify.bind(str(folder / "notify"))
        self.ended = False
        self.hearing = threading.Thread(target=self._hear)
        self.hearing.start()

    def close(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.ended = True
        with contextlib.closing(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)) as waker:
            waker.sendto(b"", str(self.folder / "notify"))
        self.hearing.join()
        self.notify.close()
        for each in self.doors + self.tls + [kept for _, kept in self.store]:
            each.close()

    def _hear(self):
        while not self.ended:
            text, ancillary, _, _ = self.notify.recvmsg(4096, socket.CMSG_SPACE(16 * 4))
            given = array.array("i")
            for _, kind, data in ancillary:
                if kind == socket.SCM_RIGHTS:
                    given.frombytes(data[:len(data) - len(data) % given.itemsize])
            lines = text.decode().split("\n")
            values = dict(line.split("=", 1) for line in lines if "=" in line)
            sockets = [socket.socket(fileno=fd) for fd in given]
            if values.get("FDSTORE") == "1":
                self.store += [(values["FDNAME"], each) for each in sockets]
            elif values.get("FDSTOREREMOVE") == "1":
                for name, kept in [pair for pair in self.store if pair[0] == values["FDNAME"]]:
                    kept.close()
                self.store = [pair for pair in self.store if pair[0] != values["FDNAME"]]
            self.said += [(time.monotonic(), line) for line in lines]

    def start(self, settings, **environment):
        """`settings`: a new document, or None to keep the old one."""
        if settings is not None:
            (self.folder / "settings.json").write_text(json.dumps(settings))
        given = [("team", door) for door in self.doors] + [("tls", each) for each in self.tls] + self.store
        begun = len(self.said)
        command = [programs.BIN / "aditd", "--settings", self.folder / "settings.json", "--secrets",
                   self.folder / "secrets", "--state", self.folder / "state"]
        self.process = start_with(command, given, self.folder / "aditd.log", self.inside,
                                  NOTIFY_SOCKET=str(self.folder / "notify"), **environment)
        return begun

    def ready(self, begun):
        programs.wait_until(lambda: self.heard("READY=1", begun) or self.process.poll() is not None, "READY=1")
        if self.process.poll() is not None:
            raise AssertionError("aditd ended:\n" + self.log())

    def heard(self, line, begun=0):
        return any(said == line for _, said in self.said[begun:])

    def log(self):
        return pathlib.Path(self.folder / "aditd.log").read_text()
