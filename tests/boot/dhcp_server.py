"""A DHCP server like a base station's: busybox's udhcpd from the image's root."""

import container
import programs

LEASE = 10  # seconds: its client asks again after half of it

CONFIGURATION = """interface eth0
start {address}
end {address}
max_leases 1
min_lease {lease}
lease_file {folder}/leases
pidfile {folder}/pid
option subnet 255.255.255.0
option router {own}
option dns {own}
option ntpsrv {own}
option lease {lease}
"""


class Server:
    """On `eth0` of the team's host: offers `address` for LEASE, and a router, a name server and a clock that the box must ignore."""

    def __init__(self, network, folder, address):
        self.network, self.folder = network, folder / f"udhcpd-{address}"
        self.folder.mkdir()
        (self.folder / "leases").touch()
        configuration = self.folder / "udhcpd.conf"
        configuration.write_text(CONFIGURATION.format(address=address, folder=self.folder, own=network.team_address, lease=LEASE))
        self.log = self.folder / "log"
        busybox = container.TREE / "usr/bin/busybox"
        with open(self.log, "wb") as said:
            self.process = network.start(network.team, busybox, "udhcpd", "-f", configuration, stdout=said, stderr=said)
        programs.wait_until(lambda: "started" in self.said(), "udhcpd")

    def said(self):
        return self.log.read_text(errors="replace")

    def given(self):
        """How often it granted or renewed the lease."""
        return self.said().count("sending ACK")

    def stop(self):
        self.process.kill()
        self.process.wait()
