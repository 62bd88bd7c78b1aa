"""Many processes compete with the box for its processor, each with as much weight as Adit: no process is killed, no light is wrong,
no report is lost or recorded twice. Delays depend on this machine, so only long_stories runs it."""

import os
import pathlib
import subprocess
import threading
import time
import unittest

import container
import hosts
import programs
from contained import Contained
from insisting import Client, Operator, end, judge
from stage import load_tests, note  # unittest looks for them here

BUSY = int(os.environ.get("ADIT_BUSY", "12"))  # for each core
LASTS = float(os.environ.get("ADIT_LASTS", "60"))  # seconds
UNITS = ("adit", "adit-panel", "adit-network-watch", "systemd-networkd")
# Allowed alarms: a starved box is behind with maps.
MAY_BE = ("map_behind", "maps_behind", "queue_growing")


def setUpModule():
    hosts.needs_root()
    if container.missing():
        raise unittest.SkipTest(container.missing())


def ahead(pid):
    """Gives the other hosts priority, because in the field they are separate machines."""
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        os.setpriority(os.PRIO_PROCESS, int(task.name), max(os.getpriority(os.PRIO_PROCESS, int(task.name)) - 15, -20))


class Looks(threading.Thread):
    """Watches lights and alarms all the time."""

    def __init__(self, box):
        super().__init__(daemon=True)
        self.box, self.over = box, threading.Event()
        self.lights = pathlib.Path(f"/proc/{box.leader()}/root/run/adit-panel/lights")
        self.looks, self.faults, self.told, self.alarms, self.slowest, self.looked_at = 0, 0, set(), {}, 0.0, 0.0
        self.start()

    def run(self):
        dark = 0
        while not self.over.wait(0.1):
            lit = {line.split()[0] for line in self.lights.read_text().splitlines() if line.endswith(" on")}
            self.looks += 1
            # In every other state one of these is lit for a part of each second.
            dark = 0 if lit & {"scoring", "mapping", "attention"} else dark + 1
            self.faults = max(self.faults, dark)
            if time.monotonic() >= self.looked_at + 1:
                self.look()

    def look(self):
        began = self.looked_at = time.monotonic()
        view = self.box.ask("GET /adit/run")[1]
        self.told |= {f"{light['name']} {light['pattern']}" for light in view["lights"]}
        for alarm in view["alarms"]:
            self.alarms[alarm["id"].partition(":")[0]] = f"{alarm['what']}: {alarm['why']}"
        self.slowest = max(self.slowest, time.monotonic() - began)

    def stop(self):
        self.over.set()
        self.join(60)


class Overloaded(Contained):
    def test_it_is_set_up(self):
        self.box.start()
        self.set_up()
        self.wait_for_lights()
        for pid in os.getpid(), self.stage.post.process.pid:
            ahead(pid)

    def ends(self):
        """The number of restarts of each unit."""
        return {unit: self.shell(f"systemctl show -p NRestarts --value {unit}").strip() for unit in UNITS}

    def explores(self):
        robots = self.stage.network.start(
            self.stage.network.team, programs.BIN / "adit-robots", "--post", self.box.url, "--secrets", self.stage.folder / "secrets",
            "--robots", "4", "--quiet", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(robots.kill)
        return robots

    def crowd(self):
        count = BUSY * os.cpu_count()
        self.shell(f"systemd-run -q --unit=crowd sh -c 'for i in $(seq {count}); do while :; do :; done & done; wait'")
        self.addCleanup(self.box.run, "systemctl", "kill", "-s", "KILL", "crowd")
        return count

    def test_no_process_ends_and_no_light_is_wrong(self):
        before, robots = self.ends(), self.explores()
        programs.wait_until(lambda: len(self.box.ask("GET /adit/run")[1]["activities"]) >= 8, "all robots to be heard", 60)
        count, operator = self.crowd(), Operator(self.stage)
        looks = Looks(self.box)
        clients = [Client(self.stage, number, 5.0, pause=0.5) for number in range(1, 4)]
        for client in clients:
            client.start()
        time.sleep(LASTS)
        looks.stop()
        end(clients)
        robots.terminate()
        robots.wait(30)
        self.shell("systemctl kill -s KILL crowd")
        programs.wait_until(operator.sees_all_at_rest, "all to come to rest", 180)
        self.assertEqual(self.ends(), before, "nothing is ended by who watches it")
        self.assertEqual([client.odd for client in clients], [[]] * len(clients), "what no client should be told")
        posted = [each for client in clients for each in client.posted]
        recorded, waiting = judge(self, self.stage, operator, posted)
        note(f"{count} busy processes beside the box for {LASTS:.0f} s",
             f"{len(posted)} reports posted, {recorded.total()} recorded, 0 doubled, {waiting} wait; the page answered within "
             f"{looks.slowest:.1f} s; lights: {', '.join(sorted(looks.told))}, and all dark but health in at most {looks.faults} of {looks.looks} looks one after "
             f"the other; alarms: "
             f"{'; '.join(looks.alarms.values()) or 'none'}")
        self.assertEqual(set(looks.alarms) - set(MAY_BE), set(), looks.alarms)
        self.assertLess(looks.faults, 15, "the lights say that it hangs")
