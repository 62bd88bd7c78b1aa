"""A PC whose clock has lost its battery: who sets the time of day, and its time after a power cut."""

import time

import requests

import boards
import hosts
import maps
import messages
import ntp
import stage
from dials import Dials
from stage import Stage, Story, load_tests, note  # unittest looks for them here

DAYS = 400 * 86400.0
EARLIEST = 1767225600  # firmware/rules/clock/messages.hpp


def setUpModule():
    hosts.needs_root()
    stage.skip_without(boards.PC)


class TimeOfDay(Dials, Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage(board=boards.PC))

    def post_state(self):
        """The stamp of the delivered pose."""
        before = len(self.stage.post.requests("/state/update"))
        pose = {"name": "r1", "position": {"x": float(before), "y": 0.0, "z": 0.0}, "orientation": maps.IDENTITY}
        state = {"poses": [pose], "header": {"stamp": time.time(), "frame_id": "darpa"}}
        answer = messages.post(requests.Session(), self.box.url, "/state/update", state, messages.Style())
        self.assertEqual(answer.status_code, 200, answer.text)
        self.box.wait_until(lambda: len(self.stage.post.requests("/state/update")) > before, "the state to arrive")
        return self.stage.post.requests("/state/update")[-1]["message"]["header"]["stamp"]

    def test_date_of_the_command_post_sets_an_unset_clock(self):
        self.stage.start()
        self.assertGreater(self.box.run_view()["now"], EARLIEST, "its battery is empty: it began in 2020, or as it was built")
        self.stage.began()
        self.source_is("command_post")
        self.box.console.wait_for_shell()
        self.assert_close(self.system_now(), 0)
        type(self).stamp = self.post_state()

    def test_the_operator_sets_it_either_way(self):
        for ahead in (-30 * 86400.0, DAYS):
            self.operator_sets_it(ahead)
        stamp = self.post_state()
        self.assertAlmostEqual(stamp - self.stamp, 0, delta=600, msg="no stamp goes by it")
        type(self).stamp = stamp

    def test_command_post_does_not_overrule_the_operator(self):
        self.stage.began()
        self.assertEqual(self.clock()["source"], "operator")
        self.assert_close(self.clock()["now"], DAYS)

    def test_ntp_server_of_the_team_sets_and_keeps_it(self):
        self.server = ntp.Server(self.stage.network.team, self.stage.network.team_address, ahead=100 * 86400.0)
        type(self).addClassCleanup(self.server.close)
        self.box.save(lambda settings: settings.update(clock={"ntp_server": self.stage.network.team_address, "serve_ntp": True}))
        began = self.box.moment()
        self.source_is("ntp")
        note("PC: from the setting to the NTP server's time", self.box.took(began))
        self.box.wait_until(lambda: self.clock()["is_kept"], "chronyd to keep it")
        self.assert_close(self.system_now(), 100 * 86400.0)
        status, said = self.box.ask("POST /adit/clock", body={"time": time.time()})
        self.assertEqual(status, 409, said)

    def test_box_serves_its_time_to_the_team(self):
        # Once chronyd has heard the server again; until then it uses the time that was set (10).
        told = []
        self.box.wait_until(lambda: told.append(ntp.asked_of(self.stage.network.team, self.stage.network.box_address))
                            or told[-1] and told[-1][0] == 3, "one more than the server's stratum")
        told = told[-1]
        self.assert_close(told[1], 100 * 86400.0)
        self.assertIsNone(ntp.asked_of(self.stage.network.post, hosts.BOX_DARPA), "the Command Post's side")

    def test_clock_continues_from_the_last_known_time_after_a_power_cut(self):
        time.sleep(11)  # it is kept every ten seconds
        known = self.box.run_view()["now"]
        self.stage.post.stop()
        self.box.cut_power()
        self.stage.start()
        self.box.wait_until(lambda: self.clock()["managed"], "adit-clock to have run")
        self.assertGreater(self.box.run_view()["now"], known - 30)
        self.source_is("ntp")
        self.box.console.wait_for_shell()
        log = self.box.console.ask("journalctl -b -u adit-clock -o verbose --no-pager")
        self.assertIn("last_known", log)
        self.assertLess(log.index("last_known"), log.index("=ntp"))

    def test_units_are_in_their_expected_states(self):
        self.assertEqual(self.box.console.ask("systemctl --failed --plain --no-legend --no-pager"), "")
