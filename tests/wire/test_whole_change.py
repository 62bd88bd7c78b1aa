"""Changes of the box's addresses and the test of its links, requested by an operator."""

import contextlib
import http.client
import json
import threading

import hosts
import networkd
import programs
from changes import Change, NEW
from programs import wait_until


class WholeBox(Change):
    """aditd makes requests, adit-network carries them out; the team's host uses the page."""

    def setUp(self):
        self.stage = self.enterContext(programs.Stage(network__confirm_within_ms=20000, **{
            "team__listen": [{"address": "0.0.0.0", "port": programs.PORT}]}))
        self.network, self.folder = self.stage.network, self.stage.folder / "network"
        self.folder.mkdir()
        self.stage.folder.chmod(0o755)
        self.box = networkd.AditNetwork(self.network, self.folder)
        self.addCleanup(self.box.stop)
        self.box.wanted = self.stage.folder / "state"
        self.assertEqual(self.box.run(), 0, self.box.output())
        self.confirm_first()
        self.stage.box.stop()
        self.stage.restart_box()
        self.stopping = threading.Event()
        self.units = threading.Thread(target=self.path_unit)
        self.units.start()
        self.addCleanup(self.units.join)
        self.addCleanup(self.stopping.set)

    def path_unit(self):
        """Starts adit-network as adit-network.path does."""
        while not self.stopping.wait(0.05):
            if any((self.box.wanted / name).exists() for name in networkd.ASKED):
                self.box.start()
                while self.box.process.poll() is None and not self.stopping.wait(0.05):
                    pass

    def post(self, path, body=None, at="192.168.7.11"):
        """The status and the parsed JSON of its answer."""
        connection = http.client.HTTPConnection(at, programs.PORT, timeout=30)
        with contextlib.closing(connection):
            connection.request("POST", path, json.dumps(body or {}), {
                "Authorization": f"Bearer {programs.TEAM_TOKEN}", "Content-Type": "application/json"})
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read())

    def shown(self):
        return self.stage.box.ask("GET /adit/network")[1]

    def test_change_is_checked_applied_and_confirmed_from_the_new_address(self):
        self.assertTrue(self.shown()["managed"], self.shown())
        wanted = self.box.numbers(team="192.168.8.11")
        _, verdict = self.post("/adit/network/check", wanted)
        self.assertEqual(verdict["errors"], [])
        self.assertIn("this cuts you off", verdict["warnings"][0])
        self.assertEqual(verdict["changes"], [{"path": "team.address", "from": "192.168.7.11", "to": "192.168.8.11"}])
        status, view = self.post("/adit/network", wanted)
        self.assertEqual((status, view["pending"]["page"]), (200, "http://192.168.8.11:8000"))
        self.has(NEW)
        hosts.ip("-n", self.network.team, "address", "add", "192.168.8.12/24", "dev", "eth0")
        self.network.box_address = "192.168.8.11"
        wait_until(lambda: self.shown()["pending"], "the change to wait")
        self.assertIn("network_change", self.stage.box.alarms())
        self.assertEqual(self.post("/adit/network", wanted, "192.168.8.11")[0], 409)
        status, _ = self.post("/adit/network/confirm", at="192.168.8.11")
        self.assertEqual(status, 200)
        wait_until(lambda: self.shown()["last"] == "confirmed", "the change to be confirmed")
        self.assertIsNone(self.shown()["pending"])
        self.assertNotIn("network_change", self.stage.box.alarms())

    def steps(self):
        """Runs a test. Returns all steps by "scoring link", once it has ended."""
        self.assertEqual(self.post("/adit/test")[0], 200)
        wait_until(lambda: not self.stage.box.ask("GET /adit/test")[1]["running"], "the test to end")
        return {f"{endpoint['name']} {step['name']}": step
                for endpoint in self.stage.box.ask("GET /adit/test")[1]["endpoints"] for step in endpoint["steps"]}

    def states(self, steps):
        return {name: step["state"] for name, step in steps.items()}

    def test_self_test_passes_and_uses_no_report(self):
        steps = self.steps()
        self.assertEqual({name: state for name, state in self.states(steps).items() if state == "bad"}, {}, steps)
        for name in ("link", "address", "cables", "reach", "token"):
            self.assertEqual((steps[f"scoring {name}"]["state"], steps[f"mapping {name}"]["state"]), ("good", "good"), steps)
        self.assertEqual(self.stage.post.recorded(), [])

    def test_self_test_finds_a_conflict_and_a_missing_server(self):
        hosts.ip("-n", self.network.post, "address", "add", "10.100.1.10/24", "dev", "eth0")
        steps = self.steps()
        self.assertEqual(steps["scoring address"]["state"], "bad", steps)
        hosts.ip("-n", self.network.post, "address", "delete", "10.100.1.10/24", "dev", "eth0")
        self.stage.post.stop()
        steps = self.steps()
        self.assertEqual(steps["scoring reach"]["state"], "bad")
        self.assertEqual(steps["scoring token"]["state"], "skipped")
        self.network.pull_cable()
        self.assertEqual(self.steps()["mapping link"]["state"], "bad")
