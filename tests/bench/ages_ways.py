"""What stands between the robots and the Command Post."""

import json
import os
import shutil
import sys

LISTEN, MAPPING, SCORING = ("10.91.1.2", 8000), ("10.91.2.2", 9001), ("10.91.2.2", 9000)
TOKEN = "token-of-the-bench"  # of all three


class Way:
    """Writes its files into a folder, and gives the command to run there."""

    def __init__(self, name):
        self.name = name


class Adit(Way):
    def __init__(self, name, program, reports_hz=1):
        super().__init__(name)
        self.program = program
        self.reports_hz = reports_hz

    def command(self, folder):
        os.mkdir(f"{folder}/state")
        settings = {"version": 1,
                    "command_post": {"scoring": {"address": SCORING[0], "port": SCORING[1]},
                                     "mapping": {"address": MAPPING[0], "port": MAPPING[1]},
                                     "rates": {"reports_hz": self.reports_hz}},
                    "team": {"listen": [{"address": LISTEN[0], "port": LISTEN[1]}]}}
        with open(f"{folder}/settings.json", "w", encoding="utf-8") as file:
            json.dump(settings, file)
        return [self.program, "--settings", f"{folder}/settings.json", "--secrets", f"{folder}/../secrets",
                "--state", f"{folder}/state"]


class Nginx(Way):
    """One request a second of each URI goes on; what comes sooner is refused with 429, as careful teams set it up."""

    URIS = ("/map/update", "/state/update", "/markers/update")

    def __init__(self):
        super().__init__("nginx")

    def command(self, folder):
        zones = "".join(f"limit_req_zone $uri zone=z{i}:1m rate=1r/s;" for i in range(len(self.URIS)))
        places = "".join(f"location {uri} {{ limit_req zone=z{i}; proxy_pass http://{MAPPING[0]}:{MAPPING[1]}; }}"
                         for i, uri in enumerate(self.URIS))
        with open(f"{folder}/nginx.conf", "w", encoding="utf-8") as file:
            file.write(f"""daemon off; worker_processes 1; pid {folder}/pid; error_log stderr crit;
events {{}}
http {{
  access_log off; client_max_body_size 256m; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
  limit_req_status 429; {zones}
  server {{
    listen {LISTEN[0]}:{LISTEN[1]};
    {places}
    location / {{ proxy_pass http://{SCORING[0]}:{SCORING[1]}; }}
  }}
}}
""")
        program = shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin")
        if program is None:
            sys.exit("tests/bench/ages: no nginx here: toolchain/setup bench")
        return [program, "-c", f"{folder}/nginx.conf", "-e", "stderr", "-g", "user root;"]


class Relay(Way):
    """A script as teams write it: it answers at once, keeps the newest body of each URI, and sends one a second."""

    def __init__(self):
        super().__init__("relay")

    def command(self, folder):
        relay = os.path.join(os.path.dirname(__file__), "ages_relay.py")
        return [sys.executable, "-B", relay, "%s:%d" % LISTEN, "%s:%d" % MAPPING, "%s:%d" % SCORING]
