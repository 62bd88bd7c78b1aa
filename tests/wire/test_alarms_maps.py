"""Alarms of maps that do not arrive, and whom they blame."""

import signal
import time

from alarming import WithAlarms
from programs import wait_until


class Maps(WithAlarms):
    def test_the_command_post_is_silent_and_no_robot_is_blamed(self):
        stage = self.stage(alarms__silent_for_ms=3000, command_post__timeouts__scoring_answer_ms=10000)
        robots = [self.robot(stage, "r1"), self.robot(stage, "r2")]
        self.send_map(stage, "r1")
        wait_until(lambda: all(robot.told > 20 for robot in robots), "the robots' habits")
        stage.post.process.send_signal(signal.SIGSTOP)
        self.send_map(stage, "r1", 2)
        robots[0].quiet()
        self.sees(stage, "command_post_silent", "bad", "command_post", "Command Post is silent", "no answer from",
                  light="scoring")
        alarm = wait_until(lambda: (found := self.alarm(stage, "command_post_silent")) and found["hides"] and found,
                           "what follows from it to be counted")
        self.assertEqual([each["id"] for each in self.view(stage)["alarms"]], ["command_post_silent"], alarm)
        self.assertEqual(self.view(stage)["verdict"]["what"], "Nothing arrives")
        stage.post.process.send_signal(signal.SIGCONT)
        self.goes(stage, "command_post_silent")
        self.assertIsNotNone(wait_until(lambda: self.alarm(stage, "robot_silent:r1"), "what it hid"))

    def test_the_maps_of_four_robots_are_behind_together(self):
        stage = self.stage()
        stage.post.will(mapping=["429,for=600"])
        for number in range(1, 5):
            self.send_map(stage, f"r{number}", number)
        alarm = self.sees(stage, "maps_behind", "wait", "network", "Maps of 4 robots are behind")
        self.assertEqual(alarm["hides"], 4)
        stage.post.control("DELETE /faults")
        self.goes(stage, "maps_behind")

    def test_a_message_is_set_aside(self):
        stage = self.stage()
        stage.post.will(mapping=["500,robot=r2,for=600"])
        self.send_map(stage, "r2")
        for seed in range(300):  # others pass all the while
            self.send_map(stage, f"r{3 + seed % 3}", seed)
            if self.alarm(stage, "set_aside"):
                break
            time.sleep(0.2)
        self.sees(stage, "set_aside", "ask", "command_post", "1 message is set aside", "would not take it")
        number = self.view(stage)["aside"][0]["number"]
        self.assertEqual(stage.box.ask(f"POST /adit/aside/{number}/discard", body={})[0], 200)
        self.goes(stage, "set_aside")
