"""Robots, a way and a Command Post, each in its own network namespace, with 100 Mbit/s to the Command Post."""

import dataclasses
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from ages_ways import LISTEN, MAPPING, SCORING, TOKEN

HERE = os.path.dirname(os.path.abspath(__file__))
RATE = 100e6 / 8  # bytes a second
CONTROL = ("10.91.3.2", 9002)  # on a cable of its own, on which no map goes


@dataclasses.dataclass
class Figures:
    """Figures of one load on one way. Ages are in seconds, of the robot that fares worst of those that were served."""
    served: str      # robots and kinds of which anything arrived, of all
    p50: float
    p99: float
    behind: float    # by how much the newest posted is newer than the newest that arrived, at the end
    maps: float      # taken a second
    link: float      # share of it that was used
    posted: int
    refused: int     # to the robots
    throttled: int   # answers of 429 by the Command Post
    share: float     # of the cells and points that were posted, of the robot that fares worst of all


def sh(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


class Stage:
    def __init__(self, programs):
        self.programs = programs
        self.tag = f"ages{os.getpid()}"
        self.folder = tempfile.mkdtemp(prefix="adit-ages.", dir="/dev/shm")
        self.running = []

    def __enter__(self):
        os.mkdir(f"{self.folder}/secrets", 0o700)
        for name in ("scoring", "mapping", "team"):
            with open(os.open(f"{self.folder}/secrets/{name}.token", os.O_CREAT | os.O_WRONLY, 0o600), "w") as file:
                file.write(TOKEN)
        for space in ("team", "gate", "post"):
            sh("ip", "netns", "add", self.space(space))
            sh("ip", "-n", self.space(space), "link", "set", "lo", "up")
            self.fill_queues(space)
        self.cable("team", "gate", 1)
        self.cable("gate", "post", 2)
        self.cable("team", "post", 3)
        sh("tc", "-n", self.space("gate"), "qdisc", "add", "dev", "c2", "root", "tbf", "rate", "100mbit",
           "burst", "32kb", "latency", "50ms")
        return self

    def __exit__(self, *_):
        self.stop()
        for space in ("team", "gate", "post"):
            subprocess.run(["ip", "netns", "del", self.space(space)], check=False)
        shutil.rmtree(self.folder)

    def fill_queues(self, space):
        """Uses loss-based congestion control (cubic) like Debian's, whatever this machine uses."""
        for name in ("cubic", "reno"):
            if subprocess.run(["ip", "netns", "exec", self.space(space), "sysctl", "-q",
                               f"net.ipv4.tcp_congestion_control={name}"], stderr=subprocess.DEVNULL,
                              check=False).returncode == 0:
                return
        raise RuntimeError("neither cubic nor reno is to be had")

    def space(self, name):
        return f"{self.tag}-{name}"

    def cable(self, left, right, number):
        sh("ip", "link", "add", f"c{number}", "netns", self.space(left), "type", "veth", "peer", "name", f"c{number}",
           "netns", self.space(right))
        for side, last in ((left, 1), (right, 2)):
            sh("ip", "-n", self.space(side), "addr", "add", f"10.91.{number}.{last}/24", "dev", f"c{number}")
            sh("ip", "-n", self.space(side), "link", "set", f"c{number}", "up")

    def start(self, space, command, log):
        with open(f"{self.folder}/{log}.log", "w", encoding="utf-8") as file:
            program = subprocess.Popen(["ip", "netns", "exec", self.space(space), *command], stdout=file, stderr=file)
        self.running.append(program)
        return program

    def stop(self):
        for program in reversed(self.running):
            program.terminate()
            try:
                program.wait(10)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        self.running.clear()

    def ask(self, space, where, path=None):
        """Whether a program listens there; with a path, the JSON there."""
        code = f"import socket; socket.create_connection({where!r}, 1).close()" if path is None else (
            f"import urllib.request as u; print(u.urlopen('http://%s:%d{path}' % {where!r}).read().decode())")
        asked = subprocess.run(["ip", "netns", "exec", self.space(space), "python3", "-c", code], capture_output=True,
                               text=True, check=False)
        if path is None:
            return asked.returncode == 0
        return json.loads(asked.stdout)

    def wait_for(self, space, where, log):
        for _ in range(100):
            if self.ask(space, where):
                return
            time.sleep(0.1)
        with open(f"{self.folder}/{log}.log", encoding="utf-8") as file:
            raise RuntimeError(f"{log} did not start: {file.read()}")

    def sent(self):
        """Bytes, including the heads of all segments."""
        shown = json.loads(subprocess.run(["tc", "-n", self.space("gate"), "-j", "-s", "qdisc", "show", "dev", "c2"],
                                          capture_output=True, check=True).stdout)
        return shown[0]["bytes"]

    def play(self, way, robots, seconds, before=lambda: None, meanwhile=time.sleep, post=(), beside=None):
        """`before` is called right before the robots begin, `meanwhile` with the seconds for which they post. `post`: more options of
        the Command Post. `beside`: posts of ages_worst.py, which are not in the figures."""
        place = tempfile.mkdtemp(dir=self.folder)
        rehearsal = [f"{self.programs}/adit-rehearsal", "--secrets", f"{self.folder}/secrets", *post]
        unused = f"{SCORING[0]}:0"
        # A separate program for each endpoint, so that checking maps delays no report.
        self.start("post", [*rehearsal, "--scoring", "%s:%d" % SCORING, "--mapping", unused], "scoring")
        self.start("post", ["nice", "-n", "10", *rehearsal, "--scoring", unused, "--mapping", "%s:%d" % MAPPING,
                            "--control", "%s:%d" % CONTROL], "post")
        self.wait_for("post", SCORING, "scoring")
        self.wait_for("team", CONTROL, "post")
        self.start("gate", way.command(place), "way")
        self.wait_for("team", LISTEN, "way")
        before()
        at_first, began = self.sent(), time.monotonic()
        # In the field they and the Command Post have their own machines. Here they get the processor time that the
        # way leaves.
        team = self.start("team", ["nice", "-n", "15", f"{self.programs}/adit-robots", "--post", "http://%s:%d" % LISTEN,
                                   "--control", "http://%s:%d" % CONTROL, "--secrets", f"{self.folder}/secrets",
                                   "--for", str(seconds), "--quiet", *robots], "team")
        worst = beside and self.start("team", ["nice", "-n", "15", sys.executable, f"{HERE}/ages_worst.py", beside, *map(str, LISTEN),
                                               TOKEN], beside)
        meanwhile(seconds)
        if worst and worst.poll() is not None:
            with open(f"{self.folder}/{beside}.log", encoding="utf-8") as file:
                raise RuntimeError(f"{beside}: {file.read()}")
        sent, took = self.sent() - at_first, time.monotonic() - began
        team.wait()
        record = self.ask("team", CONTROL, "/record")
        self.stop()
        shutil.rmtree(place)
        return self.figures(record, sent, took)

    def figures(self, record, sent, took):
        with open(f"{self.folder}/team.log", encoding="utf-8") as file:
            said = re.findall(r"^(?:grid|cloud) +(\d+) +\d+ +(\d+)", file.read(), re.MULTILINE)
        status = {row["status"]: row["count"] for row in record["requests"] if row["uri"] == "/map/update"}
        rows = [row for row in record["maps"] if row["posted"]]
        served = [row for row in rows if row["maps"]]
        worst = {name: max((row[name] for row in served), default=0) for name in ("p50", "p99", "behind")}
        return Figures(**worst, served=f"{len(served)} of {len(rows)}",
                       maps=status.get(200, 0) / took, link=sent / took / RATE,
                       posted=sum(int(posted) for posted, _ in said), refused=sum(int(refused) for _, refused in said),
                       throttled=status.get(429, 0), share=min((row["share"] for row in rows), default=0))
