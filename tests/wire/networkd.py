"""adit-network on the box, with a real systemd-networkd in the box's namespace or with a stand-in."""

import json
import os
import pathlib
import secrets
import subprocess
import unittest

import hosts
import programs

NETWORKD = "/lib/systemd/systemd-networkd"
STAND_IN = pathlib.Path(__file__).with_name("stand_in_networkctl")

# The files that adit-network.path watches.
ASKED = ("wanted.json", "word.json", "probe.json", "endpoints.json", "forget.json")

BUS = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig><type>system</type><listen>unix:path={path}</listen><policy context="default"><allow user="*"/><allow own="*"/>
<allow send_destination="*" eavesdrop="true"/><allow eavesdrop="true"/></policy></busconfig>
"""

# A read-only /sys tells networkd that it need not wait for udev.
START = """set -e
mount -o remount,bind,ro /sys
mkdir -p /run/systemd
mount -t tmpfs tmpfs /run/systemd
mkdir -p /run/systemd/network /run/systemd/netif/links /run/systemd/netif/leases /run/systemd/netif/lldp
chown -R systemd-network: /run/systemd/netif
mount --bind "$FOLDER/networkd" /run/systemd/network
mount -t tmpfs tmpfs /etc/systemd/network
exec "$NETWORKD"
"""


def needs_networkd():
    hosts.needs_other_users()
    for program in (NETWORKD, "/usr/bin/dbus-daemon", "/usr/bin/networkctl"):
        if not os.access(program, os.X_OK):
            raise unittest.SkipTest(f"a real networkd needs {program}")


class Networkd:
    """A real systemd-networkd in the box's namespace, which reads folder/networkd."""

    def __init__(self, network, folder):
        self.network = network
        self.bus = folder / "bus"
        (folder / "bus.conf").write_text(BUS.format(path=self.bus))
        self.dbus = subprocess.Popen(["dbus-daemon", "--nofork", "--nosyslog", "--nopidfile", "--print-address",
                                      f"--config-file={folder / 'bus.conf'}"], stdout=subprocess.PIPE,
                                     stderr=subprocess.DEVNULL)
        with self.dbus.stdout:  # its socket is there before it listens; it prints its address once it does
            assert self.dbus.stdout.readline(), "the bus did not start"
        self.environment = {**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={self.bus}", "FOLDER": str(folder),
                            "NETWORKD": NETWORKD, "SYSTEMD_LOG_TARGET": "console"}
        self.log = open(folder / "networkd.log", "wb")
        self._start()
        self.networkctl = folder / "networkctl"
        self.networkctl.write_text(
            f"#!/bin/sh\nDBUS_SYSTEM_BUS_ADDRESS=unix:path={self.bus} exec /usr/bin/networkctl \"$@\"\n")
        self.networkctl.chmod(0o755)
        try:
            programs.wait_until(self._answers, "networkd")
        except AssertionError:
            self.stop()
            raise unittest.SkipTest("a real networkd does not run here: " +
                                    (folder / "networkd.log").read_text()[-300:]) from None

    def _start(self):
        self.daemon = self.network.start(self.network.box, "unshare", "-m", "sh", "-c", START, env=self.environment,
                                         stderr=self.log, stdout=self.log)

    def _answers(self):
        return self.reload().returncode == 0

    def reload(self):
        """networkctl only works in networkd's own namespace."""
        return subprocess.run(["ip", "netns", "exec", self.network.box, self.networkctl, "reload"], capture_output=True,
                              check=False)

    def stop(self):
        for process in (self.daemon, self.dbus):
            process.kill()
            process.wait()
        self.log.close()


class AddressWatch(programs.Program):
    """adit-network --watch on the box, or on another host with two such interfaces. As in its unit, it does not run as root."""

    def __init__(self, network, folder, host=None):
        self.folder = folder
        folder.mkdir(exist_ok=True)
        super().__init__(network, host or network.box, folder / "log", [programs.BIN / "adit-network", "--watch", "--status", folder, "--told", folder])
        programs.wait_until((folder / "taken.json").exists, "adit-network --watch")

    def taken(self, what="taken"):
        """The conflicts as {("team0", "192.168.7.11"): mac}, or another member such as "exchanged"."""
        told = json.loads((self.folder / "taken.json").read_text())
        return {(each["interface"], each["address"]): each["mac"] for each in told[what]}


