"""Settings are saved while six robots upload maps, a client waits for its report and a page is open: a saved setting restarts
what it changes, and nothing else. Nobody is cut, and all arrives. The parts by themselves are in tests/gateway/listeners_test and
forward/scoring_endpoint_test."""

import contextlib
import http.client
import threading
import time
import unittest

import maps
import messages
import programs
from messages import Style
from programs import PORT, TEAM_TOKEN, CommandPost, Stage, wait_until
from reporting import another, began, submit

CBOR = Style("cbor")
OTHER_PORT = 8010
SECOND_PORT = 8020  # at which the box listens, too
PIECES = 40  # of an upload
SLOW = {"command_post__rates__reports_hz": 0.02}  # the second report waits for it to be raised


class Upload(threading.Thread):
    """A map that goes up in pieces, the last of them when the test says so."""

    def __init__(self, stage, name, port=PORT):
        super().__init__()
        update = messages.map_update(maps.made_cloud(2000, seed=int(name[1:])), name, time.time(), CBOR)
        self.body = messages.body(update, CBOR)
        self.address = stage.network.box_address, port
        self.begun, self.may_end = threading.Event(), threading.Event()
        self.status = None

    def run(self):
        connection = http.client.HTTPConnection(*self.address, timeout=60)
        with contextlib.closing(connection), contextlib.suppress(OSError, http.client.HTTPException):
            connection.putrequest("POST", "/map/update")
            for name, value in (("Authorization", f"Bearer {TEAM_TOKEN}"), ("Content-Type", "application/cbor"),
                                ("Content-Length", str(len(self.body)))):
                connection.putheader(name, value)
            connection.endheaders()
            size = len(self.body) // PIECES
            for at in range(0, len(self.body), size):
                if at + size >= len(self.body):
                    self.may_end.wait()
                connection.send(self.body[at:at + size])
                self.begun.set()
                time.sleep(0.01)
            self.status = connection.getresponse().status


class Report(threading.Thread):
    """A client that posts a report and waits."""

    def __init__(self, stage, report):
        super().__init__()
        self.stage, self.report, self.status = stage, report, None

    def run(self):
        with contextlib.suppress(OSError):
            self.status = submit(self.stage, self.report).status_code


class Page:
    """An open page: its events must go on."""

    def __init__(self, stage):
        self.connection = http.client.HTTPConnection(stage.network.box_address, PORT, timeout=10)
        self.connection.request("GET", "/adit/events", headers={"Authorization": f"Bearer {TEAM_TOKEN}"})
        self.answer = self.connection.getresponse()

    def hears(self):
        """Whether one more event comes."""
        try:
            while line := self.answer.readline():
                if line.startswith(b"data:"):
                    return True
        except OSError:
            pass
        return False


class InPlace(unittest.TestCase):
    def stage(self, **overrides):
        return began(self.enterContext(Stage(reports__answer_within_ms=60000, **overrides)))

    def at_work(self, stage):
        uploads = [Upload(stage, f"r{number}") for number in range(6)]
        for upload in uploads:
            upload.start()
        for upload in uploads:
            self.assertTrue(upload.begun.wait(30))
        return uploads

    def report_that_waits(self, stage):
        """Behind one that was just answered."""
        self.assertEqual(submit(stage, another(1)).status_code, 201)
        report = Report(stage, another(2))
        report.start()
        wait_until(lambda: [row["state"] for row in stage.box.reports()] == ["answered", "queued"], "it to wait")
        return report

    def all_are_taken(self, uploads):
        for upload in uploads:
            upload.may_end.set()
        for upload in uploads:
            upload.join()
        self.assertEqual([upload.status for upload in uploads], [200] * len(uploads))

    def arrived(self, *posts):
        return {request["message"]["name"] for post in posts for request in post.requests("/map/update")
                if request["status"] == 200}

    def test_a_saved_setting_cuts_nobody(self):
        stage = self.stage(**SLOW)
        other = self.enterContext(contextlib.closing(Closing(stage))).post
        page, report, uploads = Page(stage), self.report_that_waits(stage), self.at_work(stage)
        listened = stage.box.said().count(" listening ")

        def nearer(settings):
            settings["reports"]["near_metres"] = 7

        def robots(settings):
            settings["robots"] = [{"name": f"r{number}"} for number in range(6)]

        def listener(settings):
            settings["team"]["listen"].append({"address": stage.network.box_address, "port": SECOND_PORT})

        def mapping(settings):
            settings["command_post"]["mapping"]["port"] = OTHER_PORT

        def bounds(settings):
            settings["team"]["connections_per_address"] = 20

        def rate(settings):
            settings["command_post"]["rates"]["map_hz"] = 50

        for change in (nearer, robots, listener, mapping, bounds, rate):
            stage.box.save(change)
            self.assertTrue(page.hears(), change.__name__)
        self.assertEqual(stage.box.said().count(" listening "), listened + 3, "one is new, and both have other bounds")
        second = Upload(stage, "r6", SECOND_PORT)
        second.start()
        self.all_are_taken([*uploads, second])
        wait_until(lambda: len(self.arrived(stage.post, other)) == 7, "all maps")
        self.assertEqual(len(self.arrived(other)), 7, "they went where the settings say by now")
        self.assertIsNone(report.status, "it waits still")

        def quicker(settings):
            settings["command_post"]["rates"]["reports_hz"] = 200

        stage.box.save(quicker)
        report.join()
        self.assertEqual(report.status, 201)
        self.assertEqual(len(stage.post.recorded()), 2)
        self.assertEqual(stage.post.violations() + other.violations(), [])

    def test_what_cannot_be_listened_at_is_reverted_and_cuts_nobody(self):
        stage = self.stage(**SLOW)
        page, report, uploads = Page(stage), self.report_that_waits(stage), self.at_work(stage)

        def nowhere(settings):
            settings["team"]["listen"].append({"address": "192.0.2.1", "port": PORT})
            settings["reports"]["near_metres"] = 9

        stage.box.save(nowhere)
        self.assertIn("settings_not_changed", stage.box.alarms())
        held = stage.box.ask("GET /adit/settings")[1]["settings"]
        self.assertEqual((len(held["team"]["listen"]), held["reports"]["near_metres"]), (1, 5))
        self.assertTrue(page.hears())
        self.all_are_taken(uploads)

        def quicker(settings):
            settings["command_post"]["rates"]["reports_hz"] = 200

        stage.box.save(quicker)
        self.assertNotIn("settings_not_changed", stage.box.alarms())
        report.join()
        self.assertEqual(report.status, 201)


class Closing:
    """A Command Post at other ports, beside the stage's."""

    def __init__(self, stage):
        self.post = CommandPost(stage.network, stage.folder, "--rate", "0", name="other", port=OTHER_PORT,
                                control_port=programs.CONTROL_PORT + 1)

    def close(self):
        self.post.process.kill()
        self.post.process.wait()
