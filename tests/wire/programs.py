"""The released programs under test: aditd on the box, adit-rehearsal at the Command Post."""

import contextlib
import http.client
import json
import math
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile

import hosts
import ledger_files

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from patience import patient, wait_until  # noqa: E402, after the path is set

BIN = pathlib.Path(os.environ["ADIT_BIN"])
SCORING_TOKEN = "flux230{showroom"
MAPPING_TOKEN = "rust871}backdoor"
TEAM_TOKEN = "team-own-token-1"
FIELDS = ("x", "y", "z", "type")  # of a report
PORT = 8000
ARTIFACTS = pathlib.Path(__file__).with_name("artifacts.csv")
MOST_MS = 600_000  # of a time-out
CONTROL_PORT = 8002  # on the Command Post's loopback
STOPS_WITHIN = patient(30.0)  # seconds: on a busy machine more than TimeoutStopSec= of adit.service


def patient_fault(fault):
    """Multiplies the seconds in "answer-after=2" by ADIT_PATIENCE. Not in retry-after, which takes only whole seconds."""
    fault = re.sub(r"(?<=(?:rd|er)-after=)[\d.]+", lambda found: f"{patient(float(found[0])):g}", fault)
    return re.sub(r"(?<=retry-after=)\d+", lambda found: str(math.ceil(patient(int(found[0])))), fault)


def secrets_folder(folder):
    folder.mkdir(mode=0o700)
    for name, token in (("scoring", SCORING_TOKEN), ("mapping", MAPPING_TOKEN), ("team", TEAM_TOKEN)):
        path = folder / f"{name}.token"
        path.write_text(token + "\n")
        path.chmod(0o600)
    return folder


