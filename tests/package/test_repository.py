"""The apt repository of toolchain/repository, served to a PC by HTTP and from a directory: apt installs, upgrades and purges Adit.
apt rejects an older repository, another key, and lists and packages that were changed after signing."""

import http.server
import os
import shutil
import socketserver
import subprocess
import threading

import pc
import programs
from stage import Story, load_tests  # unittest looks for them here
from test_package import setUpModule  # and for the latter, too

FOLDER, SERVER = pc.BUILT / "repository", "172.20.0.1"
PORT = 8080


def publish(packages, name="apt", **environment):
    """Makes the repository `name` from packages of debian_root."""
    environment = {"ADIT_APT_URI": f"http://{SERVER}:{PORT}/apt", **environment}
    subprocess.run([pc.SOURCE / "toolchain/repository", FOLDER / name, f"bookworm={pc.BUILT / packages}"], check=True,
                   env={**os.environ, **environment})


def other_key(folder):
    """Another signer's key in the keyring `folder`."""
    folder.mkdir(mode=0o700)
    done = subprocess.run(["gpg", "--homedir", folder, "--batch", "--status-fd", "1", "--passphrase", "", "--quick-generate-key", "Another", "rsa3072", "sign"],
                          check=True, capture_output=True, text=True)
    return {"GNUPGHOME": str(folder), "ADIT_APT_KEY": done.stdout.split("KEY_CREATED")[1].split()[1]}


def flip(path):
    """Changes the last byte."""
    content = bytearray(path.read_bytes())
    content[-1] ^= 1
    path.write_bytes(content)


class Files(http.server.SimpleHTTPRequestHandler):
    def __init__(self, *words):
        super().__init__(*words, directory=FOLDER)

    def log_message(self, *_):
        pass


class Repository(Story):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir()
        cls.tell(pc.Stage())
        network = cls.stage.network
        server = network.made_in(network.team, lambda: socketserver.ThreadingTCPServer((SERVER, PORT), Files))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        cls.addClassCleanup(server.server_close)
        cls.addClassCleanup(server.shutdown)

    def update(self, good=True):
        return self.box.apt("update -o APT::Update::Error-Mode=any -o Acquire::Retries=3", good)

    def candidate(self):
        return self.box.shell("apt-cache policy adit | sed -n 's/^  Candidate: //p'").strip()

    def test_it_is_installed_from_a_repository(self):
        publish("before")
        self.box.shell("rm -f /etc/apt/sources.list /etc/apt/sources.list.d/*; cp /packages/repository/apt/adit-bookworm.sources /etc/apt/sources.list.d/adit.sources")
        self.box.shell(f"install -d -m 700 /etc/adit/secrets; umask 077; echo {programs.TEAM_TOKEN} >/etc/adit/secrets/team.token")
        self.update()
        self.box.apt("install adit", team=pc.PORTS["team"], command_post=pc.PORTS["command_post"])
        self.assertEqual(self.box.version(), "0.0.9")
        programs.wait_until(self.box.answers, "the page to answer", 60)
        shutil.copytree(FOLDER / "apt", FOLDER / "old")

    def test_lists_signed_by_another_key_are_rejected(self):
        publish("now", **other_key(self.stage.folder / "keys"))
        self.assertIn("NO_PUBKEY", self.update(good=False))
        self.assertEqual(self.candidate(), "0.0.9")

    def test_changed_lists_are_rejected(self):
        publish("now")
        signed = FOLDER / "apt/dists/bookworm/InRelease"
        text = signed.read_text()
        signed.write_text(text.replace("Label: Adit", "Label: Adot"))
        self.assertIn("BADSIG", self.update(good=False))
        signed.write_text(text)
        flip(FOLDER / "apt/dists/bookworm/main/binary-amd64/Packages")
        self.assertIn("Hash Sum mismatch", self.update(good=False))
        self.assertEqual(self.candidate(), "0.0.9")

    def test_changed_package_is_rejected(self):
        publish("now")
        flip(next((FOLDER / "apt/pool/bookworm").glob("adit_*_amd64.deb")))
        self.update()
        self.assertIn("Hash Sum mismatch", self.box.apt("upgrade", good=False))
        self.assertEqual(self.box.version(), "0.0.9")

    def test_the_next_release_is_an_upgrade(self):
        publish("now")
        self.update()
        told = f"apt has {self.candidate()}: apt upgrade\n"
        programs.wait_until(lambda: told in self.box.shell("adit status", good=False), f"'{told}' in adit status", 60)
        self.box.apt("upgrade")
        self.assertEqual(self.box.version(), self.candidate())
        programs.wait_until(lambda: self.box.shell("adit update") == "apt has no newer version\n", "it to be no longer shown", 60)
        self.assertNotEqual(self.box.version(), "0.0.9")
        programs.wait_until(self.box.answers, "the page to answer", 60)

    def test_an_older_repository_is_no_downgrade(self):
        version = self.box.version()
        shutil.rmtree(FOLDER / "apt")
        shutil.copytree(FOLDER / "old", FOLDER / "apt")
        self.update()
        self.assertEqual(self.candidate(), version, "apt keeps the newer lists")
        publish("before")
        self.update()
        self.box.apt("upgrade")
        self.assertIn(f"adit 0.0.9 is older than {version}", self.box.apt("--allow-downgrades install adit=0.0.9", good=False))
        self.assertEqual(self.box.version(), version)
        self.box.shell("printf 'Package: adit\\nPin: version 0.0.9\\nPin-Priority: 1001\\n' >/etc/apt/preferences.d/adit")
        self.assertEqual(self.candidate(), "0.0.9")
        self.assertEqual(self.box.shell("systemctl start adit-newer && cat /run/adit-update/newer"), "\n", "a pinned older version is not newer")
        self.box.shell("rm /etc/apt/preferences.d/adit")

    def test_a_stick_serves_it_without_a_network(self):
        version = self.box.version()
        self.box.apt("purge adit", remove_ledger="true")
        publish("now", "stick/apt", ADIT_APT_URI="")
        self.box.shell(f"""mkdir /media/adit; mount --bind /packages/repository/stick /media/adit; ip link set {pc.OFFICE} down
            cp /media/adit/apt/adit-bookworm.sources /etc/apt/sources.list.d/adit.sources""")
        self.update()
        self.box.apt("install adit adit-rehearsal", team="", command_post="")
        self.assertEqual(self.box.version(), version)
        self.box.apt("purge adit adit-rehearsal")
        self.assertEqual(self.box.shell("ls -d /etc/adit /var/lib/private/adit /usr/bin/aditd 2>/dev/null || true"), "")
