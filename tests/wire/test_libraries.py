"""Answers that the usual HTTP libraries must be able to read: a refusal before the end of a body, and when to retry. And nginx and
haproxy before Adit, with the lines of services/README.md."""

import contextlib
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import unittest

import maps
import messages
import programs
from programs import Stage, wait_until

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
MAP_BYTES = 5_000_000

URLLIB = """
import sys, urllib.error, urllib.request
asked = urllib.request.Request(sys.argv[1], open(sys.argv[2], "rb").read(), HEADERS)
try:
    urllib.request.urlopen(asked)
except urllib.error.HTTPError as answer:
    print(answer.code, answer.read().decode())
"""
REQUESTS = """
import sys, requests
answer = requests.post(sys.argv[1], open(sys.argv[2], "rb").read(), headers=HEADERS)
print(answer.status_code, answer.text)
"""
NODE = """
const fs = require("fs"), http = require("http");
const asked = http.request(process.argv[1], { method: "POST", headers: HEADERS }, async (answer) => {
  let text = "";
  for await (const piece of answer) text += piece;
  console.log(answer.statusCode, text);
});
asked.on("error", (why) => console.log(why.code));
asked.end(fs.readFileSync(process.argv[2]));
"""
HEADERS = json.dumps({"Authorization": "Bearer an-old-token", "Content-Type": "application/json"})
CURL = ["curl", "-sS", "-w", "%{http_code}", "-H", "Authorization: Bearer an-old-token", "-H", "Content-Type: application/json", "-H", "Expect:"]
LIBRARIES = {
    "urllib": lambda url, body: ["/usr/bin/python3", "-c", URLLIB.replace("HEADERS", HEADERS), url, body],
    "requests": lambda url, body: ["/usr/bin/python3", "-c", REQUESTS.replace("HEADERS", HEADERS), url, body],
    "node": lambda url, body: ["node", "-e", NODE.replace("HEADERS", HEADERS), "--", url, body],
    "curl": lambda url, body: [*CURL, "--data-binary", f"@{body}", url],
}
RETRYING = """
import sys, time, requests, urllib3
session = requests.Session()
retry = urllib3.Retry(total=6, backoff_factor=0, status_forcelist=[429], allowed_methods=None)
session.mount("http://", requests.adapters.HTTPAdapter(max_retries=retry))
begun = time.monotonic()
try:
    session.post(sys.argv[1], open(sys.argv[2], "rb").read(), headers={"Authorization": "Bearer " + sys.argv[3], "Content-Type": "application/json"})
except requests.exceptions.RetryError:
    print("gave up after", time.monotonic() - begun)
"""


class Libraries(unittest.TestCase):
    def run_at(self, stage, name, command):
        made = programs.Program(stage.network, stage.network.team, stage.folder / f"{name}.log", command)
        self.addCleanup(made.stop, signal.SIGKILL)
        made.process.wait(60)
        return made.output()

    def test_a_wrong_token_is_answered_during_a_map(self):
        with Stage() as stage:
            body = stage.folder / "map.json"
            body.write_bytes(b" " * MAP_BYTES)
            for name, command in LIBRARIES.items():
                if shutil.which(command("", "")[0]) is None:
                    continue
                for turn in range(4):
                    said = self.run_at(stage, f"{name}-{turn}", command(f"{stage.box.url}/map/update", str(body)))
                    self.assertIn("401", said, name)
                    self.assertIn("expected Bearer and the team's token", said, name)

    def test_urllib3_retries_as_slowly_as_it_is_told(self):
        with Stage(post_options=None, queues__map_bytes=1 << 20) as stage:
            body = stage.folder / "map.json"
            said = ""
            for seed in range(1, 20):
                cloud = messages.map_update(maps.made_cloud(20000), f"r{seed}", 5.0, messages.Style())
                body.write_text(json.dumps(cloud))
                said = self.run_at(stage, f"upload-{seed}", ["/usr/bin/python3", "-c", RETRYING, f"{stage.box.url}/map/update", str(body),
                                                             programs.TEAM_TOKEN])
                if said:
                    break
            self.assertGreater(float(re.search(r"gave up after ([\d.]+)", said)[1]), 5.5)


def lines_of(name):
    """The block of services/README.md that configures a proxy."""
    text = (SOURCE / "services/README.md").read_text()
    return re.search(rf"^```{name}\n(.*?)^```", text, re.S | re.M)[1]


PROXIES = {
    "nginx": ("nginx", "error_log stderr; pid {folder}/nginx.pid; daemon off; events {{}} http {{ access_log off;"
              " client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy; fastcgi_temp_path {folder}/fastcgi;"
              " uwsgi_temp_path {folder}/uwsgi; scgi_temp_path {folder}/scgi; {lines} }}", ["nginx", "-e", "stderr", "-c"]),
    "haproxy": ("haproxy", "defaults\n  mode http\n  timeout connect 3s\n  timeout client 60s\n  timeout server 60s\n{lines}", ["haproxy", "-f"]),
}


class Proxies(unittest.TestCase):
    def test_the_page_works_behind_the_lines_that_the_readme_shows(self):
        for name, (program, form, command) in PROXIES.items():
            with self.subTest(name), Stage() as stage:
                if shutil.which(program) is None:
                    self.skipTest(f"{program} is not here")
                team = stage.network.box_address
                lines = lines_of(name).replace("10.0.0.1:8000", f"{team}:{programs.PORT}").replace("10.0.0.1", team)
                settings = stage.folder / f"{name}.conf"
                settings.write_text(form.format(folder=stage.folder, lines=lines))
                made = programs.Program(stage.network, stage.network.team, stage.folder / f"{name}.log", [*command, settings])
                self.addCleanup(made.stop, signal.SIGKILL)
                for host, origin, status in (("adit.example.org", "http://adit.example.org", 409), ("adit.example.org", "http://evil.example", 403),
                                             ("evil.example", "http://evil.example", 403)):
                    self.assertEqual(wait_until(lambda host=host, origin=origin, stage=stage: self.log_in(stage, host, origin), made.output), status,
                                     f"{host} {origin}: {made.output()}")

    def log_in(self, stage, host, origin):
        """The status of a login; 409: no password is set yet, so Host and Origin were accepted."""
        with contextlib.closing(http.client.HTTPConnection("127.0.0.1", 80, timeout=10)) as connection:
            try:
                connection.sock = stage.network.connect(stage.network.team, "127.0.0.1", 80, 10)
                connection.request("POST", "/adit/login", '{"password": "x"}',
                                   {"Host": host, "Origin": origin, "Content-Type": "application/json"})
                return connection.getresponse().status
            except ConnectionError:
                return None
