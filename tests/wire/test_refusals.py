"""What the ICD forbids is refused to its sender at once with a status and a sentence that names the field, and never leaves. Here a row for
each URI; test_client_page.py has each field, and the rules are in tests/icd, tests/codec and tests/intake."""

import json
import unittest

import cbor2
import requests

import programs
from programs import Stage
from refused import GRID, MARKERS, STATE, changed
from reporting import REPORT

# (URI, message, field, value, words of the sentence)
ROWS = [
    ("/map/update", GRID, "msg.info.width", 79, ["msg.info.width", "79 x 60 = 4740", "4800"]),
    ("/state/update", STATE, "poses.0.name", "bad-name", ["poses[0].name", "10", "bad-name"]),
    ("/markers/update", MARKERS, "markers.0.points", [{"x": 1}], ["markers[0].points[0].y", "missing"]),
    ("/api/artifact_reports", REPORT, "type", "test", ["type", "test"]),
]


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stage = cls.enterClassContext(Stage())
        cls.session = requests.Session()

    def tearDown(self):
        sent = [request for request in self.stage.post.requests() if request["method"] == "POST"]
        self.assertEqual(sent, [], "nothing that was refused may leave")

    def send(self, uri, content, form="json", token=programs.TEAM_TOKEN):
        headers = {"Authorization": f"Bearer {token}", "Content-Type": f"application/{form}"}
        return self.session.post(self.stage.box.url + uri, data=content, headers=headers, timeout=20)

    def refused(self, answer, status, words=()):
        self.assertEqual(answer.status_code, status, answer.text)
        self.assertEqual(answer.headers["Content-Type"], "application/json")
        sentence = answer.json()
        self.assertIsInstance(sentence, str)
        for word in words:
            self.assertIn(word, sentence)

    def test_a_field_of_each_uri_by_its_name(self):
        for uri, message, path, value, words in ROWS:
            for form in ("json",) if uri.startswith("/api") else ("json", "cbor"):
                with self.subTest(uri=uri, format=form):
                    made = changed(message, path, value)
                    if form == "cbor" and uri == "/map/update":
                        made["msg"]["data"] = bytes(4800)
                    content = json.dumps(made).encode() if form == "json" else cbor2.dumps(made)
                    self.refused(self.send(uri, content, form), 422, words)

    def test_no_token_ever_shows(self):
        said = self.stage.box.said() + json.dumps(self.stage.box.ask("GET /adit/run"))
        for token in (programs.SCORING_TOKEN, programs.MAPPING_TOKEN, programs.TEAM_TOKEN):
            self.assertNotIn(token, said)
