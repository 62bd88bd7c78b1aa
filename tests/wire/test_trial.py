"""A Command Post is tested before it is used, while the run continues."""

import contextlib
import threading
import time
import unittest

import requests

import hosts
import maps
import messages
import programs
from messages import Style
from programs import CommandPost, Stage, wait_until

CBOR = Style("cbor")
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}
OTHER_PORT = 9000
TYPED = {"scoring": "typed-scoring-1", "mapping": "typed-mapping-1"}  # tokens that the box was never given


class Tried(unittest.TestCase):
    POST = ()

    def setUp(self):
        rates = {f"{kind}_hz": 1 for kind in ("reports", "status", "map", "state", "markers")}
        # 1.5 times Adit's rate. A request outside the pace would come too soon after the request before or too soon
        # before the next one, and a busy machine has a third of a second.
        self.stage = self.enterContext(Stage(post_options=("--rate", "1.5", *self.POST), command_post__rates=rates))
        self.box, self.post = self.stage.box, self.stage.post
        wait_until(self.box.knows_the_run, "the run to be known")
        self.addCleanup(lambda: self.assertEqual(self.violations(), []))

    def violations(self):
        """Violations, except for those of the test's own requests: an empty one, and one to a path that no Command Post has."""
        own = (["Missing field 'poses'"], ["URI is not recognized: POST /adit-test"], ["URI is not recognized: POST /adit-test/"])
        return [(uri, sentences) for uri, sentences in self.post.violations() if sentences not in own]

    def begin(self, body):
        status, said = self.box.ask("POST /adit/test", body=body)
        self.assertEqual(status, 200, said)

    def ended(self):
        def view():
            said = self.box.ask("GET /adit/test")[1]
            return None if said["running"] else said
        return wait_until(view, "the test to end")

    def tried(self, **body):
        """Runs a test. Returns its view, and each step by "scoring link"."""
        self.begin(body)
        view = self.ended()
        return view, {f"{endpoint['name']} {step['name']}": step
                      for endpoint in view["endpoints"] for step in endpoint["steps"]}

    def taken(self, uri):
        return [request for request in self.post.requests(uri) if request["status"] == 200]


