"""The Debian packages on a PC with other uses: installed, given its two ports, set up, upgraded during use, not downgraded, removed
and purged, as a user does it; and the rehearsal from its package."""

import concurrent.futures
import contextlib
import socket
import subprocess
import unittest

import hosts
import neighbour
import pc
import programs
import stage
from reporting import REPORT, another, insist, submit
from stage import Story, load_tests  # unittest looks for them here

CAP_NET_RAW = 13  # capabilities(7)
PASSWORD = "correct horse battery"
STATE, INTERFACES = "/var/lib/private/adit", "/etc/adit/interfaces"
OFFICE_KEEPER = "the keeper of the office"
FOREIGN, ADDED = 11311, 9000  # ports of another program of the PC, and of Adit by its settings
NOW, BEFORE = "/packages/now/adit_*.deb", "/packages/before/adit_*.deb"


def setUpModule():
    hosts.needs_root()
    for folder in ("root", "now", "before"):
        if not (pc.BUILT / folder).is_dir():
            raise unittest.SkipTest("tests/package/debian_root has made nothing here")


class Packages(Story):
    session = {}

    @classmethod
    def setUpClass(cls):
        cls.tell(pc.Stage())

    def asked(self, request, body=None):
        headers = {**self.session, "Content-Type": "application/json"}
        status, said = self.box.insist(request, headers, body, token=None)
        self.assertEqual(status, 200, said)
        return said

    def the_ports_are_the_machines(self, said=""):
        names = set(self.box.shell("ls /sys/class/net").split())
        self.assertTrue(names.issuperset(pc.PORTS.values()) and names.isdisjoint(("team0", "darpa0")), f"{names} {said}")
        for port in pc.PORTS.values():
            self.assertEqual(self.box.shell(f"ip -4 -o address show dev {port}"), "")
            self.assertIn("MULTICAST", self.box.shell(f"ip -o link show dev {port}"))

    def test_without_interfaces_it_does_nothing(self):
        said = self.box.apt(f"install {BEFORE}")
        self.assertIn("Adit does not start before /etc/adit/interfaces names its two interfaces", said)
        for unit in ("adit.service", "adit.socket", "adit-network-start", "adit-network-watch", "adit-nftables", "systemd-networkd"):
            self.assertFalse(self.box.is_active(unit), unit)
        self.assertEqual(self.box.listens(), [])
        self.assertEqual(self.box.shell("nft list ruleset"), "")
        for port in pc.PORTS.values():
            self.assertIn(port, self.box.shell("ip -o link"))

    def test_unusable_interfaces_are_reported(self):
        for team, command_post, why in ((pc.PORTS["team"], pc.PORTS["team"], "command_post: is the same interface as team"),
                                        (pc.PORTS["team"], "enp9s0", "command_post: there is no interface enp9s0 yet"),
                                        ("a/b", "enp2s0", "team: expected the name of an interface or its MAC address, got 'a/b'")):
            self.box.shell(f"printf 'team={team}\\ncommand_post={command_post}\\n' >/etc/adit/interfaces")
            self.assertIn(why, self.box.shell("/usr/lib/adit/interfaces check", good=False))
        for name in pc.PORTS["team"], "eth0":
            self.box.shell(f"""printf 'team={pc.PORTS["team"]}\ncommand_post={pc.PORTS["command_post"]}\n' >/etc/adit/interfaces
                mkdir -p /etc/network; printf 'auto lo {name}\niface {name} inet dhcp\n' >/etc/network/interfaces""")
            said = self.box.shell("/usr/lib/adit/interfaces check", good=name == "eth0")
            self.assertEqual("team: /etc/network/interfaces also configures enp1s0; remove it there" in said, name != "eth0", said)
        self.box.shell("rm -r /etc/network")

    def test_invalid_file_takes_no_interface_and_opens_no_port(self):
        for command_post in pc.PORTS["team"], "enp9s0":  # which is the other one, and which is not there
            self.box.shell(f"""printf 'team=enp8s0\ncommand_post={command_post}\nteem=x\n' >{INTERFACES}
                systemctl start adit-interfaces || systemctl start adit.socket adit-nftables || true""")
            self.assertEqual(self.box.listens(), [])
            self.the_ports_are_the_machines()
        self.box.shell(f"""rm {INTERFACES}; systemctl stop adit.socket adit.service adit-nftables; systemctl reset-failed
            /usr/lib/adit/interfaces free""")
        self.assertEqual(self.box.shell("nft list ruleset"), "")

    def test_documents_are_installed(self):
        self.box.shell("""cd /usr/share/doc/adit; grep -q '<title>Adit: the card' card.html
            grep -q 'class Client' examples/client.py; test -s examples/README.md -a -s examples/refusals.md -a -s examples/client.hpp
            zgrep -q 'adit-rehearsal demo' README.Debian*
            zgrep -qF '/usr/share/doc/adit/NEWS.md.gz' changelog.gz; zgrep -q '^## ' NEWS.md.gz""")
        self.assertEqual(self.box.shell("cd /usr/share/doc/adit; zgrep -hE '\\]\\([^()]*/' NEWS.md.gz examples/*.md || true"), "", "leads nowhere")

    def test_with_two_interfaces_it_serves_the_page_on_the_team_side(self):
        self.box.shell(f"""echo 'adit adit/team string {pc.PORTS["team"]}' | debconf-set-selections
            echo 'adit adit/command-post string {pc.PORTS["command_post"]}' | debconf-set-selections
            DEBIAN_FRONTEND=noninteractive dpkg-reconfigure adit""")
        programs.wait_until(self.box.answers, "the page to answer", 60)
        self.assertEqual({(interface, port) for _, interface, port in self.box.listens()}, {("lo", "8443"), ("team0", "443"), ("team0", "80"), ("team0", "8000")})
        self.assertIn("team0", self.box.shell(f"ip -o link show dev {pc.PORTS['team']}"), "its name from before is good, too")
        self.assertEqual(self.box.shell("systemctl --failed --plain --no-legend --no-pager"), "")

    def test_third_interface_is_unchanged(self):
        self.assertEqual(self.stage.office(), self.stage.office_before)
        self.assertIn("refused", self.box.shell("(exec 3<>/dev/tcp/172.20.0.1/9) || true"))  # so it was heard there

    def test_naming_no_interface_returns_both(self):
        """As in a dialog. Without a dialog, the file has the answers."""
        none = r"""sed -i 's|^\(adit/[a-z-]*=\).*|\1""|'"""
        self.box.shell(f'DEBIAN_FRONTEND=editor VISUAL="{none}" EDITOR="{none}" dpkg-reconfigure adit </dev/null'.replace('""', r'\"\"'))
        self.assertEqual(self.box.listens(), [])
        self.assertEqual(self.box.shell("nft list ruleset"), "")
        self.the_ports_are_the_machines()
        self.box.shell(f"""test ! -e {INTERFACES}
            printf 'team={pc.PORTS["team"]}\ncommand_post={pc.PORTS["command_post"]}\n' >{INTERFACES}
            DEBIAN_FRONTEND=noninteractive dpkg-reconfigure adit""")
        programs.wait_until(self.box.answers, "the page to answer", 60)

    def test_it_is_set_up_over_the_api(self):
        self.asked("POST /adit/password", {"role": "operator", "code": self.box.code(), "password": PASSWORD})
        type(self).session = programs.log_in(self.box, PASSWORD)
        for name, token in (("scoring", programs.SCORING_TOKEN), ("mapping", programs.MAPPING_TOKEN), ("team", programs.TEAM_TOKEN)):
            self.asked("POST /adit/tokens", {"name": name, "token": token})
        self.asked("POST /adit/network", stage.NUMBERS)
        session = {**self.session, "Content-Type": "application/json"}
        programs.wait_until(lambda: self.box.ask("POST /adit/network/confirm", session, None, token=None)[0] == 200,
                            "the addresses to be confirmed", 60)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        self.assertEqual(submit(self.stage).status_code, 201)

    def test_page_is_served_over_tls_with_minimal_rights(self):
        """With the certificate that adit-certificate has made, and then with a new one. aditd's port for stunnel is closed to other users, who
        could claim any address."""
        first = programs.wait_until(lambda: self.box.ask("GET /adit/run")[1]["certificate"], "a certificate", 60)
        self.assertEqual(self.box.shell(f"stat -c %a {STATE}/tls.pem").strip(), "600")
        served = ["ip", "netns", "exec", self.stage.network.team, "sh", "-c",
                  f"openssl s_client -connect {self.stage.network.box_address}:443 </dev/null 2>&1 | openssl x509 -noout -fingerprint -sha256"]
        is_served = lambda wanted: wanted in subprocess.run(served, capture_output=True, check=False, text=True).stdout
        programs.wait_until(lambda: is_served(first), "the certificate to be served", 60)
        self.assertTrue(self.box.answers_over_tls())
        pid = self.box.shell("systemctl show -p MainPID --value adit-tls.service").strip()
        rights = dict(line.split(":\t", 1) for line in self.box.shell(f"cat /proc/{pid}/status").splitlines() if ":\t" in line)
        self.assertEqual({rights[name] for name in ("CapEff", "CapPrm", "CapBnd")}, {f"{0:016x}"})
        self.assertEqual(rights["Uid"].split()[0], self.box.shell("id -u adit-tls").strip())
        for user, words in ("adit-tls", "connected"), ("nobody", "not"):
            tried = f"timeout 3 setpriv --reuid {user} --clear-groups bash -c 'exec 3<>/dev/tcp/127.0.0.1/8443' && echo connected || echo not"
            self.assertEqual(self.box.shell(tried).strip(), words, user)
        second = self.asked("POST /adit/certificate/new", {})["fingerprint"]
        self.assertNotEqual(second, first)
        programs.wait_until(lambda: is_served(second), "the new certificate to be served", 60)

    def test_the_card_is_followed_to_its_end(self):
        """As a user at the machine: the Test, robots of the team, an alarm and its end."""
        said = self.box.shell("adit test")
        for words in "the scoring token is accepted", "the mapping token is accepted", "scoring 10.100.1.200:8000", "mapping 10.100.1.201:8000":
            self.assertIn(words, said)
        robots = self.stage.network.start(self.stage.network.team, programs.BIN / "adit-robots", "--post", self.box.url,
                                          "--secrets", self.stage.folder / "secrets", "--for", "5", "--quiet", stdout=subprocess.DEVNULL)
        self.assertEqual(robots.wait(120), 0)
        programs.wait_until(lambda: self.stage.post.requests("/map/update"), "a map to arrive", 60)
        self.assertRegex(self.box.shell("adit status", good=False), r"Reports .*\d+ answered")
        self.stage.network.pull_cable()
        programs.wait_until(lambda: "Command Post cable is unplugged" in self.box.shell("adit status", good=False), "the alarm", 60)
        self.assertEqual(self.box.run("adit", "status").returncode, 1)
        self.stage.network.pull_cable(False)
        programs.wait_until(lambda: "cable is unplugged" not in self.box.shell("adit status", good=False), "the alarm to go", 60)

    def test_address_conflict_is_reported_with_minimal_rights(self):
        pid = self.box.shell("systemctl show -p MainPID --value adit-network-watch.service").strip()
        rights = dict(line.split(":\t", 1) for line in self.box.shell(f"cat /proc/{pid}/status").splitlines() if ":\t" in line)
        self.assertEqual({rights[name] for name in ("CapEff", "CapPrm", "CapBnd")}, {f"{1 << CAP_NET_RAW:016x}"})
        self.assertNotIn("0", rights["Uid"].split())
        with neighbour.Neighbour(self.stage.network, self.stage.network.team, "team0") as other:
            other.take(self.stage.network.box_address)
            programs.wait_until(lambda: f"{other.mac} also uses" in self.box.shell("adit status", good=False), "the alarm", 60)
            self.assertEqual(self.box.run("adit", "status").returncode, 1)
            other.leave()
            programs.wait_until(lambda: "address is taken" not in self.box.shell("adit status", good=False), "the alarm to go", 60)

    def reaches(self, host, address, port, within=0.02):
        with contextlib.suppress(OSError):
            self.stage.network.connect(host, address, port, within).close()
            return True
        return False

    def entered(self, change, *at):
        """How often reaches(*at) during `change`, and how often it tried."""
        entered = tried = 0
        while not change.done():
            tried += 1
            entered += self.reaches(*at)
        return entered, tried

    def team_reaches(self, port):
        return self.reaches(self.stage.network.team, self.stage.network.box_address, port, 1)

    def has_foreign_program(self, port):
        """A program of the PC that listens on all addresses, as the third port shows. Closed at the end of the test."""
        server = self.box.made_inside(lambda: socket.create_server(("0.0.0.0", port), backlog=1000))
        self.addCleanup(server.close)
        self.stage.network.connect(self.stage.network.team, pc.OFFICE_ADDRESS, port, 5).close()
        return server

    def listens_at(self, *ports):
        held = self.asked("GET /adit/settings")
        held["settings"]["team"]["listen"] = [{"address": "0.0.0.0", "port": port} for port in ports]
        self.asked("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})

    def change_ports(self):
        """Adds ports by the settings and by systemd, and starts all again."""
        self.listens_at(8000, ADDED)
        programs.wait_until(lambda: self.team_reaches(ADDED), "the added port to be open", 60)
        self.box.shell("systemctl restart adit-nftables")
        self.assertTrue(self.team_reaches(ADDED))
        folder = "/run/systemd/system/adit.socket.d"
        for port in ADDED + 1, None:
            self.box.shell(f"mkdir -p {folder}; printf '[Socket]\nListenStream={port}\n' >{folder}/port.conf" if port else f"rm -r {folder}")
            self.box.shell("systemctl daemon-reload; systemctl stop adit; systemctl restart adit.socket; systemctl start adit")
            for each in 80, 8000, ADDED, *([port] if port else []):
                programs.wait_until(lambda each=each: self.team_reaches(each), f"port {each} to be open", 60)

    def test_only_adits_ports_are_open_on_the_team_side(self):
        self.has_foreign_program(FOREIGN)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            change = pool.submit(self.change_ports)
            entered = pool.submit(self.entered, change, self.stage.network.team, self.stage.network.box_address, FOREIGN)
            change.result()
        self.assertEqual(entered.result()[0], 0, "of the tries to reach another program from the team's side")
        self.assertGreater(entered.result()[1], 100)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)

    def test_removed_port_is_closed(self):
        self.listens_at(8000)
        programs.wait_until(lambda: not self.team_reaches(ADDED), "Adit to leave the port", 60)
        foreign = self.has_foreign_program(ADDED)
        programs.wait_until(lambda: not self.team_reaches(ADDED), "the port to be closed", 60)
        self.assertTrue(self.team_reaches(80))
        foreign.close()
        self.listens_at(8000, ADDED)
        programs.wait_until(lambda: self.team_reaches(ADDED), "the added port to be open", 60)

    def test_network_services_cannot_reach_systemd(self):
        """From copies of the units, and from a copy without a sandbox, which succeeds."""
        self.box.shell("""cd /run/systemd/system; printf '[Service]\nType=oneshot\nExecStart=true\n' >adit-tried.service
            echo 'systemctl start adit-tried.service && exit 1; curl -sm 5 --unix-socket /run/systemd/private http://x; [ $? = 7 ]' >/run/adit-try.sh""")
        for unit, keeps in (("adit-nftables", False), ("adit-network", True), ("adit-network-start", True), ("adit-nftables", True)):
            sandbox = "/^Exec/d" if keeps else r"/^\[Service/,/^\[Install/d"
            self.box.shell(f"""cd /run/systemd/system; sed '{sandbox}; /^Restart/d' /lib/systemd/system/{unit}.service >adit-try.service
                printf '[Service]\nType=oneshot\nExecStart=sh /run/adit-try.sh\n' >>adit-try.service; systemctl daemon-reload
                [ $(systemctl start adit-try.service; echo $?) = {int(not keeps)} ] || {{ journalctl -u adit-try | tail; exit 1; }}""")
        self.box.shell("rm /run/systemd/system/adit-tried.service /run/systemd/system/adit-try.service; systemctl daemon-reload; systemctl reset-failed")

    def test_upgrade_rejects_no_client_opens_no_port_and_keeps_all(self):
        """Reports are posted all the time, and repeated if their connection was open when the older aditd ended. Each is recorded
        once."""
        self.box.shell(f"sed -i '1i # asked {OFFICE_KEEPER}' {INTERFACES}")
        named = self.box.shell(f"cat {INTERFACES}")
        self.has_foreign_program(22)
        self.has_foreign_program(FOREIGN)
        network = self.stage.network
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            upgrade = pool.submit(self.box.apt, f"install {NOW}")
            entered = {side: pool.submit(self.entered, upgrade, *at) for side, at in (
                ("Command Post", (network.post, hosts.BOX_DARPA, 22)), ("team", (network.team, network.box_address, FOREIGN)))}
            posted = []
            while not upgrade.done():
                posted.append(another(len(posted) + 1))
                self.assertIn(insist(self.stage, posted[-1], 30).status_code, (201, 503, 504))
            upgrade.result()
        self.assertNotEqual(self.box.version(), "0.0.9")
        for side, tries in entered.items():
            self.assertEqual(tries.result()[0], 0, f"of the tries to reach another program from the side of the {side}")
            self.assertGreater(tries.result()[1], 100)
        self.assertTrue(self.team_reaches(ADDED))
        self.assertEqual(self.box.shell(f"cat {INTERFACES}"), named, "as somebody wrote it")
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        for report in posted:
            programs.wait_until(lambda report=report: submit(self.stage, report).status_code == 201, "its answer", 60)
            self.assertEqual(len(self.stage.post.recorded(report)), 1)
        self.assertEqual(len(self.stage.post.recorded(REPORT)), 1)

    def test_unloadable_rules_keep_the_old_ones_and_leave_a_notice(self):
        rules, notice, servers = "/usr/share/adit/nftables.conf", "/run/adit-notices/firewall", "nft list set inet adit ntp_servers"
        self.box.shell(f"""nft add element inet adit ntp_servers '{{ 10.0.0.77 }}'; nft list ruleset >/root/loaded
            mv {rules} /root/; echo 'table inet adit {{' >{rules}; ! systemctl restart adit-nftables
            nft list ruleset | diff /root/loaded -; grep -q 'could not be loaded' {notice}""")
        self.box.shell(f"""mv /root/nftables.conf {rules}; systemctl restart adit-nftables
            nft list ruleset | diff /root/loaded -; test ! -e {notice}; {servers} | grep 10.0.0.77
            systemctl stop adit-nftables; nft list ruleset | diff /root/loaded -; systemctl start adit-nftables""")

    def test_ports_that_could_not_be_opened_leave_a_notice(self):
        notice = "/run/adit-notices/ports"
        self.box.shell(f"""nft list ruleset | sort >/root/loaded; nft flush table inet adit; nft delete set inet adit team_ports
            systemctl restart adit-ports; grep -q 'did not open the ports' {notice}
            systemctl restart adit-nftables adit-ports; nft list ruleset | sort | diff /root/loaded -; test ! -e {notice}""")

    def test_interrupted_upgrade_is_completed(self):
        self.box.shell(f"dpkg --unpack {NOW}")
        self.assertTrue(self.box.answers(), "meanwhile the one that runs goes on")
        self.box.shell("DEBIAN_FRONTEND=noninteractive dpkg --configure -a")
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        self.assertEqual(self.box.shell("dpkg --audit"), "")

    def test_deleted_file_is_not_created_again(self):
        self.box.shell(f"mv {INTERFACES} /root/")
        said = self.box.apt(f"install --reinstall {NOW}")
        self.assertIn("Adit does not start before /etc/adit/interfaces names its two interfaces", said)
        self.box.shell(f"test ! -e {INTERFACES}; mv /root/interfaces {INTERFACES}; DEBIAN_FRONTEND=noninteractive dpkg-reconfigure adit")
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)

    def test_older_version_is_rejected(self):
        version = self.box.version()
        said = self.box.apt(f"--allow-downgrades install {BEFORE}", good=False)
        self.assertIn(f"adit 0.0.9 is older than {version}, which is installed", said)
        self.assertEqual(self.box.version(), version)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)

    def test_the_rehearsal_is_shown_by_its_package(self):
        self.box.apt("install /packages/now/adit-rehearsal_*.deb")
        said = self.box.shell("cd /tmp && setpriv --reuid 1000 --clear-groups adit-rehearsal demo --for 8 --directory /tmp/demo")
        self.assertIn("The page:     http://127.0.0.1:", said)
        self.assertIn("What the Command Post accepted:", said)
        said = self.box.shell("mkdir /tmp/mine && adit-rehearsal demo --directory /tmp/mine", good=False)
        self.assertIn("/tmp/mine is there, and not a demo's", said)
        self.box.apt("purge adit-rehearsal")

    def test_removal_keeps_the_state_and_stops_everything(self):
        said = self.box.apt("remove adit")
        for unit in ("adit.service", "adit.socket", "adit-tls.service", "adit-network-start", "adit-network-watch", "adit-nftables"):
            self.assertFalse(self.box.is_active(unit), unit)
        self.assertEqual(self.box.listens(), [])
        self.assertEqual(self.box.shell("nft list ruleset"), "")
        self.the_ports_are_the_machines(said)
        self.box.shell(f"test -s {STATE}/ledger/log-* -a -s {INTERFACES}")

    def test_reinstallation_continues(self):
        self.box.apt(f"install {NOW}")
        programs.wait_until(self.box.answers, "the page to answer", 60)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)
        self.assertEqual(self.box.reports()[0]["state"], "answered")

    def test_purge_keeps_the_ledger_unless_requested(self):
        said = self.box.apt("purge adit")
        self.assertIn(f"the ledger of reports is kept: {STATE}", said)
        self.assertEqual(self.box.shell(f"ls {STATE}").split(), ["ledger"])
        self.assertEqual(self.box.shell("ls /etc/adit /var/lib/adit-network 2>/dev/null || true"), "")
        self.box.apt(f"install {NOW}", team=pc.PORTS["team"], command_post=pc.PORTS["command_post"])
        programs.wait_until(self.box.answers, "the page to answer", 60)
        self.box.apt("purge adit", remove_ledger="true")
        self.assertEqual(self.box.shell(f"ls -d {STATE} /var/lib/adit /etc/adit 2>/dev/null || true"), "")
        self.assertEqual(self.stage.office(), self.stage.office_before)
