"""A freshly written card in a box between two networks: set-up over the network, a run, and a factory reset."""

import time

import hosts
import programs
import leds
import stage
from eavesdropper import mdns_addresses
from reporting import REPORT
from stage import Stage, Story, load_tests, note, setUpModule  # unittest looks for them here

PASSWORD = "correct horse battery"
PORTS_NOBODY_MAY_OPEN = [*range(1, 1025), 1883, 5353, 5355, 8000, 8080, 8443, 9090, 19531, 49152]


class FirstStart(Story):
    session = {}  # the headers of whoever has logged in

    @classmethod
    def setUpClass(cls):
        cls.tell(Stage(set_up=False))
        cls.stage.box.power_on()

    def asked(self, request, body=None, status=200):
        headers = {**type(self).session, "Content-Type": "application/json"}
        got, said = self.box.insist(request, headers, body, token=None, timeout=20)
        self.assertEqual(got, status, said)
        return said

    def test_it_answers_at_the_factory_address_and_wants_a_password(self):
        self.box.wait_for_answer()
        note("first start, from power to the first answer on team0", self.box.start_took)
        said = self.asked("GET /adit/session")
        self.assertEqual((said["role"], said["first_start"], said["set_up_open"]), (None, True, False))

    def test_lights_show_that_set_up_is_needed(self):
        leds.wait_for(self.box, health="on", scoring="fast", mapping="fast", attention="fast")

    def test_root_is_read_only_and_the_state_fills_the_card(self):
        self.box.console.wait_for_shell()
        self.assertNotEqual(self.box.console.run("touch /etc/x")[0], 0)
        self.assertNotEqual(self.box.console.run("touch /usr/x")[0], 0)
        megabytes = int(self.box.console.ask("df -m /var | tail -n 1").split()[1])
        self.assertGreater(megabytes, 450, "of 1024: the image takes 448")

    def test_the_state_is_trimmed(self):
        self.box.console.ask("systemctl start adit-trim.service")
        self.assertRegex(self.box.console.ask("journalctl -q -o cat -u adit-trim.service"), r"/var: \d+ bytes .*trimmed")

    def test_without_the_button_a_password_needs_the_code(self):
        self.asked("POST /adit/password", {"role": "operator", "password": PASSWORD}, status=403)
        self.asked("POST /adit/password", {"role": "operator", "code": "00000000", "password": PASSWORD}, status=403)

    def open_set_up(self):
        """Presses the button for between three and six seconds."""
        self.box.press(4.5)
        self.box.wait_until(lambda: self.asked("GET /adit/session")["set_up_open"], "set-up to be open")

    def test_press_of_three_seconds_opens_set_up(self):
        self.open_set_up()
        self.asked("POST /adit/password", {"role": "operator", "password": PASSWORD})
        said = self.asked("GET /adit/session")
        self.assertEqual((said["first_start"], said["set_up_open"]), (False, False))
        type(self).session = programs.log_in(self.box, PASSWORD)

    def test_tokens_and_settings_are_set_over_the_api(self):
        for name, token in (
            ("scoring", programs.SCORING_TOKEN),
            ("mapping", programs.MAPPING_TOKEN),
            ("team", programs.TEAM_TOKEN),
        ):
            self.asked("POST /adit/tokens", {"name": name, "token": token})
        self.box.wait_until(
            lambda: self.box.wants(self.asked, "GET /adit/settings", applying=False), "the tokens to be in use"
        )
        settings = programs.settings(self.stage.network, self.stage.overrides)
        tag = self.asked("GET /adit/settings")["tag"]
        self.asked("POST /adit/settings", {"settings": settings, "base": tag})
        self.box.wait_until(self.box.answers, "the box to serve with its new settings")
        self.assertEqual(
            self.asked("GET /adit/settings")["settings"]["command_post"]["scoring"]["address"], hosts.SCORING
        )

    def test_darpa0_keeps_a_confirmed_address(self):
        self.asked("POST /adit/network", stage.NUMBERS)
        self.box.wait_until(lambda: self.asked("GET /adit/network")["pending"], "the change to be tried")
        self.box.wait_until(lambda: self.has_address(hosts.BOX_DARPA), "darpa0 to have its address")
        self.box.wait_until(self.confirmed, "the change to be made, so that it can be confirmed")
        self.box.wait_until(lambda: self.asked("GET /adit/network")["last"] == "confirmed", "it to be confirmed")
        self.stage.began()

    def confirmed(self):
        headers = {**type(self).session, "Content-Type": "application/json"}
        status, said = self.box.ask("POST /adit/network/confirm", headers=headers, token=None, timeout=20)
        self.assertIn(status, (200, 409), said)
        return status == 200

    def has_address(self, address):
        return address in [each["address"] for each in self.asked("GET /adit/network")["command_post"]["addresses"]]

    def test_lights_show_that_all_is_well(self):
        leds.wait_for(self.box, health="on", scoring="on", attention="off")

    def test_run_scores_and_no_message_violates_the_icd(self):
        status, said = self.box.ask("POST /api/artifact_reports", body=REPORT, timeout=60)  # a true one
        self.assertEqual((status, said["score_change"]), (201, 1), said)
        status, said = self.stage.robots(20, "--robots", "2", "--seed", "7")
        self.assertEqual(status, 0, said)
        self.assertGreater(self.box.run_view()["run"]["score"], 0)
        for uri in ("/map/update", "/state/update", "/markers/update", "/api/artifact_reports"):
            self.assertGreater(len(self.stage.post.requests(uri)), 0, uri)
        self.assertEqual(self.stage.post.violations(), [])

    def test_a_short_press_makes_all_lights_flash(self):
        def flash():  # ten seconds long
            self.box.press(0.5)
            return set(leds.patterns(self.box.watch_lights(leds.LONGEST)).values()) == {"twice"}

        self.box.wait_until(flash, "all lights to flash after a press")

    def test_kernel_addresses_are_hidden(self):
        self.assertEqual(self.box.console.ask("cat /proc/sys/kernel/kptr_restrict").split(), ["2"])

    def test_memory_in_use_is_bounded(self):
        self.box.wait_until(lambda: self.box.console.run("systemctl is-active rauc.service")[0] != 0, "RAUC's service to be gone")
        used = self.box.console.ask("free -m | grep Mem").split()[2]
        note("RAM in use, after a run", f"{used} MB of {self.box.memory}")
        self.assertLessEqual(int(used), 64)

    def test_only_the_team_finds_it_by_name(self):
        network = self.stage.network
        self.box.wait_until(
            lambda: network.box_address in mdns_addresses(network, network.team, network.team_address),
            "the team to find it",
        )
        self.assertEqual(mdns_addresses(network, network.post, hosts.SCORING), set())

    def test_no_port_is_open_to_the_command_post(self):
        network = self.stage.network
        self.assertEqual(
            network.open_ports(network.team, network.box_address, [22, 80, 8000], 60), [80, 8000], "this way it does"
        )
        self.assertEqual(network.open_ports(network.post, hosts.BOX_DARPA, PORTS_NOBODY_MAY_OPEN), [])

    def test_team_address_is_unreachable_from_the_command_post(self):
        network = self.stage.network
        hosts.ip("-n", network.post, "route", "add", network.box_address, "via", hosts.BOX_DARPA)
        self.assertEqual(network.open_ports(network.post, network.box_address, [80, 8000]), [])

    def test_a_pulled_cable_shows_and_heals(self):
        self.box.plug("darpa0", False)
        leds.wait_for(self.box, scoring="flash", mapping="flash")
        self.assertIn(
            ("command_post", False), [(link["side"], link["carrier"]) for link in self.box.run_view()["links"]]
        )
        self.box.plug("darpa0")
        began = self.box.moment()
        self.box.wait_until(
            lambda: self.box.run_view()["run_clock"]["age"] < time.monotonic() - began[0] and self.box.is_connected("scoring"),
            "the Command Post to be heard again",
        )
        note("healed after the cable was put back in", self.box.took(began))

    def test_darpa0_carried_only_arp_and_tcp_to_the_endpoints(self):
        self.assertGreater(self.stage.ear.count(), 100)
        self.assertEqual(self.stage.ear.strangers(*stage.ENDPOINTS), [])

    def test_press_of_ten_seconds_resets_all_but_the_reports(self):
        reports = [(each["number"], each["state"]) for each in self.box.reports()]
        self.assertGreater(len(reports), 0)
        self.box.press(12.0)
        type(self).session = {}
        self.box.wait_until(
            lambda: self.box.wants(self.asked, "GET /adit/session", first_start=True), "the first start again"
        )
        self.assertEqual(self.box.ask("GET /adit/run")[0], 401, "the team's token is forgotten")
        self.open_set_up()
        self.asked("POST /adit/password", {"role": "operator", "password": PASSWORD})
        type(self).session = programs.log_in(self.box, PASSWORD)
        self.assertEqual([(each["number"], each["state"]) for each in self.asked("GET /adit/reports")], reports)
        self.assertFalse(self.has_address(hosts.BOX_DARPA), "the box's addresses are forgotten")
