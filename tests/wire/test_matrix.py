"""Every URI x format x compression x client style reaches the Command Post, and means there what its sender meant."""

import unittest

import hosts
import maps
import messages
import programs
from delivered import Delivered
from messages import Style

POSITION = {"x": 1.25, "y": -2.5, "z": 0.125}
TURNED = {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}


def setUpModule():
    hosts.needs_namespaces()


class Matrix(Delivered):
    """Against a Command Post that is strict; MatrixAsMeasured repeats it against one that behaves as the real ones do."""

    def check_map(self, source, style, name):
        update = messages.map_update(source, name, self.seconds, style)
        arrived = self.deliver("/map/update", update, style)
        update["name"] = name or ""
        sent = source.little_endian()
        self.same_map(arrived, update, sent.data, sent.head())  # zeros in an orientation have become the identity

    def test_maps_in_every_style(self):
        sources = [maps.made_grid(80, 60), maps.made_cloud(500, padding=4)]
        for number, style in enumerate(messages.styles()):
            for source in sources:
                name = (None, "", f"r{number}")[number % 3]
                with self.subTest(style=str(style), map=source.label, name=name):
                    self.check_map(source, style, name)

    def test_generated_maps(self):
        for source in maps.made():
            for style in (Style(), Style("cbor", "gzip")):
                with self.subTest(style=str(style), map=source.label):
                    self.check_map(source, style, "r1")

    def test_recorded_maps(self):
        found = maps.recorded()
        if not found:
            self.skipTest("ADIT_MAPS names no folder of recorded maps")
        for source in found:
            for style in (Style(), Style("json", "gzip"), Style("cbor"), Style("cbor", "gzip"),
                          Style("cbor", body="gzip", ros=True)):
                with self.subTest(style=str(style), map=source.label):
                    self.check_map(source, style, "replay")

    def test_states_in_every_style(self):
        for style in messages.text_styles():
            with self.subTest(style=str(style)):
                orientation = dict.fromkeys("xyzw", 0) if style.ros else TURNED
                update = {"header": messages.header(self.seconds, style),
                          "poses": [{"name": "r1", "position": POSITION, "orientation": orientation}]}
                if style.browser:
                    del update["header"]
                arrived = self.deliver("/state/update", update, style)
                self.assertEqual(arrived["header"]["frame_id"], "darpa")
                self.same(arrived["poses"], [{"name": "r1", "position": POSITION,
                                              "orientation": maps.IDENTITY if style.ros else TURNED}])

    def test_markers_in_every_style(self):
        for number, style in enumerate(messages.text_styles()):
            with self.subTest(style=str(style)):
                marker = {"header": messages.header(self.seconds, style), "ns": "comms", "id": number, "type": 2,
                          "action": 0, "pose": {"position": POSITION, "orientation": TURNED},
                          "scale": {"x": 1, "y": 2, "z": 3}, "color": {"r": 1, "g": 0.5, "b": 0, "a": 1},
                          "lifetime": {"secs": 2, "nsecs": 500000000} if style.ros else 2.5, "text": "n\u00f6de \u2714"}
                arrived = self.deliver("/markers/update", {"markers": [marker]}, style)["markers"][0]
                del arrived["header"]
                self.same(arrived, {key: value for key, value in marker.items() if key != "header"} | {"lifetime": 2.5}
                          | {"scale": {"x": 1.0, "y": 2.0, "z": 3.0}, "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0}})

    def test_markers_with_nothing_but_what_the_icd_asks_for(self):
        bare = {"type": 1, "action": 0, "pose": {"position": POSITION, "orientation": TURNED},
                "scale": {"x": 1, "y": 1, "z": 1}, "color": {"r": 0, "g": 0, "b": 1, "a": 1}}
        arrived = self.deliver("/markers/update", {"markers": [bare, {"action": 2, "ns": "a", "id": 3}]}, Style())
        first, second = arrived["markers"]
        self.assertEqual((first["ns"], first["id"], first["lifetime"], first["text"]), ("", 0, 0, ""))
        self.assertEqual((second["action"], second["ns"], second["id"]), (2, "a", 3))
        self.assertIn("pose", second)

    def test_reports_and_status_in_every_style(self):
        for number, style in enumerate(style for style in messages.text_styles() if style.format == "json"):
            with self.subTest(style=str(style)):
                report = {"x": 1011.242 + number, "y": -244.433, "z": 1e-7, "type": "Fire Extinguisher", "name": "r1"}
                answer = messages.post(self.session, self.stage.box.url, "/api/artifact_reports", report, style)
                self.assertEqual(answer.status_code, 201, answer.text)
                made = answer.json()
                for key in ("x", "y", "z", "type"):
                    self.assertEqual(made[key], report[key])
                self.assertEqual(made["report_status"], "scored")
                sent = self.stage.post.requests("/api/artifact_reports")[-1]
                self.assertEqual(sent["content_type"], "application/json")
                status = self.session.get(self.stage.box.url + "/api/status" + ("/" if style.browser else ""),
                                          headers=messages.headers(style), timeout=10)
                self.assertEqual(status.status_code, 200)
                self.assertIn("remaining_reports", status.json())

    def test_any_of_the_teams_tokens_is_good(self):
        for token in (programs.TEAM_TOKEN, programs.SCORING_TOKEN, programs.MAPPING_TOKEN):
            update = {"poses": [{"name": "r1", "position": POSITION, "orientation": TURNED}]}
            answer = messages.post(self.session, self.stage.box.url, "/state/update", update, Style(), token)
            self.assertEqual(answer.status_code, 200)


class MatrixAsMeasured(Matrix):
    post_options = ("--rate", "0", "--as-measured")
