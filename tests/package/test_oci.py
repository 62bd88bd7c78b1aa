"""The OCI image of the packages, read by umoci and run by runc as an unprivileged user with a read-only root: the whole rehearsal,
its page from another host, and the service alone."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import hosts
import pc
import programs
import requests
from test_package import setUpModule  # unittest looks for it here

OCI = pc.SOURCE / "build" / "oci"
LAYOUT = OCI / "amd64" / "layout"
PORT = 8000


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for program in "umoci", "runc":
            if not shutil.which(program):
                raise unittest.SkipTest(f"no {program} here")
        subprocess.run([pc.SOURCE / "toolchain" / "oci", pc.BUILT / "now"], check=True)
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="adit-oci-")))
        cls.network = cls.enterClassContext(hosts.Network())
        tag = json.loads((LAYOUT / "index.json").read_text())["manifests"][0]["annotations"]["org.opencontainers.image.ref.name"]
        subprocess.run(["umoci", "unpack", "--image", f"{LAYOUT}:{tag}", cls.folder / "bundle"], check=True, capture_output=True)

    def start(self, *command, mounts=()):
        """Runs the image's command, or another one of its programs. Its port is the box's on the team's network."""
        bundle = self.folder / "bundle"
        config = json.loads((bundle / "config.json").read_text())
        self.assertEqual(config["process"]["user"], {"uid": 1000, "gid": 1000})
        if command:
            config["process"]["args"] = list(command)
        config["process"]["terminal"] = False
        config["process"]["noNewPrivileges"] = True
        config["process"]["capabilities"] = {}
        config["root"]["readonly"] = True
        config["mounts"] += [{"destination": "/tmp", "type": "tmpfs", "source": "tmpfs", "options": ["mode=1777"]}, *mounts]
        for namespace in config["linux"]["namespaces"]:
            if namespace["type"] == "network":
                namespace["path"] = f"/run/netns/{self.network.box}"
        (bundle / "config.json").write_text(json.dumps(config))
        name = f"adit-oci-{self._testMethodName[-40:]}"
        log = self.folder / f"{name}.log"
        with open(log, "wb") as said:
            running = subprocess.Popen(["runc", "run", "--bundle", bundle, name], stdin=subprocess.DEVNULL, stdout=said, stderr=said)
        self.addCleanup(running.wait)
        self.addCleanup(subprocess.run, ["runc", "delete", "--force", name], capture_output=True, check=False)
        return name, running, log

    def answer(self, running):
        """The page's address, from another host."""
        def asked():
            self.assertIsNone(running.poll(), "it has ended")
            try:
                return requests.get(f"http://{self.network.box_address}:{PORT}/", timeout=10)
            except requests.ConnectionError:
                return None

        return programs.wait_until(asked, "the page to answer", 120)

    def test_it_runs_the_rehearsal(self):
        name, running, log = self.start()
        self.assertIn("<title>", self.answer(running).text)
        scored = re.compile(r"\b(?!45\b)\d+ reports left")
        programs.wait_until(lambda: scored.search(log.read_text()), "the summary to tell of a report", 120)
        subprocess.run(["runc", "kill", name, "INT"], check=True)
        running.wait(60)
        said = log.read_text()
        self.assertEqual(running.returncode, 0, said)
        for words in "The page:     http://127.0.0.1:8000/", "Its password: rehearsal-", "Your clients: http://127.0.0.1:8000":
            self.assertIn(words, said)

    def test_the_list_of_parts_has_each_package_with_its_source(self):
        """As dpkg knows them. The image has the text of each licence."""
        root = self.folder / "bundle" / "rootfs"
        form = "${Package}\t${Version}\tbuilt from Debian's source packages ${source:Package} (${source:Version})\n"
        said = subprocess.run(["dpkg-query", f"--admindir={root}/var/lib/dpkg", "--show", "--showformat", form], check=True, capture_output=True, text=True)
        installed = {tuple(line.split("\t")) for line in said.stdout.splitlines() if not line.startswith("adit")}
        parts = json.loads(max(OCI.glob("*_amd64.oci.spdx.json"), key=lambda path: path.stat().st_mtime).read_text())["packages"]
        listed = {(part["name"], part["versionInfo"], re.sub(r", .*", "", part["sourceInfo"])) for part in parts if "sourceInfo" in part}
        self.assertEqual({part for part in listed if part[0] != "boost"}, installed)
        self.assertNotIn("NOASSERTION", {part["licenseDeclared"] for part in parts})
        for name, *_ in installed:
            self.assertTrue((root / f"usr/share/doc/{name}/copyright").exists(), name)

    def test_it_runs_the_service(self):
        (self.folder / "settings.json").write_text(json.dumps(
            {"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000}, "mapping": {"address": "10.100.1.201", "port": 8000}},
             "team": {"listen": [{"address": "0.0.0.0", "port": PORT}]}}))
        settings = {"destination": "/settings.json", "type": "bind", "source": str(self.folder / "settings.json"), "options": ["bind", "ro"]}
        _, running, _ = self.start("aditd", "--settings", "/settings.json", "--secrets", "/tmp/secrets", "--state", "/tmp/state", mounts=[settings])
        self.assertEqual(self.answer(running).status_code, 200)
