"""Alarms of three kinds of causes: the box itself, a cable, the Command Post. Each condition is made true with the real programs, is
seen everywhere (alarming.py), and ends. Other conditions: test_alarms_*.py. Their texts: tests/alarms/conditions_test."""

import signal

import programs
from alarming import WithAlarms
from filling import Filler
from programs import wait_until


class Alarms(WithAlarms):
    def test_good_run_has_no_alarms(self):
        stage = self.stage()
        robot = self.robot(stage, "r1")
        self.send_map(stage, "r1")
        wait_until(lambda: self.view(stage)["verdict"]["level"] == "good", "the map to arrive")
        wait_until(lambda: robot.told > 20, "the robot to go on")
        self.assertEqual(self.view(stage)["alarms"], [])
        self.assertEqual(self.status(stage)[1], 0)
        for endpoint in self.view(stage)["endpoints"]:
            self.assertLess(endpoint["answered"], 60, endpoint["name"])

    def test_the_command_post_is_unreachable(self):
        stage = self.stage()
        stage.post.stop(signal.SIGKILL)
        alarm = self.sees(stage, "command_post_unreachable", "bad", "command_post", "Connection refused", light="scoring")
        self.assertEqual(alarm["action"], {"word": "Open test", "link": "/setup#test"})
        stage.post = programs.CommandPost(stage.network, stage.folder, *stage.post_options)
        self.goes(stage, "command_post_unreachable")

    def test_the_disk_is_nearly_full(self):
        stage = self.stage(disk="12m")
        filler = Filler(stage.box.state, leaves=512 << 10)
        self.sees(stage, "disk_full", "bad", "box")
        filler.make_room()
        self.goes(stage, "disk_full")

    def test_a_cable_is_out_and_is_the_only_cause(self):
        stage = self.stage()
        stage.network.pull_cable()
        self.sees(stage, "cable_out:command_post", "bad", "network", "darpa0")
        wait_until(lambda: self.alarm(stage, "cable_out:command_post")["hides"] > 0, "the endpoints to be hidden")
        self.assertEqual(len(self.view(stage)["alarms"]), 1)
        stage.network.pull_cable(False)
        self.goes(stage, "cable_out:command_post")
