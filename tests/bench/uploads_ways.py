"""The programs between the robots and the Command Post. The CPU time of each process is measured."""

import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import time

TOKEN = "token-of-the-bench"  # of all three
HERE = pathlib.Path(__file__).resolve().parent


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return probe.getsockname()[1]


class Way:
    """Runs in its own directory, before the Command Post at a port."""

    def __init__(self, name, folder, post):
        self.name, self.folder, self.post, self.port = name, pathlib.Path(folder), post, free_port()
        self.folder.mkdir()
        with open(self.folder / "log", "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(self.command(), stdout=log, stderr=log,
                                            env=os.environ | {"RUNTIME_DIRECTORY": str(self.folder)})
        for _ in range(100):
            time.sleep(0.1)
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    break
        else:
            sys.exit(f"tests/bench/uploads: {name} did not start: " + (self.folder / "log").read_text(encoding="utf-8"))

    def cpu(self):
        """CPU milliseconds of all its threads, also ended ones, by clock_getcpuclockid(3)."""
        return time.clock_gettime((~self.process.pid << 3) | 2) * 1000

    def memory(self, row):
        """VmRSS or VmHWM, in megabytes. Includes files mapped from a file system in memory."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(rf"{row}:\s+(\d+) kB", status)[1]) * 1024 / 1e6

    def forget_peak(self):
        pathlib.Path(f"/proc/{self.process.pid}/clear_refs").write_text("5", encoding="ascii")


class Adit(Way):
    """Adit as delivered, but with a fast link, so that Adit is measured and not its pace."""

    def __init__(self, name, folder, post, program):
        self.program = program
        super().__init__(name, folder, post)

    def command(self):
        (self.folder / "secrets").mkdir(0o700)
        for token in ("scoring", "mapping", "team"):
            with open(os.open(self.folder / f"secrets/{token}.token", os.O_CREAT | os.O_WRONLY, 0o600), "w", encoding="ascii") as file:
                file.write(TOKEN)
        post = {"address": "127.0.0.1", "port": self.post}
        settings = {"version": 1, "command_post": {"scoring": post, "mapping": post, "budget_mbit": 100_000},
                    "team": {"listen": [{"address": "127.0.0.1", "port": self.port}]}}
        (self.folder / "settings.json").write_text(json.dumps(settings), encoding="ascii")
        (self.folder / "state").mkdir()
        return [self.program, "--settings", self.folder / "settings.json", "--secrets", self.folder / "secrets",
                "--state", self.folder / "state"]


class Nginx(Way):
    """A plain proxy that passes requests on unchanged."""

    def command(self):
        folder = self.folder
        (folder / "nginx.conf").write_text(f"""daemon off; master_process off; pid {folder}/pid; error_log stderr crit;
events {{}}
http {{
  access_log off; client_max_body_size 256m; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
  upstream post {{ server 127.0.0.1:{self.post}; keepalive 4; }}
  server {{
    listen 127.0.0.1:{self.port};
    location / {{ proxy_pass http://post; proxy_http_version 1.1; proxy_set_header Connection ""; }}
  }}
}}
""", encoding="ascii")
        program = shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin")
        if program is None:
            sys.exit("tests/bench/uploads: no nginx here: toolchain/setup bench")
        return [program, "-c", f"{folder}/nginx.conf", "-e", "stderr"]


class Relay(Way):
    def command(self):
        return [sys.executable, "-B", HERE / "uploads_relay.py", f"127.0.0.1:{self.port}", f"127.0.0.1:{self.post}", TOKEN]
