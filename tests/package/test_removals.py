"""The package removed and installed again on a busy PC. Each time both ports get their names back, and no unit of Adit
starts again. ADIT_REMOVALS sets how often (3)."""

import os

import pc
import programs
from stage import Story, load_tests  # unittest looks for them here
from test_package import NOW, setUpModule  # and for the latter, too

REMOVALS = int(os.environ.get("ADIT_REMOVALS", "3"))
BUSY = 6  # processes
UNITS = "adit.service adit.socket adit-tls.socket adit-tls-plain.socket adit-panel.service adit-panel.socket adit-interfaces adit-network.path adit-ports.path adit-certificate.path adit-network-watch"


class BusyPc(pc.Stage):
    def prepare(self):
        super().prepare()
        for _ in range(BUSY):
            self.box.shell("systemd-run --quiet sh -c 'while :; do :; done'")


class Removals(Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(BusyPc())

    def left(self):
        """What a removal left behind, or ""."""
        names = set(self.box.shell("ls /sys/class/net").split())
        files = self.box.shell("ls /run/adit-removal /run/NetworkManager/conf.d/90-adit.conf 2>/dev/null || true").split()
        active = self.box.shell(f"systemctl is-active {UNITS} || true").split()
        rules = self.box.shell("nft list ruleset")
        wrong = [*sorted(set(pc.PORTS.values()) - names), *sorted(names & {"team0", "darpa0"}), *files, *(each for each in active if each not in ("inactive", "failed", "unknown"))]
        return " ".join([*wrong, "rules" if rules else ""]).strip()

    def test_each_removal_returns_both_ports(self):
        failed = []
        self.box.apt(f"install {NOW}", team=pc.PORTS["team"], command_post=pc.PORTS["command_post"])
        for number in range(REMOVALS):
            programs.wait_until(self.box.answers, "the page to answer", 60)
            said = self.box.shell("dpkg --remove adit; sleep 2")
            if left := self.left():
                failed.append(f"{number}: {left}\n{said}")
            self.box.shell(f"DEBIAN_FRONTEND=noninteractive dpkg --install {NOW}")
        self.assertEqual(failed, [], f"of {REMOVALS}: {len(failed)}\n" + "\n".join(failed))
