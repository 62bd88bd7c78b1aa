"""No output of the real program contains a secret, wherever it was typed: real_outputs.py ADITD. On loopback. The routes come from
/adit/openapi.json, so new routes are tested too."""

import contextlib
import gzip
import http.client
import io
import json
import pathlib
import re
import subprocess
import tarfile
import tempfile
import unittest
import urllib.parse

import command_post
import real_aditd
from patience import patient
from real_aditd import wait_until
from real_settings import grid, state

HERE = pathlib.Path(__file__).resolve().parents[2]
SCORING = "scoring-" + "5c0f1e9a" * 8  # longer than a sentence quotes
MAPPING = 'mapp"ing\\' + "7d31b2"  # JSON, CSV and metrics write it otherwise
TEAM = "t3am_9f2c1"  # as a robot may be called
CODE = "31415926"
OPERATOR, VIEWER = "an operator, 91c4", "a viewer who looks, 3f0b"
WRONG_TOKEN, WRONG_PASSWORD = "an-0ld-token-4b8e7", "an untrue password"
CUT = 12  # so much of a secret's beginning tells it
TYPED = f"{SCORING} {MAPPING} {TEAM} {CODE}"
STRUCK = "[token] [token] [token] [token]"
MARKER = {"ns": TYPED, "id": 1, "type": 9, "action": 0, "text": TYPED, "mesh_resource": TYPED,
          "header": {"stamp": 1.0, "frame_id": "darpa"}, "color": {"r": 1, "g": 1, "b": 1, "a": 1},
          "scale": {"x": 1, "y": 1, "z": 1},
          "pose": {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}}


def written(secret):
    """The forms in which outputs write the secret, up to the place where a sentence may be cut."""
    in_json = json.dumps(secret)[1:-1]
    return {form[:CUT].encode() for form in (secret, in_json, json.dumps(in_json)[1:-1], secret.replace('"', '""'),
                                             urllib.parse.quote(secret))}