class Program:
    """A process in a namespace. Its log is kept and shown if a test fails."""

    def __init__(self, network, host, log, command):
        self.log = log
        with open(log, "ab") as output:
            self.process = network.start(host, *command, stdout=output, stderr=output)

    def stop(self, number=signal.SIGTERM, within=STOPS_WITHIN):
        """Ends it and returns its exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            return self.process.wait(within)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise AssertionError(f"did not stop within {within:g} s:\n{self.output()}") from None

    def output(self):
        return pathlib.Path(self.log).read_text(errors="replace")


class CommandPost(Program):
    """adit-rehearsal on both of its addresses. Received requests are in requests(). A second one has other ports, and a directory of
    its own below `folder`."""

    def __init__(self, network, folder, *options, name="", port=PORT, control_port=CONTROL_PORT):
        self.transcript = folder / name / "transcript"
        self.transcript.parent.mkdir(exist_ok=True)
        self.control_port = control_port
        command = [BIN / "adit-rehearsal", "--scoring", f"{hosts.SCORING}:{port}", "--mapping",
                   f"{hosts.MAPPING}:{port}", "--control", f"127.0.0.1:{control_port}", "--secrets", folder / "secrets",
                   "--artifacts", ARTIFACTS, "--transcript", self.transcript, *options]
        self.network = network
        super().__init__(network, network.post, folder / name / "rehearsal.log", command)
        wait_until(lambda: "adit-rehearsal: scoring" in self.output(), "adit-rehearsal to listen")

    def control(self, request, body=None):
        """Sends a request to the control port: control("POST /new-run", {"run": "2"})."""
        method, _, path = request.partition(" ")
        connection = http.client.HTTPConnection("127.0.0.1", self.control_port)
        connection.sock = self.network.connect(self.network.post, "127.0.0.1", self.control_port, patient(30))
        with contextlib.closing(connection):
            connection.request(method, path, None if body is None else json.dumps(body))
            answer = connection.getresponse()
            said = json.loads(answer.read())
        if answer.status >= 300:
            raise AssertionError(f"{request}: {answer.status} {said}")
        return said

    def will(self, *faults, **of_others):
        """Orders faults of the next requests: will("drop", "ok", status=["500"]). Seconds are multiplied by ADIT_PATIENCE."""
        self.control("POST /faults", {aim: [patient_fault(fault) for fault in given]
                                      for aim, given in {"reports": faults, **of_others}.items()})

    def recorded(self, report=None):
        """The reports that it recorded for its client: all, or those equal to `report`."""
        found = [made for made in self.control("GET /record")["reports"] if made["by"] == "client"]
        return [made for made in found if report is None or all(made[name] == report[name] for name in FIELDS)]

    def requests(self, uri=None):
        path = self.transcript / "requests.jsonl"
        if not path.exists():
            return []
        lines = path.read_text().split("\n")[:-1]
        found = [json.loads(line) for line in lines]
        return [request for request in found if uri is None or request["uri"] == uri]

    def violations(self):
        return [(request["uri"], request["violations"]) for request in self.requests() if request["violations"]]


class Page:
    """Requests of the box's page. A subclass has `network` and `port`."""

    port = PORT

    @property
    def url(self):
        return f"http://{self.network.box_address}:{self.port}"

    def ask(self, request, headers=(), body=None, token=TEAM_TOKEN, timeout=30):
        """Sends a request of the page: ask("GET /adit/run"). Returns the status and the parsed JSON."""
        return self._answer(request, headers, body, token, timeout)[:2]

    def insist(self, request, headers=(), body=None, token=TEAM_TOKEN, timeout=30):
        """As ask(), but retries while an earlier change is being applied, which is answered 409 with Retry-After."""
        def answer():
            status, said, again_after = self._answer(request, headers, body, token, timeout)
            return None if status == 409 and again_after else (status, said)
        return wait_until(answer, "the change before to be applied")

    def _answer(self, request, headers, body, token, timeout):
        method, _, path = request.partition(" ")
        sent = {"Authorization": f"Bearer {token}"} if token else {}
        if body is not None:
            sent["Content-Type"] = "application/json"
        connection = http.client.HTTPConnection(self.network.box_address, self.port, timeout=patient(timeout))
        with contextlib.closing(connection):
            connection.request(method, path, None if body is None else json.dumps(body), {**sent, **dict(headers)})
            answer = connection.getresponse()
            return answer.status, json.loads(answer.read()), answer.getheader("Retry-After")

    def apply(self, request, body):
        """Requests a change of the configuration as ask() does, and waits until it is applied or reverted."""
        status, said = self.ask(request, body=body)
        if status != 200:
            raise AssertionError(f"{request}: {status} {said}")
        wait_until(self._is_settled, "it to be applied")
        return said

    def _is_settled(self):
        try:
            return not self.ask("GET /adit/settings")[1]["applying"]
        except OSError:  # a release that restarts
            return False

    def save(self, change):
        """Changes the settings with `change` and saves them. Returns the parsed answer."""
        held = self.ask("GET /adit/settings")[1]
        change(held["settings"])
        return self.apply("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})

    def answers_over_tls(self):
        """Whether a file of the page comes from port 443, with any certificate."""
        curl = ["curl", "-sk", "-m", "5", "-o", os.devnull, "-w", "%{http_code}", f"https://{self.network.box_address}/icon.svg"]
        return subprocess.run(curl, capture_output=True, check=False).stdout == b"200"

    def reports(self):
        """All reports on the page, oldest first."""
        return self.ask("GET /adit/reports")[1]

    def alarms(self):
        """The ids of the alarms that call the operator, without temporary ones."""
        return {alarm["id"] for alarm in self.ask("GET /adit/run")[1]["alarms"] if alarm["severity"] != "wait"}

    def judge(self, number, action):
        """The operator's decision on a report: send, done, withdraw or resubmit. Returns the status and the parsed JSON."""
        return self.ask(f"POST /adit/reports/{number}/{action}", {"Content-Type": "application/json"})

    def knows_the_run(self):
        return self.ask("GET /adit/run")[1]["run_clock"] is not None


def log_in(page, password):
    """Logs in as the operator and returns the headers that the browser then sends."""
    connection = http.client.HTTPConnection(page.network.box_address, page.port, timeout=patient(20))
    with contextlib.closing(connection):
        connection.request("POST", "/adit/login", json.dumps({"password": password}),
                           {"Content-Type": "application/json"})
        answer = connection.getresponse()
        said = json.loads(answer.read())
    if answer.status != 200:
        raise AssertionError(f"the login: {answer.status} {said}")
    return {"Cookie": answer.headers["Set-Cookie"].partition(";")[0], "Adit-CSRF": said["csrf"]}


class Box(Program, Page):
    """aditd between the team and the Command Post."""

    def __init__(self, network, folder, **overrides):
        self.network, self.folder = network, folder
        self.state = folder / "state"
        self.settings = folder / "settings.json"
        self.settings.write_text(json.dumps(settings(network, overrides)))
        command = [BIN / "aditd", "--settings", self.settings, "--secrets", folder / "secrets", "--state", self.state,
                   "--network", folder / "network" / "status", "--update", folder / "update", "--board", folder / "board.json",
                   "--notices", folder / "notices", "--clock", folder / "clock", "--spare", folder / "spare-stick", "--watch", folder / "watch",
                   "--block", folder / "block"]
        super().__init__(network, network.box, folder / "aditd.log", command)
        wait_until(self._answers, "aditd to listen")

    def on_disk(self, member="state"):
        """A member of each report in the ledger's files, oldest first."""
        reports = wait_until(lambda: [ledger_files.read(self.state / "ledger")[0]], "the ledger's files to stay",
                             tolerates=FileNotFoundError)[0]
        return [reports[number][member] for number in sorted(reports)]

    def _answers(self):
        if self.process.poll() is not None:
            raise AssertionError(f"aditd ended with {self.process.returncode}:\n{self.output()}")
        try:
            socket.create_connection((self.network.box_address, PORT), 0.2).close()
        except OSError:
            return False
        return True


def settings(network, overrides):
    """Settings with fast rates, so that tests do not wait for the ICD's one request per second; `overrides` by dotted path.
    Milliseconds are multiplied by ADIT_PATIENCE, up to the limit of the setting."""
    rates = {f"{kind}_hz": 200 for kind in ("reports", "status", "map", "state", "markers")}
    document = {
        "version": 1,
        "command_post": {
            "scoring": {"address": hosts.SCORING, "port": PORT},
            "mapping": {"address": hosts.MAPPING, "port": PORT},
            "interface": "darpa0",
            "rates": rates,
        },
        "team": {"interface": "team0", "listen": [{"address": network.box_address, "port": PORT}]},
    }
    for path, value in overrides.items():
        at = document
        *folders, last = re.split(r"__", path)
        for name in folders:
            at = at.setdefault(name, {})
        at[last] = min(MOST_MS, round(patient(value))) if last.endswith("_ms") else value
    return document


class Stage:
    """Network, Command Post and box, and a directory for their files."""

    make_box = Box

    def __init__(self, team_net="192.168.7", post_options=("--rate", "0"), disk=None, **overrides):
        """`disk`: the size of a separate file system for the state directory ("2m")."""
        self.disk = disk
        self.network = hosts.Network(team_net)
        self.post_options, self.overrides = post_options, overrides
        self.temporary = tempfile.TemporaryDirectory(prefix="adit-wire-")
        self.folder = pathlib.Path(self.temporary.name)
        self.post = self.box = None

    def __enter__(self):
        secrets_folder(self.folder / "secrets")
        self.network.__enter__()
        try:
            (self.folder / "state").mkdir()
            if self.disk is not None:
                subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={self.disk}", "adit-wire", self.folder / "state"],
                               check=True)
            if self.post_options is not None:
                self.post = CommandPost(self.network, self.folder, *self.post_options)
            self.box = self.make_box(self.network, self.folder, **self.overrides)
        except BaseException:
            self.__exit__()
            raise
        return self

    def restart_box(self, **overrides):
        self.box = Box(self.network, self.folder, **{**self.overrides, **overrides})

    def __exit__(self, *_):
        for program in (self.box, self.post):
            if program is not None and program.process.poll() is None:
                program.process.kill()
                program.process.wait()
        if self.disk is not None:
            subprocess.run(["umount", "--lazy", self.folder / "state"], stderr=subprocess.DEVNULL, check=False)
        self.network.__exit__()
        self.temporary.cleanup()