class Trial(Tried):
    @contextlib.contextmanager
    def a_run(self):
        """Robots that post faster than the Command Post accepts."""
        ended = threading.Event()
        errors = []

        def robot():
            session = requests.Session()
            number = 0
            while not ended.wait(0.1):
                number += 1
                state = {"poses": [{"name": "r1", "position": {"x": number, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}
                grid = maps.made_grid(40, 40, seed=number)
                for uri, message in (("/state/update", state),
                                     ("/map/update", messages.map_update(grid, "r1", time.time(), CBOR))):
                    answer = messages.post(session, self.box.url, uri, message, CBOR)
                    if answer.status_code not in (200, 429):
                        errors.append((uri, answer.status_code, answer.text))

        thread = self.stage.network.made_in(self.stage.network.team, lambda: threading.Thread(target=robot))
        thread.start()
        try:
            wait_until(lambda: self.taken("/map/update") and self.taken("/state/update"), "the run to be under way")
            yield
        finally:
            ended.set()
            thread.join()
        self.assertEqual(errors, [])

    def flows_on(self):
        """After this call, states, maps and reports still arrive at the Command Post of the run."""
        before = {uri: len(self.taken(uri)) for uri in ("/state/update", "/map/update")}
        for uri, count in before.items():
            wait_until(lambda uri=uri, count=count: len(self.taken(uri)) > count + 1, f"{uri} to flow on")
        report = {"x": 1.0, "y": 2.0, "z": 3.0, "type": "Drill"}
        answer = requests.post(self.box.url + "/api/artifact_reports/", json=report, timeout=30,
                               headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"})
        self.assertEqual(answer.status_code, 201, answer.text)
        self.assertEqual(len(self.post.recorded()), 1, "and no other report was spent")

    def throttled(self, post):
        """Each request with the one before it at its URI: (URI, seconds, bytes, status)."""
        all_of_it = [(request["uri"], round(request["at"], 3), request["body_bytes"], request["status"])
                     for request in post.requests()]
        return [[one for one in all_of_it[:number + 1] if one[0] == each[0]][-3:]
                for number, each in enumerate(all_of_it) if each[3] == 429]

    def test_endpoints_of_the_run_are_tested_without_throttling_it(self):
        with self.a_run():
            for _ in range(4):
                view, steps = self.tried()
                self.assertTrue(view["applied"])
                for name in ("scoring token", "mapping token"):
                    self.assertEqual(steps[name]["state"], "good", steps)
            same = {"address": hosts.SCORING, "port": programs.PORT, "token": programs.SCORING_TOKEN}
            view, steps = self.tried(scoring=same)
            self.assertEqual((view["applied"], [each["name"] for each in view["endpoints"]]), (False, ["scoring"]))
            self.assertEqual(steps["scoring token"]["state"], "good", steps)
            self.flows_on()
        self.assertEqual(self.throttled(self.post), [])

    def other_post(self):
        """Another Command Post on the same machine, which accepts only the typed tokens."""
        folder = self.stage.folder / "elsewhere"
        folder.mkdir()
        programs.secrets_folder(folder / "secrets")
        for name, token in TYPED.items():
            (folder / "secrets" / f"{name}.token").write_text(token + "\n")
        post = CommandPost(self.stage.network, folder, "--rate", "1", name="other", port=OTHER_PORT, control_port=8003)
        self.addCleanup(post.stop)
        return post

    def there(self, **tokens):
        address = {"scoring": hosts.SCORING, "mapping": hosts.MAPPING}
        return {name: {"address": address[name], "port": OTHER_PORT, "token": tokens.get(name)} for name in address}

    def test_another_command_post_is_tested_beside_the_run(self):
        other = self.other_post()
        with self.a_run():
            view, steps = self.tried(**self.there())
            self.assertFalse(view["applied"])
            self.assertEqual(view["endpoints"][0]["address"], f"{hosts.SCORING}:{OTHER_PORT}")
            for name in TYPED:
                self.assertEqual((steps[f"{name} reach"]["state"], steps[f"{name} token"]["state"]), ("good", "bad"), steps)
            _, steps = self.tried(**self.there(**TYPED))
            for name in TYPED:
                self.assertEqual(steps[f"{name} token"]["state"], "good", steps)
            self.flows_on()
        self.assertEqual(self.throttled(self.post), [])
        self.assertEqual(other.recorded(), [], "nothing is spent there")
        self.assertEqual({request["uri"] for request in other.requests()}, {"/api/status", "/state/update", "/adit-test"})
        in_use = self.box.ask("GET /adit/settings")[1]["settings"]["command_post"]
        self.assertEqual(in_use["scoring"], {"address": hosts.SCORING, "port": programs.PORT}, "nothing is applied")

class ThatWantsASlash(Tried):
    POST = ("--slash",)

    def test_receives_everything_and_each_report_once(self):
        _, steps = self.tried()
        for name in ("scoring token", "mapping token"):
            self.assertEqual(steps[name]["state"], "good", steps)
        session = requests.Session()
        state = {"poses": [{"name": "r1", "position": {"x": 1.0, "y": 0.0, "z": 0.0}, "orientation": TURNED}]}
        for uri, message in (("/state/update", state),
                             ("/map/update", messages.map_update(maps.made_grid(40, 40, seed=1), "r1", time.time(), CBOR))):
            self.assertEqual(messages.post(session, self.box.url, uri, message, CBOR).status_code, 200)
            wait_until(lambda uri=uri: self.taken(uri + "/"), f"{uri} to arrive")
        report = {"x": 1.0, "y": 2.0, "z": 3.0, "type": "Drill"}
        answer = requests.post(self.box.url + "/api/artifact_reports", json=report, timeout=programs.patient(30),
                               headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"})
        self.assertEqual(answer.status_code, 201, answer.text)
        self.assertEqual(len(self.post.recorded()), 1)
        redirected = [request["uri"] for request in self.post.requests() if request["status"] in (301, 308)]
        self.assertEqual(sorted(redirected), ["/api/status", "/api/status", "/map/update", "/state/update", "/state/update"],
                         "once by the run and once by the test, and no report")
        self.assertIn("the Command Post wants a slash at the end of paths", self.box.output())
