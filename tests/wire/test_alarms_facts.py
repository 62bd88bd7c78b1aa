"""Each source of facts for alarms reaches /adit/run: files of other programs, reports, clients, rejected messages, a full disk. Rules
and texts of alarms: tests/alarms/conditions_test."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time

from unittest import mock

import hosts
import programs
from alarming import WithAlarms, reason
from filling import Filler
from networkd import AditNetwork
from programs import wait_until
from reporting import another, is_taken, left_unanswered

UPDATE = {"format": 1, "trouble": "", "running": {"compatible": "adit-x", "version": "1.2.0", "slot": "B", "other": "A"},
          "nonce": "", "refusal": "", "doing": "", "progress": None,
          "last": {"stage": "installed", "version": "1.2.0", "slot": "B", "boot": "b", "why": ""},
          "trial": False, "stray": "", "stick": None, "stick_trouble": ""}
NETWORK = {"format": 1, "team_interface": "team0", "command_post_interface": "darpa0", "kept": AditNetwork.numbers(),
           "endpoints": [], "pending": None, "last": "", "last_nonce": "", "why": "", "trouble": ""}


def pending():
    until = time.clock_gettime_ns(time.CLOCK_MONOTONIC) // 1_000_000 + 60_000
    return {"nonce": "0" * 32, "until_ms": until, "confirm_within_ms": 60000, "wanted": AditNetwork.numbers(team="192.168.8.11")}


class Facts(WithAlarms):
    def write(self, stage, name, text):
        file = stage.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        (file.parent / ".new").write_text(text)
        (file.parent / ".new").rename(file)

    def test_files_of_other_programs(self):
        stage = self.stage()
        update, network = "update/status.json", "network/status/status.json"
        for name, text, without, alarm, severity, why in (
                (update, {**UPDATE, "trial": True}, UPDATE, "update_on_trial", "wait", ""),
                (update, {**UPDATE, "stray": "B was good last"}, UPDATE, "other_slot", "ask", "B was good last"),
                (network, {**NETWORK, "pending": pending()}, NETWORK, "network_change", "ask", "192.168.8.11"),
                (network, {**NETWORK, "kept": {**NETWORK["kept"], "command_post": {"addresses": [], "gateway": ""}}}, NETWORK,
                 "no_address", "bad", ""),
                ("notices/disks", "2 disks hold an Adit", "", "notice:disks", "bad", "2 disks hold an Adit")):
            with self.subTest(alarm):
                self.write(stage, name, text if isinstance(text, str) else json.dumps(text))
                found = wait_until(lambda alarm=alarm: self.alarm(stage, alarm), alarm)
                self.assertEqual(found["severity"], severity)
                self.assertIn(why, reason(found))
                self.write(stage, name, without if isinstance(without, str) else json.dumps(without))
                wait_until(lambda alarm=alarm: not self.alarm(stage, alarm), f"the end of {alarm}")

    def test_reports_and_clients(self):
        stage = self.stage(robots=[{"name": "r1"}], reports__review="all", post_options=("--rate", "0", "--reports", "5"))
        left_unanswered(stage)
        self.robot(stage, "r9")
        self.assertEqual(stage.box.ask("GET /api/status", token="an-old-token")[0], 401)
        self.assertEqual(stage.box.ask("POST /map/update", body={}, token=None)[0], 401)
        wait_until(lambda: self.view(stage)["run"]["run_clock"] > 0, "the run to begin")
        stage.post.control("POST /other-sender")
        for alarm in ("report_held:1", "robot_unknown:r9", "wrong_tokens", "client_token", "reports_left", "run_unreliable"):
            wait_until(lambda alarm=alarm: self.alarm(stage, alarm), alarm)
        self.assertEqual(stage.box.judge(1, "send")[0], 200)
        wait_until(lambda: not self.alarm(stage, "report_held:1"), "the end of report_held:1")

    def test_settings_another_command_post_and_a_full_queue(self):
        stage = self.stage(queues__map_bytes=1 << 20)
        stage.post.will("429=100", mapping=["429,for=600"])
        left_unanswered(stage)
        self.assertIn(429, (self.send_map(stage, f"r{seed}", seed, 3000).status_code for seed in range(1, 100)))
        stage.box.save(lambda settings: settings["command_post"]["scoring"].update(port=8009))
        for alarm in ("queue_full", "queue_nearly_full", f"reports_elsewhere:{hosts.SCORING}:{programs.PORT}"):
            wait_until(lambda alarm=alarm: self.alarm(stage, alarm), alarm)
        self.assertEqual(stage.box.stop(), 0)
        for file in ("settings.json", "settings.json.copy"):
            (stage.box.state / file).write_text("{")
        stage.restart_box()
        wait_until(lambda: self.alarm(stage, "settings_not_used"), "settings_not_used")
        held = stage.box.ask("GET /adit/settings")[1]
        held["settings"]["team"]["listen"].append({"address": "192.168.99.99", "port": 1234})
        stage.box.apply("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})
        wait_until(lambda: self.alarm(stage, "settings_not_changed"), "settings_not_changed")

    def test_a_message_is_rejected(self):
        stage = self.stage()
        stage.post.will(mapping=["500,robot=r2,for=600"])
        self.send_map(stage, "r2")
        for seed in range(300):  # others pass all the while
            self.send_map(stage, f"r{3 + seed % 3}", seed)
            if self.alarm(stage, "messages_rejected"):
                break
            time.sleep(0.2)
        self.sees(stage, "messages_rejected", "ask", "command_post")
        number = self.view(stage)["rejected"][0]["number"]
        self.assertEqual(stage.box.ask(f"POST /adit/rejected/{number}/discard", body={})[0], 200)
        self.goes(stage, "messages_rejected")

    def test_the_disk_is_nearly_worn_out(self):
        """The life-time estimate of an eMMC, as the kernel logs it at each boot."""
        stage = self.stage()
        device = os.stat(stage.box.state).st_dev
        disk = stage.folder / "block" / f"{os.major(device)}:{os.minor(device)}" / "device"
        disk.mkdir(parents=True)
        for life, severity, why in (("0x02 0x0a", "ask", "90 %"), ("0x02 0x0c", "wait", "0x0c"), ("0x02 0x09", "", "")):
            with self.subTest(life):
                (disk / "life_time").write_text(life + "\n")
                self.assertEqual(stage.box.stop(), 0)
                stage.restart_box()
                if severity:
                    self.sees(stage, "disk_health", severity, "box", why)
                else:
                    self.assertIsNone(self.alarm(stage, "disk_health"))

    def test_three_faults_put_the_queue_aside(self):
        """As if a queued map ended each process: the next process leaves it alone, and reports are sent."""
        runtime = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-runtime-")))
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=str(runtime)))
        stage = self.stage()
        stage.post.will(mapping=["500,for=600"])
        self.assertEqual(self.send_map(stage, "r1", 1).status_code, 200)
        for signal_of_a_fault in (signal.SIGSEGV, signal.SIGABRT, signal.SIGSEGV):
            self.assertEqual(stage.box.stop(signal_of_a_fault), -signal_of_a_fault)
            self.assertTrue(list((runtime / "waiting").iterdir()))
            self.assertFalse((runtime / "waiting.aside").exists())
            stage.restart_box()
        self.sees(stage, "queue_put_aside", "ask", "box", "waiting.aside", panel=False)
        self.assertTrue(list((runtime / "waiting.aside").iterdir()))
        is_taken(stage, another(1))
        self.assertEqual(stage.box.stop(), 0)
        stage.restart_box()
        self.assertIsNone(self.alarm(stage, "queue_put_aside"))

    def test_a_map_that_ended_aditd_three_times_is_put_aside(self):
        """As if two faults had been counted, and a third one ended the process. The alarm stays until the operator decides."""
        runtime = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-runtime-")))
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=str(runtime)))
        stage = self.stage()
        stage.post.will(mapping=["500,for=600"])
        for name in ("r1", "r2"):
            self.assertEqual(self.send_map(stage, name).status_code, 200)
        self.assertEqual(stage.box.stop(signal.SIGKILL), -signal.SIGKILL)
        number = int(min((runtime / "waiting").glob("map-*.cbor")).stem.removeprefix("map-"))
        (runtime / "waiting" / "at-work").write_text(f"{number} 2 0 1\nx")
        stage.restart_box()
        self.sees(stage, "queue_put_aside", "ask", "box", "message 1, r1's cloud: the service ended 3 times by a fault", panel=False)
        self.assertIsNone(self.alarm(stage, "messages_rejected"))
        stage.post.control("DELETE /faults")
        wait_until(lambda: [request["message"]["name"] for request in stage.post.requests("/map/update")
                            if request["status"] == 200] == ["r2"], "the other map")
        self.assertEqual(stage.box.stop(), 0)
        stage.restart_box()
        self.sees(stage, "queue_put_aside", "ask", "box", "r1's cloud", panel=False)
        self.assertEqual([(row["robot"], row["status"]) for row in self.view(stage)["rejected"]], [("r1", 0)])
        self.assertEqual(stage.box.ask("POST /adit/rejected/1/send", body={})[0], 200)
        wait_until(lambda: [request["message"]["name"] for request in stage.post.requests("/map/update")
                            if request["status"] == 200] == ["r2", "r1"], "the map")
        self.goes(stage, "queue_put_aside")

    def test_maps_and_states_cannot_be_kept(self):
        """The runtime directory is a separate file system, as with systemd."""
        runtime = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-runtime-")))
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "adit-wire", runtime], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", runtime], check=False)
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=str(runtime)))
        stage = self.stage()
        filler = Filler(runtime)
        self.assertEqual(self.send_map(stage, "r1", 1, 100000).status_code, 503)
        self.sees(stage, "map_not_kept", "bad", "box", panel=False)
        robot = self.robot(stage, "r1")
        self.sees(stage, "state_not_kept", "bad", "box", panel=False)
        robot.quiet()
        filler.make_room()
        self.robot(stage, "r1")
        self.goes(stage, "state_not_kept")
        wait_until(lambda: self.send_map(stage, "r1", 1).status_code == 200, "a map to be taken")
        self.goes(stage, "map_not_kept")
