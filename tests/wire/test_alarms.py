"""The alarm table: each condition of the Command Post, of robots and reports is made true on the real programs, is seen
everywhere (alarming.py), and is seen to go. Those of the box and its networks are in test_alarms_box.py."""

import signal
import time
import unittest

import hosts
import programs
from alarming import WithAlarms
from programs import wait_until
from reporting import another, began, left_unanswered, submit


def setUpModule():
    hosts.needs_namespaces()


class Alarms(WithAlarms):
    def test_a_run_in_which_all_is_well_has_none(self):
        stage = self.stage()
        robot = self.robot(stage, "r1")
        self.send_map(stage, "r1")
        wait_until(lambda: self.view(stage)["verdict"]["level"] == "good", "the map to arrive")
        self.assertEqual(self.view(stage)["verdict"]["what"], "Every map arrives")
        wait_until(lambda: robot.told > 20, "the robot to go on")
        self.assertEqual(self.view(stage)["alarms"], [])
        text, status = self.status(stage)
        self.assertIn("Maps  Every map arrives: 1 robot", text)
        self.assertEqual(status, 0)

    def test_the_command_post_is_unreachable(self):
        stage = self.stage()
        stage.post.stop(signal.SIGKILL)
        alarm = self.sees(stage, "command_post_unreachable", "bad", "command_post", "Command Post is unreachable",
                          "Connection refused", light="scoring")
        self.assertEqual(alarm["action"], {"word": "Open test", "link": "/setup#test"})
        stage.post = programs.CommandPost(stage.network, stage.folder, *stage.post_options)
        self.goes(stage, "command_post_unreachable")

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

    def test_the_command_post_refuses_a_token(self):
        stage = self.stage()
        stage.post.will(mapping=["401,for=600"])
        self.robot(stage, "r1")
        self.sees(stage, "command_post_refusing", "bad", "command_post", "Mapping token is refused", light="mapping")
        stage.post.control("DELETE /faults")
        self.goes(stage, "command_post_refusing")

    def test_what_answers_is_no_command_post(self):
        stage = self.stage()
        stage.post.will(mapping=["html-200,for=600"])
        self.robot(stage, "r1")
        self.sees(stage, "command_post_foreign", "bad", "command_post", "What answers is no Command Post", "(mapping)",
                  light="mapping")
        stage.post.control("DELETE /faults")
        self.goes(stage, "command_post_foreign")

    def test_everything_gets_500_and_no_grid_is_blamed(self):
        stage = self.stage()
        stage.post.will(mapping=["500,for=600"])
        self.robot(stage, "r1")
        self.send_map(stage, "r2")
        self.sees(stage, "command_post_failing", "bad", "command_post", "Mapping is failing", light="mapping")
        self.assertEqual([each["id"] for each in self.view(stage)["alarms"]], ["command_post_failing"])
        self.assertEqual(self.view(stage)["aside"], [])
        stage.post.control("DELETE /faults")
        self.goes(stage, "command_post_failing")

    def test_the_command_post_is_throttling(self):
        stage = self.stage()
        stage.post.will(mapping=["429,for=600"])
        self.robot(stage, "r1")
        self.sees(stage, "command_post_throttling", "wait", "command_post", "Mapping is throttling")
        stage.post.control("DELETE /faults")
        self.goes(stage, "command_post_throttling")

    def test_a_robot_is_silent_and_then_all_are(self):
        stage = self.stage(alarms__silent_for_ms=3000)
        robots = {name: self.robot(stage, name) for name in ("r1", "r2")}
        self.send_map(stage, "r1")
        self.send_map(stage, "r2", 2)
        wait_until(lambda: all(robot.told > 20 for robot in robots.values()), "their habits")
        robots["r1"].quiet()
        self.sees(stage, "robot_silent:r1", "bad", "robot", "r1 is silent", "its habit")
        self.assertEqual(self.view(stage)["verdict"]["what"], "1 of 2 arrive")
        self.assertIn("not r1", self.view(stage)["verdict"]["why"])
        self.acknowledged(stage, "robot_silent:r1")
        robots["r2"].quiet()
        alarm = self.sees(stage, "robots_silent", "bad", "robot", "All 2 robots are silent")
        self.assertEqual(alarm["hides"], 2)
        self.robot(stage, "r1"), self.robot(stage, "r2")
        self.goes(stage, "robots_silent")

    def test_one_robots_map_is_behind(self):
        stage = self.stage()
        stage.post.will(mapping=["429,robot=r2,for=600"])
        self.robot(stage, "r1")
        self.send_map(stage, "r2")
        self.sees(stage, "map_behind:r2", "wait", "command_post", "r2's map is behind")
        stage.post.control("DELETE /faults")
        self.goes(stage, "map_behind:r2")

    def test_the_maps_of_four_robots_are_behind_together(self):
        stage = self.stage()
        stage.post.will(mapping=["429,for=600"])
        for number in range(1, 5):
            self.send_map(stage, f"r{number}", number)
        alarm = self.sees(stage, "maps_behind", "wait", "network", "Maps of 4 robots are behind")
        self.assertEqual(alarm["hides"], 4)
        stage.post.control("DELETE /faults")
        self.goes(stage, "maps_behind")

    def fill(self, stage, name, most):
        """Maps of one robot after the other, until that alarm is there."""
        for seed in range(1, most):
            if self.alarm(stage, name):
                return
            self.send_map(stage, f"r{seed}", seed, 12000)
        wait_until(lambda: self.alarm(stage, name), name)

    def test_the_queue_is_growing(self):
        stage = self.stage(queues__map_bytes=8 << 20, command_post__budget_mbit=0.1)
        end, seed = time.monotonic() + 120, 0
        while not self.alarm(stage, "queue_growing"):
            seed += 1
            self.assertLess(time.monotonic(), end)
            self.send_map(stage, f"r{seed}", seed, 12000)
            wait_until(lambda at=time.monotonic(): time.monotonic() - at > 3 or self.alarm(stage, "queue_growing"), "the next one's time")
        self.sees(stage, "queue_growing", "wait", "network", "The map queue is growing", "more comes in than goes out")
        stage.box.save(lambda settings: settings["command_post"].update(budget_mbit=100))
        self.goes(stage, "queue_growing", 120)

    def test_the_queue_is_nearly_full(self):
        stage = self.stage(queues__map_bytes=1 << 20, command_post__budget_mbit=0.1)
        self.fill(stage, "queue_nearly_full", 8)
        self.sees(stage, "queue_nearly_full", "bad", "network", "The map queue is nearly full", "1 MB wait at most")
        stage.box.save(lambda settings: settings["command_post"].update(budget_mbit=100))
        self.goes(stage, "queue_nearly_full", 120)

    def test_the_queue_is_full(self):
        stage = self.stage(queues__map_bytes=1 << 20, command_post__budget_mbit=0.1)
        self.fill(stage, "queue_full", 100)
        self.sees(stage, "queue_full", "bad", "network", "The queue is full", "cloud")
        stage.box.save(lambda settings: settings["command_post"].update(budget_mbit=100))
        self.goes(stage, "queue_full", 120)

    def test_a_report_is_held(self):
        stage = self.stage(reports__review="all")
        left_unanswered(stage)
        alarm = self.sees(stage, "report_held:1", "ask", "box", "Report 1 is held")
        self.assertEqual(alarm["action"], {"word": "Decide", "link": "/#report=1"})
        self.assertEqual(stage.box.judge(1, "send")[0], 200)
        self.goes(stage, "report_held:1")

    def test_a_report_is_in_doubt(self):
        stage = self.stage()
        stage.post.will("other-sender,record-then-drop")
        left_unanswered(stage)
        self.sees(stage, "report_in_doubt:1", "ask", "command_post", "Report 1 is in doubt", light=None)
        self.assertEqual(stage.box.judge(1, "done")[0], 200)
        self.goes(stage, "report_in_doubt:1")

    def test_few_reports_are_left_and_then_none(self):
        stage = self.stage(post_options=("--rate", "0", "--reports", "6"))
        self.assertEqual(submit(stage).status_code, 201)
        self.sees(stage, "reports_left", "wait", "command_post", "5 reports are left")
        for number in range(5):
            submit(stage, another(number))
        wait_until(lambda: self.alarm(stage, "reports_left")["severity"] == "bad", "none to be left")
        self.sees(stage, "reports_left", "bad", "command_post", "No reports are left")
        stage.post.control("POST /new-run", {"run": "2"})
        self.goes(stage, "reports_left")

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

    def test_an_unknown_robot_posts(self):
        stage = self.stage(robots=[{"name": "r1"}])
        self.robot(stage, "r9")
        self.sees(stage, "robot_unknown:r9", "ask", "robot", "Robot r9 is unknown", "set-up has r1")
        stage.box.save(lambda settings: settings["robots"].append({"name": "r9"}))
        self.goes(stage, "robot_unknown:r9")

    def test_reports_wait_for_another_command_post(self):
        stage = self.stage()
        stage.post.will("429=100")
        left_unanswered(stage)
        self.name_scoring(stage, 8009)
        name = f"reports_elsewhere:{hosts.SCORING}:{programs.PORT}"
        self.sees(stage, name, "ask", "box", "1 report is for another post", "which the settings do not name now")
        stage.post.control("DELETE /faults")
        self.name_scoring(stage, programs.PORT)
        self.goes(stage, name)

    @staticmethod
    def name_scoring(stage, port):
        stage.box.save(lambda settings: settings["command_post"]["scoring"].update(port=port))

    def test_the_count_of_reports_is_not_certain(self):
        stage = self.stage()
        wait_until(lambda: self.view(stage)["run"]["run_clock"] > 0, "the run to begin")
        stage.post.control("POST /other-sender")
        self.sees(stage, "run_unreliable", "ask", "command_post", "The reports' count is not certain",
                  "somebody else reports with this token")
        self.assertEqual(stage.box.ask("POST /adit/runs", body={})[0], 200)
        self.goes(stage, "run_unreliable")

    def test_an_acknowledgement_outlives_the_service_and_hides_nothing_new(self):
        stage = self.stage(reports__review="all")
        left_unanswered(stage)
        self.sees(stage, "report_held:1", "ask", "box", "Report 1 is held")
        self.acknowledged(stage, "report_held:1")
        wait_until((stage.box.state / "acknowledged.json").exists, "it to be kept")
        for how in (signal.SIGTERM, signal.SIGKILL):
            stage.box.stop(how)
            stage.restart_box()
            wait_until(lambda: self.alarm(stage, "report_held:1"), "it to be found again")
            self.assertTrue(self.alarm(stage, "report_held:1")["acknowledged"])
            wait_until(lambda: self.light(stage) == "on", "the attention light to stay lit")
        left_unanswered(began(stage), another(1))
        self.sees(stage, "report_held:2", "ask", "box", "Report 2 is held")
        stage.box.stop()
        (stage.box.state / "acknowledged.json").write_text("damaged")
        stage.restart_box()
        self.sees(began(stage), "report_held:1", "ask", "box", "Report 1 is held")
        self.assertFalse(self.alarm(stage, "report_held:1")["acknowledged"])
        self.assertEqual(stage.box.said().count("which alarms were acknowledged cannot be read"), 1)
