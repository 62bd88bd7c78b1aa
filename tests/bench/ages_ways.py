"""The programs between the robots and the Command Post."""

import json
import os
import shutil
import sys
import tempfile

LISTEN, MAPPING, SCORING = ("10.91.1.2", 8000), ("10.91.2.2", 9001), ("10.91.2.2", 9000)
TOKEN = "token-of-the-bench"  # of all three
URIS = ("/map/update", "/state/update", "/markers/update")


def found(name):
    """The program's path; exits if it is missing."""
    program = shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")
    if program is None:
        sys.exit(f"tests/bench: no {name} here: toolchain/setup bench")
    return program


class Way:
    """Writes its files into a directory, and returns the command to run there."""

    def __init__(self, name):
        self.name = name


class Adit(Way):
    def __init__(self, name, program, reports_hz=1, state=None):
        """`state`: the ledger's directory, if not in memory."""
        super().__init__(name)
        self.program, self.reports_hz, self.state = program, reports_hz, state

    def command(self, folder):
        state = tempfile.mkdtemp(dir=self.state or folder)
        settings = {"version": 1,
                    "command_post": {"scoring": {"address": SCORING[0], "port": SCORING[1]},
                                     "mapping": {"address": MAPPING[0], "port": MAPPING[1]},
                                     "rates": {"reports_hz": self.reports_hz}},
                    "team": {"listen": [{"address": LISTEN[0], "port": LISTEN[1]}]}}
        with open(f"{folder}/settings.json", "w", encoding="utf-8") as file:
            json.dump(settings, file)
        return [self.program, "--settings", f"{folder}/settings.json", "--secrets", f"{folder}/../secrets",
                "--state", state]


class Nginx(Way):
    """Passes on one request per second of each URI, and rejects earlier ones with 429, as careful teams configure it."""

    def __init__(self):
        super().__init__("nginx")

    def command(self, folder):
        zones = "".join(f"limit_req_zone $uri zone=z{i}:1m rate=1r/s;" for i in range(len(URIS)))
        places = "".join(f"location {uri} {{ limit_req zone=z{i}; proxy_pass http://{MAPPING[0]}:{MAPPING[1]}; }}"
                         for i, uri in enumerate(URIS))
        with open(f"{folder}/nginx.conf", "w", encoding="utf-8") as file:
            file.write(f"""daemon off; worker_processes 1; pid {folder}/pid; error_log stderr crit;
events {{}}
http {{
  access_log off; client_max_body_size 256m; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
  limit_req_status 429; {zones}
  keepalive_requests 1000000;
  upstream scoring {{ server {SCORING[0]}:{SCORING[1]}; keepalive 4; }}
  server {{
    listen {LISTEN[0]}:{LISTEN[1]};
    {places}
    location / {{ proxy_pass http://scoring; proxy_http_version 1.1; proxy_set_header Connection ""; }}
  }}
}}
""")
        return [found("nginx"), "-c", f"{folder}/nginx.conf", "-e", "stderr", "-g", "user root;"]


class Haproxy(Way):
    """Like nginx here, rejects requests less than a second after the last one of their URI with 429."""

    def __init__(self):
        super().__init__("haproxy")

    def command(self, folder):
        tables = "".join(f"backend rate{i}\n  stick-table type string size 10 expire 10s store http_req_rate(1s)\n"
                         for i in range(len(URIS)))
        rules = "".join(f"  http-request track-sc{i} path table rate{i} if {{ path {uri} }} !{{ path,table_http_req_rate(rate{i}) gt 0 }}\n"
                        f"  http-request deny deny_status 429 if {{ path {uri} }} !{{ sc{i}_tracked }}\n"
                        for i, uri in enumerate(URIS))
        with open(f"{folder}/haproxy.cfg", "w", encoding="utf-8") as file:
            file.write(f"""global
  nbthread 1
defaults
  mode http
  timeout connect 5s
  timeout client 60s
  timeout server 60s
{tables}frontend team
  bind {LISTEN[0]}:{LISTEN[1]}
{rules}  use_backend mapping if {{ path {" ".join(URIS)} }}
  default_backend scoring
backend mapping
  server post {MAPPING[0]}:{MAPPING[1]}
backend scoring
  server post {SCORING[0]}:{SCORING[1]}
""")
        return [found("haproxy"), "-f", f"{folder}/haproxy.cfg"]


class Relay(Way):
    """A script like those of teams: answers at once, keeps the newest body of each URI, and sends one per second."""

    def __init__(self):
        super().__init__("relay")

    def command(self, folder):
        relay = os.path.join(os.path.dirname(__file__), "ages_relay.py")
        return [sys.executable, "-B", relay, "%s:%d" % LISTEN, "%s:%d" % MAPPING, "%s:%d" % SCORING]
