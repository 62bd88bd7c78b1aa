"""The alarm table: each condition is made true on the real programs, and is seen in /adit/run, in /metrics, by `adit status`
and on the lights, with its words and whose side it is on; and is seen to go. What these hosts cannot make true is driven
through the seam by which the real thing comes: the files of adit-update and adit-network."""

import json
import os
import pathlib
import signal
import subprocess
import threading
import time
import unittest

import requests

import hosts
import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until
from reporting import QUICK, another, began, left_unanswered, submit

CBOR = Style("cbor")
EXIT = {"bad": 1, "ask": 1, "wait": 0}


def setUpModule():
    hosts.needs_namespaces()


class Robot(threading.Thread):
    """One that tells its pose a few times a second until it is to be quiet."""

    def __init__(self, stage, name):
        super().__init__(daemon=True)
        self.stage, self.name, self.over, self.told = stage, name, threading.Event(), 0
        self.start()

    def run(self):
        session = requests.Session()
        while not self.over.wait(0.3):
            pose = {"name": self.name, "position": {"x": float(self.told), "y": 0.0, "z": 0.0},
                    "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
            messages.post(session, self.stage.box.url, "/state/update", {"poses": [pose]}, CBOR)
            self.told += 1

    def quiet(self):
        self.over.set()
        self.join(30)


class Alarms(unittest.TestCase):
    def stage(self, **overrides):
        return began(self.enterContext(Stage(**{**QUICK, **overrides})))

    def robot(self, stage, name):
        robot = Robot(stage, name)
        self.addCleanup(robot.quiet)
        return robot

    def send_map(self, stage, name, seed=1, points=100):
        return messages.post(requests.Session(), stage.box.url, "/map/update",
                             messages.map_update(maps.made_cloud(points, seed=seed), name, time.time(), CBOR), CBOR)

    def view(self, stage):
        return stage.box.ask("GET /adit/run")[1]

    def alarm(self, stage, name):
        return next((alarm for alarm in self.view(stage)["alarms"] if alarm["id"] == name), None)

    def metrics(self, stage):
        return requests.get(stage.box.url + "/metrics", timeout=30,
                            headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"}).text

    def status(self, stage):
        """What `adit status` prints, and its exit status."""
        done = subprocess.run([programs.BIN / "adit", "status", "--at", f"{stage.network.box_address}:{programs.PORT}",
                               "--token-file", stage.folder / "secrets/team.token"], capture_output=True, text=True, check=False)
        return done.stdout, done.returncode

    def light(self, stage, name="attention"):
        return next(light["pattern"] for light in self.view(stage)["lights"] if light["name"] == name)

    def blinks(self, stage, name):
        """The light itself, in the simulated panel, was dark and was lit."""
        panel = pathlib.Path(stage.box.state, "panel")
        for word in ("off", "on"):
            wait_until(lambda word=word: f"{name} {word}\n" in panel.read_text(), f"the {name} light to be {word}")

    def sees(self, stage, name, severity, side, what, why="", light=None, within=60):
        """The alarm, everywhere alike. `light`: one that blinks beside attention."""
        wanted = {"severity": severity, "side": side, "what": what}
        alarm = wait_until(lambda: (found := self.alarm(stage, name)) and {**found, **wanted} == found and found, name, within)
        self.assertIn(why, alarm["why"])
        self.assertIn(f'adit_alarm{{id="{name}",severity="{severity}",side="{side}"}} 1\n', self.metrics(stage))
        text, status = self.status(stage)
        self.assertIn(what, text)
        self.assertGreaterEqual(status, EXIT[severity], text)
        wait_until(lambda: self.view(stage)["now"] - self.alarm(stage, name)["since"] > 1.5, "it to last")
        if severity != "wait":
            wait_until(lambda: self.light(stage) == "fast", "the attention light")
            self.blinks(stage, "attention")
        if light:
            wait_until(lambda: self.light(stage, light) == "fast", f"the {light} light")
            self.blinks(stage, light)
        return alarm

    def goes(self, stage, name, within=60):
        """It is nowhere any more, but among the last that were."""
        wait_until(lambda: not self.alarm(stage, name), f"the end of {name}", within)
        wait_until(lambda: any(over["id"] == name for over in self.view(stage)["alarms_over"]), "it to be remembered")
        self.assertNotIn(f'id="{name}"', self.metrics(stage))
        if not self.view(stage)["alarms"]:
            self.assertEqual(self.status(stage)[1], 0)
            wait_until(lambda: self.light(stage) == "off", "the attention light to be dark")

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

    def acknowledged(self, stage, name):
        """It is quiet: its light no longer blinks, and what is new is as loud as ever."""
        self.assertEqual(stage.box.ask("POST /adit/alarms/acknowledge", body={"id": name}), (200, {"acknowledged": name}))
        self.assertTrue(self.alarm(stage, name)["acknowledged"])
        wait_until(lambda: self.light(stage) == "on", "the attention light to stay lit")
        self.assertIn("(acknowledged)", self.status(stage)[0])
        self.assertEqual(stage.box.ask("POST /adit/alarms/acknowledge", body={"id": "no_such"})[0], 409)

    def test_one_robots_map_is_behind(self):
        stage = self.stage()
        stage.post.will(mapping=["429,robot=r2,for=600"])
        self.robot(stage, "r1")
        self.send_map(stage, "r2")
        self.sees(stage, "map_behind:r2", "wait", "command_post", "r2's map is behind")
        stage.post.control("DELETE /faults")
        self.goes(stage, "map_behind:r2")

    def test_the_queue_is_nearly_full_and_then_full(self):
        stage = self.stage(queues__map_bytes=1 << 20, command_post__budget_mbit=0.1)
        seed = 0
        while not self.alarm(stage, "queue_full"):
            seed += 1
            self.assertLess(seed, 100)
            self.send_map(stage, f"r{seed}", seed, 12000)
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

    def test_the_disk_is_nearly_full(self):
        stage = self.stage(disk="12m")
        filler, room = stage.box.state / "filler", os.statvfs(stage.box.state)
        filler.write_bytes(bytes(room.f_bavail * room.f_frsize - (512 << 10)))
        self.sees(stage, "disk_full", "bad", "box", "The disk is nearly full")
        filler.unlink()
        self.goes(stage, "disk_full")

    def test_the_ledger_was_damaged(self):
        stage = self.stage()
        self.assertEqual(submit(stage).status_code, 201)
        self.assertEqual(stage.box.stop(), 0)
        ledger = stage.box.state / "ledger.sqlite"
        ledger.write_bytes(b"x" * 4096 + ledger.read_bytes()[4096:])
        for log in stage.box.state.glob("ledger.sqlite-*"):
            log.unlink()
        stage.restart_box()
        self.sees(began(stage), "ledger_damaged", "ask", "box", "The ledger was damaged")

    def test_a_cable_is_out_and_is_the_only_cause(self):
        stage = self.stage()
        stage.network.pull_cable()
        self.sees(stage, "cable_out:command_post", "bad", "network", "The Command Post's cable is out", "darpa0")
        wait_until(lambda: self.alarm(stage, "cable_out:command_post")["hides"] > 0, "the endpoints to be hidden")
        self.assertEqual(len(self.view(stage)["alarms"]), 1)
        stage.network.pull_cable(False)
        self.goes(stage, "cable_out:command_post")

    def test_an_unknown_robot_posts(self):
        stage = self.stage(robots=[{"name": "r1"}])
        self.robot(stage, "r9")
        self.sees(stage, "robot_unknown:r9", "ask", "robot", "Robot r9 is unknown", "set-up has r1")
        stage.box.save(lambda settings: settings["robots"].append({"name": "r9"}))
        self.goes(stage, "robot_unknown:r9")

    def test_no_token_is_set(self):
        stage = self.stage()
        (stage.folder / "secrets/mapping.token").unlink()
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": None})
        self.sees(stage, "no_token:mapping", "bad", "box", "No mapping token is set", "wait until one is")
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": programs.MAPPING_TOKEN})
        self.goes(stage, "no_token:mapping")

    def test_the_settings_were_taken_back(self):
        stage = self.stage()
        held = stage.box.ask("GET /adit/settings")[1]
        held["settings"]["team"]["listen"].append({"address": "192.168.99.99", "port": 1234})
        stage.box.apply("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})
        self.sees(stage, "settings_not_changed", "bad", "box", "The last change was taken back")
        stage.box.save(lambda settings: settings["reports"].update(near_metres=7))
        self.goes(stage, "settings_not_changed")

    # By adit-update's file: it needs an image with two slots.
    def tell_of_update(self, stage, **more):
        status = {"format": 1, "trouble": "", "running": {"compatible": "adit-x", "version": "1.2.0", "slot": "B", "other": "A"},
                  "nonce": "", "refusal": "", "doing": "", "progress": None,
                  "last": {"stage": "installed", "version": "1.2.0", "slot": "B", "boot": "b", "why": ""},
                  "trial": False, "stray": "", "stick": None, "stick_trouble": "", **more}
        folder = stage.folder / "update"
        folder.mkdir(exist_ok=True)
        (folder / "status.new").write_text(json.dumps(status))
        (folder / "status.new").rename(folder / "status.json")

    def test_an_update_is_on_trial(self):
        stage = self.stage()
        self.tell_of_update(stage, trial=True)
        self.sees(stage, "update_on_trial", "wait", "box", "Version 1.2.0 is on trial")
        self.tell_of_update(stage)
        self.goes(stage, "update_on_trial")

    def test_another_slot_runs_than_the_last_good_one(self):
        stage = self.stage()
        self.tell_of_update(stage, stray="A with 1.1.0 runs, and B with 1.2.0 was good last")
        self.sees(stage, "other_slot", "ask", "box", "Another slot is running", "B with 1.2.0 was good last")
        self.tell_of_update(stage)
        self.goes(stage, "other_slot")

    # By adit-network's file: it asks by ARP at each Test, as root.
    def test_our_address_is_taken(self):
        stage = self.stage()
        folder = stage.folder / "network" / "status"
        folder.mkdir(parents=True, exist_ok=True)
        probed = {"version": 1, "nonce": "0" * 32, "address": hosts.BOX_DARPA, "claimant": "02:00:00:00:00:07", "own": "",
                  "found_on": "", "trouble": ""}
        for claimant in ("02:00:00:00:00:07", ""):
            (folder / "probed.new").write_text(json.dumps({**probed, "claimant": claimant}))
            (folder / "probed.new").rename(folder / "probed.json")
            if claimant:
                self.sees(stage, "address_taken", "bad", "network", "Our address is taken", claimant)
        self.goes(stage, "address_taken")


if __name__ == "__main__":
    unittest.main()
