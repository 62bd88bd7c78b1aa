"""Setting up the real program by its API: real_settings.py ADITD. On loopback."""

import base64
import contextlib
import json
import re
import signal
import socket
import stat
import tempfile
import unittest

import command_post
import real_aditd
from patience import patient
from ports import free_port
from real_aditd import wait_until

TEAM = {"Authorization": f"Bearer {real_aditd.TOKENS['team']}"}
REPORT = {"type": "Drill", "x": 1.0, "y": 2.0, "z": 3.0}


def grid(name):
    pose = {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
    return {"name": name, "type": "OccupancyGrid", "msg": {
        "header": {"stamp": 1.0, "frame_id": "darpa"},
        "info": {"resolution": 1.0, "width": 2, "height": 2, "origin": pose},
        "data": base64.b64encode(bytes([0, 100, 255, 0])).decode()}}


def state(name):
    return {"header": {"stamp": 1.0, "frame_id": "darpa"}, "poses": [
        {"name": name, "position": {"x": 1, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}]}


class SetUp(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="adit-set-up-")
        self.addCleanup(folder.cleanup)
        self.box = real_aditd.Box(folder.name)
        self.addCleanup(lambda: self.box.process.wait())
        self.addCleanup(lambda: self.box.process.kill())
        self.assertEqual(self.box.set_first()[0], 200)
        self.me = self.box.log_in()

    def post_office(self):
        post = command_post.CommandPost()
        self.addCleanup(post.close)
        return post

    def settings(self):
        status, said, _ = self.box.ask("GET /adit/settings", **self.me)
        self.assertEqual(status, 200, said)
        return said

    def applied(self, request, body):
        """Requests a change, and waits until it is applied, at any port."""
        status, said, _ = self.box.ask(request, body, **self.me)
        self.assertEqual(status, 200, said)
        wait_until(self.is_applied, "the change to be applied")
        return said

    def listens_at(self):
        return int(re.findall(r"listening .*port=(\d+)", self.box.output())[-1])

    def is_applied(self):
        self.box.port = self.listens_at()
        try:
            status, said, _ = self.box.ask("GET /adit/settings", **self.me)
        except OSError:
            return False
        if self.box.port != self.listens_at():  # asked at the old one, which answered what it held
            return False
        return status == 401 or not said["applying"]  # a reset ends all sessions

    def change(self, edit):
        """Changes the settings with `edit`. Returns the answer's list of changes."""
        now = self.settings()
        edit(now["settings"])
        return self.applied("POST /adit/settings", {"settings": now["settings"], "base": now["tag"]})["changes"]

    def alarms(self):
        """The ids of alarms that call the operator, without those of the Command Post, which does not exist here."""
        return {alarm["id"] for alarm in self.box.ask("GET /adit/run", **self.me)[1]["alarms"]
                if alarm["severity"] != "wait" and not alarm["id"].startswith("command_post_")}

    def course(self, name, post, **more):
        def edit(settings):
            settings["courses"].append({"name": name, "scoring": post.address, "mapping": post.address})
            settings.update(more)
        self.change(edit)

    def test_change_of_port_keeps_sessions(self):
        port, old = free_port(), self.box.port
        changes = self.change(lambda settings: settings["team"]["listen"][0].update(port=port))
        self.assertEqual(changes, [{"path": "team.listen[0].port", "from": 0, "to": port}])
        wait_until(lambda: self.is_applied() and self.box.port == port, "the box at its new port")
        self.assertTrue(self.settings()["saved"])
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", old), 20)
        file = self.box.state / "settings.json"
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        self.assertFalse((self.box.state / "settings.json.before").exists(), "it has proven itself")
        for ends in (signal.SIGTERM, signal.SIGKILL):
            self.box.process.send_signal(ends)
            self.box.process.wait(patient(30))
            self.box.start()
            self.assertEqual(self.box.port, port, ends)
            self.assertEqual(self.box.ask("POST /adit/settings/check", {"settings": {}}, **self.me)[0], 200, ends)
        sessions = self.box.state / "sessions.json"
        self.assertEqual(stat.S_IMODE(sessions.stat().st_mode), 0o600)
        self.assertEqual(self.box.ask("POST /adit/logout", {}, **self.me)[0], 200)
        self.box.process.kill()
        self.box.process.wait()
        self.box.start()
        self.assertEqual(self.box.ask("GET /adit/run", **self.me)[0], 401, "who logged out stays so, too")

    def test_change_during_a_run_keeps_picture_and_rate_and_repeats_no_report(self):
        post = self.post_office()
        self.course("A", post)
        self.applied("POST /adit/course", {"name": "A"})
        self.assertEqual(self.box.ask("POST /map/update", grid("ugv1"), **TEAM)[0], 200)
        drawn = wait_until(lambda: self.box.ask("GET /adit/map", **self.me)[1]["layers"], "the picture")
        self.assertEqual(self.box.ask("POST /api/artifact_reports", REPORT, **TEAM)[0], 201)
        self.change(lambda settings: settings["reports"].update(near_metres=6))
        self.assertEqual(self.box.ask("GET /adit/map", **self.me)[1]["layers"], drawn)
        self.assertEqual(self.box.ask("POST /api/artifact_reports", REPORT, **TEAM)[0], 201, "the answer that is kept")
        self.assertEqual(self.box.ask("POST /api/artifact_reports", {**REPORT, "x": 5.0}, **TEAM)[0], 201)
        first, second = post.times("/api/artifact_reports")
        self.assertGreaterEqual(second - first, 0.5, "a second, less what the first one's note of it took")
        self.assertEqual(self.alarms(), set())

    def test_first_change_is_reverted_to_given_settings_after_a_power_cut(self):
        self.box.stop()
        given = json.loads((self.box.folder / "settings.json").read_text())
        with contextlib.closing(socket.create_server(("127.0.0.1", 0))) as taken:
            given["team"]["listen"][0]["port"] = taken.getsockname()[1]
            (self.box.state / "settings.json").write_text(json.dumps(given))
            (self.box.state / "settings.json.before").write_text("none\n")
            self.box.start()
        self.assertEqual(self.alarms(), {"settings_not_changed"})
        self.assertFalse(self.settings()["saved"])
        self.assertFalse((self.box.state / "settings.json").exists())

    def test_unreadable_file_puts_the_box_on_standby_until_it_is_readable(self):
        self.change(lambda settings: settings["reports"].update(near_metres=7))
        for name, what in (("settings.json", "the saved settings or tokens"), ("access.json", "the passwords"),
                           ("stamps", "the last time stamps")):
            file, elsewhere = self.box.state / name, self.box.state / "elsewhere"
            wait_until(file.exists, name)
            self.box.stop()
            file.rename(elsewhere)
            file.mkdir()
            self.box.start()
            self.assertEqual(self.alarms(), {"standby"})
            said = f"this box is on standby: {what} cannot be read: {file}: is not a regular file; it accepts and sends no messages"
            self.assertEqual(self.box.ask("POST /state/update", state("ugv1"), **TEAM)[:2], (503, said))
            self.assertEqual(self.box.ask("GET /adit/session")[1]["first_start"], False)
            file.rmdir()
            elsewhere.rename(file)
            wait_until(lambda: self.is_applied() and not self.alarms(), "the end of the standby")
        self.assertEqual(self.settings()["settings"]["reports"]["near_metres"], 7)

    def test_unreadable_ledger_is_awaited_until_the_operator_replaces_it(self):
        ledger, elsewhere = self.box.state / "ledger", self.box.state / "elsewhere"
        lost = {"ledger_damaged", "report_lost:1", "run_unreliable"}
        self.assertEqual(self.box.ask("POST /adit/reports", REPORT, **self.me)[:2], (202, {"report": 1}))
        self.assertEqual(self.box.ask("POST /adit/ledger/new", {}, **self.me)[:2],
                         (409, "the ledger can be read; aditd begins no other"))
        for begins_another in (False, True):
            self.box.stop()
            ledger.rename(elsewhere)
            ledger.write_text("no directory")
            self.box.start()
            self.assertEqual(self.alarms(), {"ledger_unwritable"})
            self.assertEqual(self.box.ask("POST /adit/reports", REPORT, **self.me)[0], 409)
            if begins_another:
                self.applied("POST /adit/ledger/new", {})
                self.assertEqual((self.box.state / "ledger.damaged-1").read_text(), "no directory")
            else:
                ledger.unlink()
                elsewhere.rename(ledger)
            wait_until(lambda: self.is_applied() and "ledger_unwritable" not in self.alarms(), "a ledger that can be read")
            self.assertEqual(self.alarms(), lost if begins_another else set())
        self.assertEqual(self.box.ask("POST /adit/reports", REPORT, **self.me)[:2], (202, {"report": 2}), "in the same boot the last number is known")

    def test_alias_becomes_the_name_and_an_unknown_robot_is_accepted_and_reported(self):
        post = self.post_office()
        robots = [{"name": "ugv1", "alias": "husky-number-1"}, {"name": "ugv2", "alias": ""}]
        self.course("A", post, robots=robots)
        self.applied("POST /adit/course", {"name": "A"})
        self.assertEqual(self.box.ask("POST /map/update", grid("husky-number-1"), **TEAM)[0], 200)
        self.assertEqual(self.box.ask("POST /state/update", state("husky-number-1"), **TEAM)[0], 200)
        for path in ("/map/update", "/state/update"):
            body = wait_until(lambda path=path: post.heard(path), path)[0][1]
            self.assertIn(b"ugv1", body)
            self.assertNotIn(b"husky", body)
        self.assertEqual(self.alarms(), set())
        self.assertEqual(self.box.ask("POST /state/update", state("x"), **TEAM)[0], 200)
        self.assertEqual(self.box.ask("POST /state/update", state("x"), **TEAM)[0], 200)
        self.assertEqual(self.alarms(), {"robot_unknown:x"})
        self.assertEqual(self.box.output().count("unknown robot"), 1)
        self.assertEqual(self.box.ask("POST /state/update", state("husky-number-9"), **TEAM)[0], 422, "the ICD's rule")
