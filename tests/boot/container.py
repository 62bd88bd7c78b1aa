"""A root in a container (systemd-nspawn), for daily use: this machine's processor, the real units, seconds to start. It lacks the
parts of a machine: boot loader, kernel, disk, GPIO, hardware watchdog, and features that need these (the import from the boot
partition, updates)."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time

import cables
import hosts
import programs

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
BOARD = "generic-x86_64"
TREE = SOURCE / "build" / "image" / BOARD / "work" / "root"


def missing():
    """The reason why this machine cannot run it, or ""."""
    if not shutil.which("systemd-nspawn"):
        return "not on this machine: systemd-nspawn (Debian: systemd-container)"
    if not TREE.is_dir():
        return f"no root of {BOARD}: toolchain/image {BOARD} makes it"
    if os.uname().machine != "x86_64":
        return f"{BOARD} does not run on {os.uname().machine}"
    return ""


class Cables(hosts.Network):
    """The wire tests' three hosts. The container gets the box's two ports, and its own network sets the addresses."""

    def __init__(self):
        super().__init__("10.0.0")
        self.box_address, self.team_address = cables.FACTORY_ADDRESS, cables.TEAM_ADDRESS

    def _make(self):
        super()._make()
        self._flush()

    def _flush(self):
        for port in ("team0", "darpa0"):
            hosts.ip("-n", self.box, "address", "flush", "dev", port)

    def cable_the_box(self):
        """Connects again, because the ports and their cables vanished with the container."""
        for host, addresses, port in (
            (self.team, [self.team_address], "team0"),
            (self.post, [hosts.SCORING, hosts.MAPPING], "darpa0"),
        ):
            if (
                subprocess.run(
                    ["ip", "-n", self.box, "link", "show", port], capture_output=True, check=False
                ).returncode
                != 0
            ):
                self._cable(host, "eth0", addresses, self.box, port, [])


class Nspawn(programs.Page):
    """A root of its own over `tree`, which does not change."""

    ports = ("team0", "darpa0")  # of the network's box, which it takes
    options = ()  # systemd-nspawn's

    def __init__(self, network, folder, tree):
        self.network, self.folder = network, folder
        self.log, self.root = folder / "container.log", folder / "root"
        upper, work = folder / "upper", folder / "work"
        for path in (self.root, upper, work):
            path.mkdir()
        layers = f"lowerdir={tree},upperdir={upper},workdir={work}"
        subprocess.run(["mount", "-t", "overlay", "adit-container", "-o", layers, self.root], check=True)
        self.process = None

    def start(self):
        """Waits until it has started. Adds the mounts that nspawn needs if this machine's PID 1 is not systemd."""
        self.began = time.monotonic()
        taken = " ".join([*self.options, *(f"--network-interface={port}" for port in self.ports)])
        inside = (
            "mount -t tmpfs tmpfs /run; mount -t sysfs -o ro sysfs /sys; mount -t cgroup2 cgroup2 /sys/fs/cgroup; "
            f"exec systemd-nspawn -q -D {self.root} -b --register=no --keep-unit --uuid=0123456789abcdef0123456789abcdef {taken}"
        )
        with open(self.log, "ab") as said:
            self.process = subprocess.Popen(
                [
                    "setpriv",
                    "--pdeathsig",
                    "KILL",
                    "nsenter",
                    f"--net=/run/netns/{self.network.box}",
                    "unshare",
                    "-m",
                    "--propagation",
                    "private",
                    "bash",
                    "-c",
                    inside,
                ],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )
        programs.wait_until(self.is_started, "the container to start", 90)

    def answers(self):
        self.leader()
        try:
            return self.ask("GET /adit/session", token=None, timeout=5)[0] == 200
        except (OSError, ValueError):
            return False

    def said_last(self):
        return self.log.read_text(errors="replace")[-4000:] if self.log.exists() else ""

    def leader(self):
        """This machine's number of its first process; None if there is none."""
        if self.process.poll() is not None:
            raise AssertionError(f"systemd-nspawn has ended:\n{self.said_last()}")
        found = subprocess.run(["pgrep", "-P", str(self.process.pid)], capture_output=True, text=True, check=False).stdout
        return int(found.split()[0]) if found else None

    def run(self, *command):
        """Runs a command in it as root."""
        return subprocess.run(
            ["nsenter", "-a", "-t", str(self.leader()), *command], capture_output=True, text=True, check=False
        )

    def pid(self):
        return int(self.run("systemctl", "show", "-p", "MainPID", "--value", "adit.service").stdout or 0)

    def stop(self):
        if self.process is None or self.process.poll() is not None:
            return
        leader = self.leader()
        os.kill(leader or self.process.pid, signal.SIGRTMIN + 3 if leader else signal.SIGKILL)
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def close(self):
        self.stop()
        subprocess.run(["umount", "--lazy", self.root], check=False)

    def code(self):
        """The code of the first start, from the log."""
        said = self.run(
            "journalctl", "-u", "adit", "-o", "cat", "--no-pager", "--output-fields=MESSAGE,CODE,ADIT_CODE"
        ).stdout
        return re.search(r"code=(\d{8})", said).group(1)


class Container(Nspawn):
    """The tree of the image, overlaid with this build's programs and units and the current overlay."""

    def __init__(self, network, folder):
        super().__init__(network, folder, TREE)
        self.state = folder / "var"
        self.state.mkdir()
        folders = f"{SOURCE}/rootfs/overlay/usr/lib/adit/folders"  # as before systemd starts
        subprocess.run(["sh", "-c", '. "$0"; make_folders "$1"', folders, self.state], check=True)
        self.options = ("--read-only", f"--bind={self.state}:/var")
        with open(folder / "install.log", "wb") as said:
            for component in ("service", "appliance"):
                subprocess.run(
                    ["cmake", "--install", programs.BIN.parent, "--prefix", "/usr", "--strip", "--component", component],
                    check=True,
                    stdout=said,
                    stderr=said,
                    env={**os.environ, "DESTDIR": str(self.root)},
                )
        subprocess.run(["cp", "-a", f"{SOURCE}/rootfs/overlay/.", self.root], check=True)
        subprocess.run(
            ["systemctl", f"--root={self.root}", "preset-all", "--preset-mode=full"],
            check=True,
            stderr=subprocess.DEVNULL,
        )

    def is_started(self):
        return self.answers()


class Stage:
    """A container in its own directory, and a Command Post."""

    cables, contained = Cables, Container

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="adit-container-")
        self.folder = pathlib.Path(self.temporary.name)
        self.network = self.cables()
        self.post = self.box = None
        self.network.__enter__()
        try:
            programs.secrets_folder(self.folder / "secrets")
            self.post = programs.CommandPost(self.network, self.folder, "--rate", "0")
            self.box = self.contained(self.network, self.folder)
            self.prepare()
        except BaseException:
            self.__exit__()
            raise
        return self

    def prepare(self):
        """Prepares the story; by default the container is not even started."""

    def __exit__(self, *_):
        if self.box is not None:
            self.box.close()
        if self.post is not None:
            self.post.stop()
        self.network.__exit__()
        self.temporary.cleanup()
