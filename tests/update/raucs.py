"""A box of plain files for adit-update: a real RAUC with its service on its own bus, two slots, U-Boot's environment, and a stand-in
for systemctl."""

import json
import os
import pathlib
import re
import secrets
import shutil
import subprocess
import tempfile
import unittest

from patience import patient, wait_until

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
ADIT_UPDATE = os.path.join(os.environ["ADIT_BIN"], "adit-update")
BOARD = "adit-test-board"
ROOT_SIZE, BOOT_SIZE = 3 << 20, 1 << 20
# A bundle is read through dm-verity as on a box if the machine has the device mapper; otherwise through its
# checksums.
FORMAT = "verity" if os.path.exists("/dev/mapper/control") else "plain"

BUS = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig><type>session</type><listen>unix:path={path}</listen><policy context="default"><allow own="*"/>
<allow send_destination="*" eavesdrop="true"/><allow eavesdrop="true"/></policy></busconfig>
"""
PROVEN, ON_TRIAL = "a", "3"  # tries, as RAUC writes them: in hexadecimal
ENVIRONMENT = f"BOOT_A_LEFT={PROVEN}\nBOOT_B_LEFT={PROVEN}\nBOOT_ORDER=A B\n"


def needs_rauc():
    for program in ("rauc", "dbus-daemon", "fw_setenv", "mkenvimage", "mksquashfs", "openssl"):
        if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin") is None:
            raise unittest.SkipTest(f"a real RAUC needs {program}")
    if os.geteuid() != 0 or not os.path.exists("/dev/loop-control"):
        raise unittest.SkipTest("a real RAUC needs root and loop devices")


def script(path, text):
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)


def run_at(at, *command, **environment):
    """Runs a command with the time of day that date(1) understands by `at`."""
    subprocess.run([*([] if at == "now" else ["faketime", at]), *command], check=True, capture_output=True, env=os.environ | environment)


class Keys:
    """Of whoever makes releases, with a certificate for a year from `at` on."""

    def __init__(self, folder, name, at="now"):
        self.key, self.cert = folder / f"{name}.key", folder / f"{name}.pem"
        run_at(at, "openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "365", "-subj", f"/CN={name}",
               "-keyout", self.key, "-out", self.cert)


class Bundles:
    """Made as rootfs/bundle makes them, of random images."""

    def __init__(self, folder):
        self.folder = folder
        self.keys = Keys(folder, "release")

    def make(self, version="0.2.0", board=BOARD, keys=None, root_size=ROOT_SIZE, form=FORMAT, at="now"):
        keys = keys or self.keys
        work = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        (work / "in").mkdir()
        (work / "in/root.img").write_bytes(secrets.token_bytes(root_size))
        (work / "in/boot.img").write_bytes(secrets.token_bytes(BOOT_SIZE))
        (work / "in/manifest.raucm").write_text(
            f"[update]\ncompatible={board}\nversion={version}\nbuild=test\n\n[bundle]\nformat={form}\n\n"
            "[image.rootfs]\nfilename=root.img\n\n[image.boot]\nfilename=boot.img\n")
        run_at(at, "rauc", "bundle", f"--cert={keys.cert}", f"--key={keys.key}", work / "in", work / "x.raucb")
        return work / "x.raucb"


class Box:
    def __init__(self, bundles, version="0.1.0", running="A"):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="adit-update-box."))
        for name in ("wanted", "status", "state", "sticks/sda1", "bin", "mount"):
            (self.folder / name).mkdir(parents=True)
        self.slots = {name: self.folder / f"slot-{name}" for name in ("root-a", "root-b", "boot-a", "boot-b")}
        for name, path in self.slots.items():
            path.write_bytes(name.encode() * 16)
            os.truncate(path, 4 << 20)
        self.calls = self.folder / "calls"
        self.calls.touch()
        self.properties = self.folder / "properties"
        self.properties.write_text("ActiveState=activating\n")
        (self.folder / "os-release").write_text(f'ID=adit\nVERSION_ID="{version}"\nNAME=Adit\n')
        self._boot_loader()
        self._configuration()
        self.accept(bundles.keys)
        self._programs()
        self.bus = self._start_bus()
        self.service = None
        try:
            self.start(running)
        except BaseException:
            self.stop()
            raise

    def _boot_loader(self):
        (self.folder / "env.txt").write_text(ENVIRONMENT)
        subprocess.run(["mkenvimage", "-s", "512", "-o", self.folder / "env", self.folder / "env.txt"], check=True)
        (self.folder / "fw_env.config").write_text(f"{self.folder}/env 0x0 0x200\n")

    def accept(self, release, standby=None, at="now"):
        """The keyring of an image that was made `at`."""
        run_at(at, SOURCE / "toolchain/image-key", "--keyring", self.folder / "keyring.pem", ADIT_SIGNING_CERT=str(release.cert),
               ADIT_STANDBY_CERT=str(standby.cert) if standby else "")

    def _configuration(self):
        keyring = re.search(r"^\[keyring\]\n.*?(?=\n\n)", (SOURCE / "rootfs/rauc.conf.in").read_text(), re.M | re.S)[0]
        slots = "".join(f"[slot.{kind}.{number}]\ndevice={self.slots[f'{part}-{letter}']}\n" + extra.format(number=number) + "\n"
                        for number, letter in ((0, "a"), (1, "b"))
                        for kind, part, extra in (("rootfs", "root", f"bootname={letter.upper()}\n"),
                                                  ("boot", "boot", "parent=rootfs.{number}\n")))
        (self.folder / "system.conf").write_text(
            f"[system]\ncompatible={BOARD}\nbootloader=uboot\nboot-attempts=10\nboot-attempts-primary=3\nbundle-formats={FORMAT}\nmountprefix={self.folder}/mount\n"
            f"statusfile={self.folder}/rauc.status\nactivate-installed=true\n\n"
            f"{keyring.replace('/etc/rauc', str(self.folder))}\n\n{slots}")

    def _programs(self):
        bin_folder = self.folder / "bin"
        for name in ("fw_printenv", "fw_setenv"):
            wait = f"while [ -e {self.folder}/hold ]; do : >{self.folder}/held; sleep 0.1; done\n"
            script(bin_folder / name, f'{wait if name == "fw_setenv" else ""}exec {shutil.which(name)} -c {self.folder}/fw_env.config "$@"\n')
        script(bin_folder / "rauc", f'exec {shutil.which("rauc")} -c {self.folder}/system.conf "$@"\n')
        script(bin_folder / "systemctl",
               f'echo "$*" >>{self.calls}\n[ "$1" != show ] || cat {self.properties}\n')
        self.environment = {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}",
                            "DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={self.folder}/bus"}

    def _start_bus(self):
        (self.folder / "bus.conf").write_text(BUS.format(path=self.folder / "bus"))
        bus = subprocess.Popen(["dbus-daemon", "--nofork", "--nosyslog", "--nopidfile", "--print-address",
                                f"--config-file={self.folder}/bus.conf"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        with bus.stdout:  # its socket is there before it listens; it prints its address once it does
            assert bus.stdout.readline(), "the bus did not start"
        return bus

    def start(self, slot):
        """As if the boot loader had started that slot."""
        self.halt()
        self.running = slot
        self.log = open(self.folder / "rauc.log", "ab")
        self.service = subprocess.Popen([self.folder / "bin/rauc", f"--override-boot-slot={slot}", "service"],
                                        env=self.environment, stdout=self.log, stderr=self.log)
        wait_until(lambda: self.rauc("status").returncode == 0, "RAUC's service")

    def halt(self):
        if self.service is not None:
            self.service.kill()
            self.service.wait()
            self.log.close()
            self.service = None

    def rauc(self, *words):
        return subprocess.run([self.folder / "bin/rauc", *words], env=self.environment, capture_output=True, check=False)

    def stop(self):
        self.halt()
        self.bus.kill()
        self.bus.wait()
        if os.path.ismount(self.folder / "mount/bundle"):
            subprocess.run(["umount", self.folder / "mount/bundle"], check=True)
        shutil.rmtree(self.folder)

    def command(self, *words):
        return [ADIT_UPDATE, *words, "--wanted", self.folder / "wanted", "--status", self.folder / "status", "--state",
                self.folder / "state", "--sticks", self.folder / "sticks", "--os-release", self.folder / "os-release",
                "--hindrance", self.folder / "hindrance"]

    def update(self):
        """Runs adit-update to its end, and gives what it tells."""
        done = subprocess.run(self.command(), env=self.environment, capture_output=True, timeout=patient(120), check=False)
        assert done.returncode == 0, done.stderr.decode()
        return self.status()

    def status(self):
        return json.loads((self.folder / "status/status.json").read_text())

    def ask(self, what, again=False):
        """As aditd does."""
        nonce = secrets.token_hex(16)
        (self.folder / "wanted/update.json").write_text(
            json.dumps({"format": 1, "nonce": nonce, "what": what, "again": again}))
        return nonce

    def install(self, bundle, again=False):
        """Uploads and asks; gives what adit-update then tells."""
        shutil.copy(bundle, self.folder / "wanted/update.raucb")
        nonce = self.ask("install", again)
        status = self.update()
        assert status["nonce"] == nonce, status
        return status

    def began_before(self, **known):
        """The last update was installed in an earlier start of the machine; `known`: what of it else was noted."""
        path = self.folder / "state/last.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), "boot": "an earlier one", **known}))

    def boot_loader(self):
        said = subprocess.run([self.folder / "bin/fw_printenv"], capture_output=True, check=True).stdout.decode()
        return dict(line.split("=", 1) for line in said.splitlines())

    def hold_the_boot_loader(self):
        """Its environment cannot be changed while this file is there; `held` beside it: somebody waits for it."""
        (self.folder / "hold").touch()
        return self.folder / "hold"

    def contents(self):
        return {name: path.read_bytes() for name, path in self.slots.items()}
