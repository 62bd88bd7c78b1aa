"""A PC with Debian 12 in a container (systemd-nspawn): two Ethernet ports for Adit, and a third port for other use."""

import os
import pathlib
import re

import container
import hosts
import programs

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
BUILT = SOURCE / "build" / "package"
PORTS = {"team": "enp1s0", "command_post": "enp2s0"}
OFFICE, OFFICE_ADDRESS = "enp3s0", "172.20.0.5"


class Cables(hosts.Network):
    """The three hosts of the wire tests. The ports have a PC's names, and the third is also connected to the team's host."""

    def __init__(self):
        super().__init__("10.0.0")
        self.box_address = "10.0.0.1"

    def _make(self):
        super()._make()
        for old, new in (("team0", PORTS["team"]), ("darpa0", PORTS["command_post"])):
            hosts.ip("-n", self.box, "address", "flush", "dev", old)
            hosts.ip("-n", self.box, "link", "set", old, "down")
            hosts.ip("-n", self.box, "link", "set", old, "name", new)
        self._cable(self.team, "eth1", ["172.20.0.1"], self.box, OFFICE, [])


class Pc(container.Nspawn):
    ports = (*PORTS.values(), OFFICE)

    def __init__(self, network, folder):
        super().__init__(network, folder, BUILT / "root")
        self.options = (f"--bind-ro={BUILT}:/packages",)

    def is_started(self):
        if self.leader() is None:
            return False
        return self.run("systemctl", "is-system-running").stdout.strip() in ("running", "degraded")

    def shell(self, script, good=True):
        """Its output on both streams."""
        done = self.run("bash", "-euo", "pipefail", "-c", f"exec 2>&1\n{script}")
        if good and done.returncode != 0:
            raise AssertionError(f"{script}: {done.returncode}\n{done.stdout}{self.said_last()}")
        return done.stdout

    def apt(self, words, good=True, **answers):
        """Installs packages as an operator who has answered their questions before: apt("install /x.deb", team="eth0")."""
        for name, answer in answers.items():
            kind = "boolean" if answer in ("true", "false") else "string"
            self.shell(f"echo 'adit adit/{name.replace('_', '-')} {kind} {answer}' | debconf-set-selections")
        return self.shell(f"DEBIAN_FRONTEND=noninteractive apt-get -y {words}", good)

    def made_inside(self, make):
        """The result of `make()` in its network namespace, such as a socket."""
        return self.network.made_in(f"../../proc/{self.leader()}/ns/net", make)

    def is_active(self, unit):
        return self.run("systemctl", "is-active", unit).stdout.strip() == "active"

    def version(self):
        return self.shell("dpkg-query -W -f '${Version}' adit")

    def listens(self):
        """(address, interface, port) of each listening TCP socket."""
        lines = self.shell("ss -Hltn").splitlines()
        return sorted(re.fullmatch(r"(.*?)(?:%(.*))?:(\d+)", line.split()[3]).groups(default="") for line in lines)


class Stage(container.Stage):
    """The PC, its third port in use, and a Command Post."""

    cables, contained = Cables, Pc

    def prepare(self):
        self.box.start()
        self.box.shell(f"ip link set {OFFICE} up; ip address add {OFFICE_ADDRESS}/24 dev {OFFICE}")
        programs.wait_until(lambda: "tentative" not in self.office(), "the third port's addresses")
        self.office_before = self.office()

    def office(self):
        return self.box.shell(f"ip -o address show dev {OFFICE}; ip -o link show dev {OFFICE}; sysctl -a -r 'conf.{OFFICE}'")