class Talkative(command_post.CommandPost):
    """A Command Post whose answers contain the other side's secrets, and which accepts no state."""

    def _handler(self):
        class Handler(super()._handler()):
            def do_GET(self):
                self.answer(200, {"score": 0, "remaining_reports": 25, "current_team": TYPED, "run_clock": 12.5})

            def do_POST(self):
                if self.path == "/api/artifact_reports":
                    return self.answer(201, {
                        "url": TYPED, "id": 1, "x": 1.0, "y": 2.0, "z": 3.0, "type": "Drill", "run": TYPED, "team": TYPED,
                        "submitted_datetime": "2026-01-01T00:00:00Z", "run_clock": 12.5, "report_status": TYPED,
                        "score_change": 1})
                if self.path == "/state/update":
                    return self.answer(422, f"no state for {TYPED}")
                return self.answer(200, None)

        return Handler


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        real_aditd.TOKENS.update(scoring=SCORING, mapping=MAPPING, team=TEAM)
        cls.post = Talkative()
        cls.addClassCleanup(cls.post.close)
        real_aditd.NOWHERE.update(cls.post.address)
        folder = tempfile.TemporaryDirectory(prefix="adit-outputs-")
        cls.addClassCleanup(folder.cleanup)
        cls.box = box = real_aditd.Box(folder.name, label=CODE)
        cls.addClassCleanup(lambda: box.process.wait())
        cls.addClassCleanup(lambda: box.process.kill())
        cls.own = []  # what the box gave to one alone: cookies
        cls.script = {"Authorization": f"Bearer {TEAM}"}
        cls.type_all_into_wrong_places(box)
        cls.in_turn("POST /adit/password", {"role": "operator", "code": CODE, "password": OPERATOR})
        operator = cls.log_in(OPERATOR)
        cls.in_turn("POST /adit/password", {"role": "viewer", "current": OPERATOR, "password": VIEWER}, **operator)
        cls.type_all_into_wrong_places(box)

    @classmethod
    def in_turn(cls, request, body, **headers):
        """Shows a password, once the limit of guesses allows it. Returns the answer."""
        def ask():
            answer = cls.box.ask(request, body, **headers)
            return answer if answer[0] != 429 else None
        status, said, told = wait_until(ask, "a turn among those who guess passwords", 60)
        assert status == 200, said
        return said, told

    @classmethod
    def log_in(cls, password):
        """The headers of a browser whose name contains the secrets."""
        said, headers = cls.in_turn("POST /adit/login", {"password": password}, User_Agent=TYPED)
        cookies = [each.partition(";")[0] for each in headers.get_all("Set-Cookie")]
        cls.own += [cookie.partition("=")[2] for cookie in cookies]
        return {"Cookie": "; ".join(cookies), "Adit_CSRF": said["csrf"]}

    @classmethod
    def type_all_into_wrong_places(cls, box):
        before = cls.refused(box) if (box.state / "access.json").exists() else 0
        assert box.ask("POST /api/artifact_reports", {"x": 1, "y": 2, "z": 3, "type": "Drill"}, **cls.script)[0] == 201
        for word in (SCORING, MAPPING, TEAM, CODE, TYPED):
            box.ask("POST /api/artifact_reports", {"x": 1, "y": 2, "z": 3, "type": word}, **cls.script)
            box.ask("POST /map/update", {**grid("r1"), "type": word}, **cls.script)
            box.ask("POST /markers/update", {"markers": [{**MARKER, "type": word}]}, **cls.script)
            box.ask("POST /markers/update", {"markers": [MARKER]}, **{**cls.script, "Content-Encoding": word})
            box.ask("POST /state/update", state(word), **cls.script)
            box.ask("POST /api/artifact_reports", {}, **{**cls.script, "Adit_Resubmit": word})
            box.ask("GET /" + urllib.parse.quote(word, safe=""), **cls.script)
            box.ask("POST /adit/login", {"password": word}, whence="127.0.0.9")
        assert box.ask("POST /markers/update", {"markers": [MARKER]}, **cls.script)[0] == 200
        assert box.ask("POST /state/update", state(TEAM), **cls.script)[0] == 200
        assert box.ask("POST /map/update", grid(TEAM), **cls.script)[0] == 200
        for _ in range(12):
            box.ask("POST /state/update", {}, whence="127.0.0.8", Authorization=f"Bearer {WRONG_TOKEN}")
        box.ask("GET /adit/run", whence="127.0.0.8", Authorization=f"Bearer {WRONG_TOKEN}")
        box.ask("POST /adit/login", {"password": WRONG_PASSWORD}, whence="127.0.0.8")
        wait_until(lambda: cls.refused(box) > before, "the Command Post's refusal of a state")
        wait_until(lambda: STRUCK in json.dumps(box.ask("GET /adit/markers", **cls.script)[1]), "the markers to be shown")

    @classmethod
    def refused(cls, box):
        rows = box.ask("GET /adit/run", **cls.script)[1]["activities"]
        return sum(row["refused_upstream"] for row in rows)

    def shows_none(self, what, output, but=()):
        if output[:2] == b"\x1f\x8b":
            with contextlib.suppress(tarfile.TarError):
                with tarfile.open(fileobj=io.BytesIO(output)) as archive:
                    for each in archive:
                        self.shows_none(f"{what}: {each.name}", archive.extractfile(each).read())
            output = gzip.decompress(output)
        secrets = {SCORING, MAPPING, TEAM, CODE, WRONG_TOKEN, WRONG_PASSWORD, OPERATOR, VIEWER, *self.own}
        for secret in secrets - set(but):
            for form in written(secret):
                at = output.find(form)
                if at >= 0:
                    self.fail(f"{what} shows {secret}: {output[max(at - 60, 0):at + 80]}")

    def raw(self, method, path, headers, body=None):
        """Status, head and body; of events only the first."""
        connection = http.client.HTTPConnection("127.0.0.1", self.box.port, timeout=patient(30))
        with contextlib.closing(connection):
            sent = {name.replace("_", "-"): value for name, value in headers.items()}
            if body is not None:
                sent["Content-Type"] = "application/json"
            connection.request(method, path, body, sent)
            answer = connection.getresponse()
            if answer.headers["Content-Type"] == "text/event-stream":
                lines = iter(answer.fp.readline, b"")
                return answer.status, answer.headers, b"".join(next(lines) for _ in range(6))
            return answer.status, answer.headers, answer.read()

    def as_each_role(self):
        yield "nobody", lambda: {}
        for role, password in (("viewer", VIEWER), ("operator", OPERATOR)):
            mine = {}

            def browser(mine=mine, password=password):
                if self.box.ask("GET /adit/session", **mine)[1]["role"] is None:
                    mine.update(self.log_in(password))
                return mine

            yield role, browser
        yield "script", lambda: self.script

    def routes(self):
        """Each method with its path to an existing object, and the same with a secret in each query parameter."""
        described = self.box.ask("GET /adit/openapi.json")[1]
        layer = self.box.ask("GET /adit/map", **self.script)[1]["layers"][0]
        values = {"number": 1, "session": 1, "kind": layer["kind"], "robot": TEAM, "level": 0, "x": 0, "y": 0,
                  "key": self.box.ask("GET /adit/runs", **self.script)[1]["runs"][0]["key"]}
        for path, methods in described["paths"].items():
            if path == "/adit/spare/standby":
                continue  # a box on standby has restarted and rejects most of what is asked here
            filled = re.sub(r"{(\w+)}", lambda it: str(values[it.group(1)]), path)
            for method, said in methods.items():
                queries = [each["name"] for each in said.get("parameters", []) if each["in"] == "query"]
                yield method.upper(), [filled] + [f"{filled}?{name}={urllib.parse.quote(TYPED)}" for name in queries]

    def test_no_route_shows_a_secret(self):
        asked = set()
        for role, headers in self.as_each_role():
            for method, targets in self.routes():
                bodies = [None] if method == "GET" else [json.dumps({TYPED: TYPED, "password": TYPED, "settings": TYPED}), TYPED]
                for target in targets:
                    for body in bodies:
                        status, head, said = self.raw(method, target, headers(), body)
                        what = f"{role}: {method} {target}: {status}"
                        but = self.own if "Set-Cookie" in head else ()
                        self.shows_none(what, str(head).encode(), but)
                        self.shows_none(what, said)
                        asked.add((role, method, target, status))
        for role, path in (("viewer", "/metrics"), ("viewer", "/adit/run"), ("viewer", "/adit/events"), ("viewer", "/adit/log"),
                           ("viewer", "/adit/markers"), ("viewer", "/adit/reports.csv"), ("operator", "/adit/bundle"),
                           ("viewer", "/adit/settings/export"), ("script", "/adit/map")):
            self.assertIn((role, "GET", path, 200), asked)

    def test_typed_secrets_are_redacted(self):
        self.assertIn(f"no state for {STRUCK}", json.dumps(self.box.ask("GET /adit/run", **self.script)[1]))

    def test_messages_to_the_command_post_are_not_redacted(self):
        heard = wait_until(lambda: self.post.heard("/markers/update"), "markers to go up")
        sent = b"".join(gzip.decompress(body) if body[:2] == b"\x1f\x8b" else body for _, body in heard)
        self.assertIn(SCORING.encode(), sent)

    def test_log_console_and_process_show_no_secret(self):
        self.shows_none("the log", self.box.log.read_bytes())
        process = pathlib.Path(f"/proc/{self.box.process.pid}")
        for file in ("cmdline", "environ", "comm", "status"):
            self.shows_none(file, (process / file).read_bytes())
        for task in (process / "task").iterdir():
            self.shows_none("a thread's name", (task / "comm").read_bytes())

    def test_errors_of_settings_quote_no_secret(self):
        with tempfile.TemporaryDirectory(prefix="adit-outputs-") as folder:
            settings = pathlib.Path(folder) / "settings.json"
            for word in (SCORING, MAPPING, TEAM, CODE):
                settings.write_text(json.dumps({"version": 1, "team": {"interface": f"{word} {word}"}, word: word}))
                ended = subprocess.run([real_aditd.aditd, "--settings", settings, "--secrets", self.box.folder / "secrets",
                                        "--state", folder], capture_output=True, timeout=patient(60))
                self.assertNotEqual(ended.returncode, 0)
                self.shows_none("why it does not start", ended.stdout + ended.stderr)

    def test_wrong_tokens_are_counted_and_logged_together(self):
        lines = self.box.output().count("requests with wrong tokens")
        self.assertTrue(1 <= lines <= 6, f"{lines}: one a minute")
        metrics = self.box.ask("GET /metrics", **self.script)[1].decode()
        self.assertGreaterEqual(float(re.search(r"^adit_wrong_tokens_total (\S+)$", metrics, re.M).group(1)), 26)

    def test_services_leave_no_core_dump(self):
        for unit in HERE.glob("services/*.service"):
            text = unit.read_text()
            if re.search(r"^ExecStart=\S*/adit", text, re.M):
                self.assertIn("\nLimitCORE=0\n", text, unit.name)

    def test_stored_files_are_private(self):
        self.assertEqual(self.box.state.stat().st_mode & 0o077, 0)