class AditNetwork:
    """Runs adit-network as its units do: once per request, one at a time."""

    def __init__(self, network, folder, networkctl=None):
        self.network, self.folder, self.wanted = network, folder, folder / "wanted"
        for name in ("wanted", "status", "state", "networkd"):
            (folder / name).mkdir(exist_ok=True)
        for each in (folder, folder / "networkd"):
            each.chmod(0o755)
        self.networkctl = networkctl or self.stand_in()
        self.process = None

    def stand_in(self):
        path = self.folder / "networkctl"
        path.write_text(f"#!/bin/sh\nexec {STAND_IN} {self.folder / 'networkd'} \"$@\"\n")
        path.chmod(0o755)
        return path

    def start(self, *more):
        words = [programs.BIN / "adit-network", "--networkctl", self.networkctl, *more]
        words += ["--wanted", self.wanted, "--factory", self.folder / "network.json"]
        for name in ("status", "state", "networkd"):
            words += [f"--{name}", self.folder / name]
        with open(self.folder / "adit-network.log", "ab") as log:
            self.process = self.network.start(self.network.box, *words, stdout=log, stderr=log)

    def run(self):
        """Starts it and waits for its end."""
        self.start()
        return self.process.wait(programs.patient(20))

    def ask(self, file, **members):
        """Writes a request with a rename, as aditd does. Returns its nonce."""
        nonce = secrets.token_hex(16)
        self.put(file, **{"nonce": nonce, **members})
        return nonce

    def put(self, file, **members):
        temporary = self.wanted / ".new"
        temporary.write_text(json.dumps({"format": 1, **members}))
        temporary.rename(self.wanted / file)

    def want(self, within_ms=60000, **numbers):
        nonce = self.ask("wanted.json", confirm_within_ms=min(programs.MOST_MS, round(programs.patient(within_ms))), numbers=self.numbers(**numbers))
        self.start()
        programs.wait_until(lambda: self.status() and (self.pending() or self.status()["last_nonce"] == nonce),
                            "the change to be taken up")
        return nonce

    @staticmethod
    def numbers(team="192.168.7.11", post="10.100.1.10", gateway="", prefix=24):
        addresses = [{"address": each, "prefix": 24} for each in ([post] if isinstance(post, str) else post)]
        return {"team": {"mode": "static", "address": team, "prefix": prefix},
                "command_post": {"addresses": addresses, "gateway": gateway}}

    def status(self):
        path = self.folder / "status" / "status.json"
        return json.loads(path.read_text()) if path.exists() else None

    def pending(self):
        status = self.status()
        return status and status["pending"]

    def output(self):
        return (self.folder / "adit-network.log").read_text()

    def addresses(self, interface):
        """The interface's IPv4 addresses without link-local ones: ["192.168.7.11/24"]."""
        shown = subprocess.run(["ip", "-n", self.network.box, "-4", "-j", "address", "show", "dev", interface],
                               capture_output=True, check=True)
        return [f"{each['local']}/{each['prefixlen']}" for link in json.loads(shown.stdout or "[]")
                for each in link.get("addr_info", []) if each["scope"] == "global"]

    def routes(self, table="230"):
        """The routes of a table as {"10.100.2.201": ("10.100.1.200", "darpa0")}; table 230 is the Command Post's."""
        shown = subprocess.run(["ip", "-n", self.network.box, "-4", "-j", "route", "show", "table", table], capture_output=True,
                               check=False)
        return {each["dst"]: (each.get("gateway"), each["dev"]) for each in json.loads(shown.stdout or "[]")}

    def stop(self):
        if self.process is not None and self.process.poll() is None:
            self.process.kill()
            self.process.wait()
