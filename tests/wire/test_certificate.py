"""The page's certificate: adit-certificate makes it on aditd's request, an operator replaces it over TLS, and browsers are sent to
HTTPS. What is rejected: applier/certificates_test."""

import contextlib
import hashlib
import json
import re
import ssl
import subprocess
import threading
import time
import unittest

import requests

import programs
import stunnel
import test_spare
from programs import BIN, wait_until
from reporting import QUICK, began, submit

BEARER = {"Authorization": f"Bearer {programs.TEAM_TOKEN}"}
FILE = {**BEARER, "Content-Type": "application/octet-stream"}


def fingerprint(der):
    return ":".join(re.findall("..", hashlib.sha256(der).hexdigest().upper()))


class Unit:
    """Plays adit-certificate.path and its service for a box."""

    def __init__(self, box):
        self.box, self.is_over = box, threading.Event()
        self.run()
        self.watcher = threading.Thread(target=self.watch)
        self.watcher.start()

    def run(self):
        status = self.box.state / "certificate"
        subprocess.run([BIN / "adit-certificate", "--state", self.box.state, "--status", status], check=True, timeout=60, capture_output=True)
        if (status / "restart").exists():
            (status / "restart").unlink()
            time.sleep(1)  # as the service does, so that an upload over TLS gets its answer
            self.box.serve_tls(self.box.state / "tls.pem")

    def watch(self):
        while not self.is_over.wait(0.05):
            if (self.box.state / "certificate.json").exists():
                self.run()

    def stop(self):
        self.is_over.set()
        self.watcher.join()


def shown(box):
    return box.ask("GET /adit/certificate")[1]


def certificate_of(box):
    """The view of the box's certificate, once it has one and the TLS server uses it."""
    view = wait_until(lambda: shown(box)["offered"] and shown(box), "the box to have a certificate")
    wait_until(lambda: fingerprint(ssl.PEM_cert_to_DER_cert(box.certificate.read_text())) == view["fingerprint"], "the TLS server to use it",
               tolerates=ValueError)  # while it is being written
    return view


class Certificate(unittest.TestCase):
    def setUp(self):
        stunnel.needs_stunnel()
        self.stage = self.enterContext(stunnel.SecureStage())
        self.box = self.stage.box
        self.addCleanup(Unit(self.box).stop)
        self.first = certificate_of(self.box)

    def upload(self, text):
        return requests.post(f"{self.box.secure_url}/adit/certificate", text, headers=FILE, timeout=60, verify=str(self.box.certificate))

    def test_fingerprint_is_that_of_the_certificate(self):
        self.assertEqual(self.first["fingerprint"], fingerprint(ssl.PEM_cert_to_DER_cert((self.box.state / "tls.pem").read_text().split(
            "-----END PRIVATE KEY-----\n")[1])))
        self.assertEqual((self.box.state / "tls.pem").stat().st_mode & 0o777, 0o600)
        wait_until(lambda: self.box.ask("GET /adit/run")[1]["certificate"] == self.first["fingerprint"], "the run's view to have it")

    def test_operator_replaces_the_certificate_over_tls_alone(self):
        pem = (self.stage.folder / "tls.pem").read_text()
        self.assertEqual(requests.post(f"{self.box.url}/adit/certificate", pem, headers=FILE, timeout=60).status_code, 409)
        by_adit = subprocess.run([BIN / "adit", "certificate", "set", self.stage.folder / "tls.pem", "--at", f"{self.box.network.box_address}:8000",
                                  "--token-file", self.stage.folder / "secrets/team.token"], capture_output=True, text=True, check=False, timeout=60)
        self.assertIn("by HTTPS", by_adit.stderr)
        wrong = self.upload(pem.split("-----BEGIN CERT", 1)[0])
        self.assertEqual((wrong.status_code, "no certificate" in wrong.json()), (422, True), wrong.text)
        self.assertEqual(shown(self.box), self.first)
        answer = self.upload(pem)
        self.assertEqual(answer.status_code, 200, answer.text)
        certificate_of(self.box)
        with self.box.connect() as client:
            self.assertEqual(answer.json()["fingerprint"], fingerprint(client.getpeercert(binary_form=True)))
        self.assertNotIn("PRIVATE", self.box.output())
        self.assertFalse((self.box.state / "certificate.pem").exists())

    def test_browsers_are_sent_to_https_and_others_are_not(self):
        view = self.box.ask("GET /adit/settings")[1]
        wanted = {"settings": {**view["settings"], "page": {"https_only": True}}, "base": view["tag"]}
        self.assertEqual(self.box.ask("POST /adit/settings", body=wanted)[0], 200)
        browser = lambda path: requests.get(self.box.url + path, timeout=30, allow_redirects=False)  # noqa: E731
        wait_until(lambda: browser("/").status_code == 308, "the setting to be in use")
        self.assertEqual(browser("/setup").headers["Location"], f"https://{self.box.network.box_address}/setup")
        self.assertEqual(browser("/adit/run").status_code, 401)
        followed = requests.get(self.box.url + "/", timeout=30, verify=str(self.box.certificate))
        self.assertEqual((followed.status_code, followed.url), (200, self.box.secure_url + "/"))
        self.assertEqual(self.box.ask("GET /adit/run")[0], 200)
        status = requests.get(self.box.url + "/api/status", timeout=30, headers=BEARER, allow_redirects=False)
        self.assertNotIn(status.status_code, (308, 401), json.dumps(status.text))


class Swap(stunnel.SecureStage, test_spare.Swap):
    """A box with TLS, and its spare."""


class Spare(unittest.TestCase):
    def test_browsers_that_trust_the_first_box_trust_its_spare(self):
        stunnel.needs_stunnel()
        stage = began(self.enterContext(Swap(**QUICK)))
        unit = Unit(stage.box)
        self.addCleanup(lambda: unit.stop())
        first, trusting = certificate_of(stage.box), stage.box.context
        self.assertEqual(submit(stage).status_code, 201)
        code = stage.exported()
        unit.stop()
        stage.unplug()
        stage.plug_in_spare()
        unit = Unit(stage.box)
        self.assertNotEqual(certificate_of(stage.box), first)
        with self.assertRaises(ssl.SSLCertVerificationError):
            stage.box.connect(context=trusting)
        stage.take_over(code)

        def trusts():
            with contextlib.suppress(OSError):
                stage.box.connect(context=trusting).close()
                return True
            return False

        wait_until(trusts, "the spare's TLS server to have the first box's certificate")
        self.assertEqual(shown(stage.box)["fingerprint"], first["fingerprint"])
        self.assertEqual([report["state"] for report in stage.box.reports()], ["answered"])
