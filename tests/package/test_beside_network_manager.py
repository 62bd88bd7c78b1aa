"""The package on a PC with NetworkManager, like a desktop with Debian or Ubuntu. The package takes the two ports from NetworkManager,
which still runs, also over its restarts. The third port stays with it."""


import pc
import programs
from stage import Story, load_tests  # unittest looks for them here
from test_package import NOW, setUpModule  # and for the latter, too

NETPLAN = "/run/systemd/network/10-netplan-port.network"


class ManagedPc(pc.Stage):
    """NetworkManager runs, and manages all three ports."""

    def prepare(self):
        self.box.start()
        self.box.shell("systemctl enable --now NetworkManager.service")
        for number, port in enumerate((*pc.PORTS.values(), pc.OFFICE)):
            address = pc.OFFICE_ADDRESS if port == pc.OFFICE else f"172.2{number + 1}.0.5"
            self.box.shell(f"""nmcli device set {port} managed yes
                nmcli connection add type ethernet con-name {port} ifname {port} ip4 {address}/24 ipv6.method disabled""")
            programs.wait_until(lambda port=port: self.managed(port) == "connected", f"{port} to be NetworkManager's", 60)

    def managed(self, port):
        """NetworkManager's state of a port, by its current name."""
        states = dict(line.split(":") for line in self.box.shell("nmcli -t -f DEVICE,STATE device").splitlines())
        return states.get(port, "not there")

    def addresses(self, port):
        return [word for line in self.box.shell(f"ip -o -4 address show dev {port}").splitlines() for word in line.split() if "/" in word]


class BesideNetworkManager(Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(ManagedPc())

    def is_adits_alone(self):
        programs.wait_until(self.box.answers, "the page to answer", 60)
        programs.wait_until(self.has_adits_addresses, "team0 to have Adit's addresses alone", 60)
        self.assertEqual(self.stage.addresses("darpa0"), [])
        for port in "team0", "darpa0":
            self.assertEqual(self.stage.managed(port), "unmanaged")
        self.assertEqual(self.stage.managed(pc.OFFICE), "connected")
        self.assertEqual(self.stage.addresses(pc.OFFICE), [f"{pc.OFFICE_ADDRESS}/24"])

    def has_adits_addresses(self):
        """The factory address, and later a link-local one."""
        return [address for address in self.stage.addresses("team0") if not address.startswith("169.254.")] == ["10.0.0.1/24"]

    def test_ports_are_taken_from_a_running_network_manager(self):
        # As netplan leaves it with networkd as its renderer: with the earlier name and a low number.
        self.box.shell(f"""mkdir -p $(dirname {NETPLAN})
            printf '[Match]\\nName={pc.PORTS["command_post"]}\\n[Network]\\nAddress=172.29.0.5/24\\nLinkLocalAddressing=ipv6\\n' >{NETPLAN}
            systemctl start systemd-networkd""")
        programs.wait_until(lambda: "172.29.0.5/24" in self.stage.addresses(pc.PORTS["command_post"]), "networkd to set the port up", 60)
        self.box.apt(f"install {NOW}", team=pc.PORTS["team"], command_post=pc.PORTS["command_post"])
        self.is_adits_alone()

    def test_restart_and_old_connections_do_not_return_the_ports(self):
        self.box.shell("systemctl restart NetworkManager")
        programs.wait_until(lambda: self.stage.managed(pc.OFFICE) == "connected", "NetworkManager to be there again", 60)
        self.assertNotEqual(self.box.run("nmcli", "-w", "5", "connection", "up", pc.PORTS["command_post"]).returncode, 0)
        self.is_adits_alone()

    def test_ports_are_named_again_after_a_restart(self):
        self.box.shell("systemctl restart adit-interfaces systemd-networkd")
        self.is_adits_alone()

    def test_purge_returns_the_ports_to_network_manager(self):
        self.box.apt("purge adit")
        for port in pc.PORTS.values():
            programs.wait_until(lambda port=port: self.stage.managed(port) not in ("unmanaged", "not there"), f"NetworkManager to have {port} again", 60)
        self.assertEqual(self.stage.managed(pc.OFFICE), "connected")
