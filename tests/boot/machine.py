"""The box as a machine: QEMU's arm64 `virt`, started from its card by U-Boot as a board is, with two ports, four
lights, a button and a hardware watchdog."""

import http.client
import os
import pathlib
import shutil
import subprocess
import time

import console
import programs
import qmp

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
BOARD = SOURCE / "board" / "qemu-virt"
IMAGES = SOURCE / "build" / "image" / "qemu-virt"
MACHINE = ["-M", "virt,acpi=off", "-cpu", "cortex-a53", "-smp", "2", "-nodefaults", "-display", "none"]
# As board.json has them, on the eight lines of QEMU's PL061. Line 3 is the machine's own power key.
LINES = ["ADIT_HEALTH", "ADIT_SCORING", "ADIT_MAPPING", "POWER_KEY", "ADIT_ATTENTION", "ADIT_BUTTON", "", ""]
LIGHTS = {"health": 0, "scoring": 1, "mapping": 2, "attention": 4}
BUTTON = 5
PORT = "virtio-net-pci,romfile="


def image():
    """The newest image of the board that tests boot."""
    return max(IMAGES.glob("adit-qemu-virt-*.img"), key=lambda path: path.stat().st_mtime)


class Firmware:
    """What is soldered to the machine: its boot loader, the boot loader's environment, and the device tree."""

    def __init__(self, folder, memory):
        self.loader, self.environment = folder / "loader.bin", folder / "environment.bin"
        self.tree = folder / "machine.dtb"
        package = next((SOURCE / "build" / "image" / "debian-arm64").glob("*/u-boot-qemu_*.deb"))
        opened = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE, check=True).stdout
        with open(self.loader, "wb") as loader:
            subprocess.run(["tar", "-xO", "./usr/lib/u-boot/qemu_arm64/u-boot.bin"], input=opened, stdout=loader,
                           check=True)
        words = [line for line in (BOARD / "u-boot.env").read_text().splitlines() if line and not line.startswith("#")]
        text = folder / "environment.txt"
        text.write_text("\n".join(words) + "\n")
        subprocess.run(["mkenvimage", "-s", "0x40000", "-o", self.environment, text], check=True)
        for flash in (self.loader, self.environment):
            os.truncate(flash, 64 << 20)
        dump = [word + f",dumpdtb={self.tree}" if word.startswith("virt") else word for word in MACHINE]
        subprocess.run(["qemu-system-aarch64", *dump, "-m", str(memory)], check=True, stderr=subprocess.DEVNULL)
        subprocess.run(["fdtput", "-t", "s", self.tree, "/pl061@9030000", "gpio-line-names", *LINES], check=True)


class Machine(programs.Page):
    """`cables` are in its two ports from the beginning; `disk` is its card."""

    def __init__(self, cables, folder, disk, memory=256, watchdog=True):
        self.network, self.folder, self.disk, self.memory, self.watchdog = cables, folder, disk, memory, watchdog
        self.firmware = Firmware(folder, memory)
        self.process = None
        self.log = folder / "console.log"

    def power_on(self):
        self.switched_on = time.monotonic()
        team0, darpa0 = self.network.ports
        sockets = [self.folder / name for name in ("qmp", "qtest", "serial")]
        for path in sockets:
            path.unlink(missing_ok=True)
        command = ["setpriv", "--pdeathsig", "KILL",
                   "qemu-system-aarch64", *MACHINE, "-accel", "tcg", "-m", str(self.memory), "-dtb", self.firmware.tree,
                   "-drive", f"if=pflash,format=raw,unit=0,readonly=on,file={self.firmware.loader}",
                   "-drive", f"if=pflash,format=raw,unit=1,file={self.firmware.environment}",
                   *self.disk.options(), "-device", "virtio-rng-pci", "-device", "qemu-xhci,id=usb",
                   "-netdev", f"tap,id=team,fd={team0}", "-device", f"{PORT},id=team0,netdev=team,addr=5",
                   "-netdev", f"tap,id=darpa,fd={darpa0}", "-device", f"{PORT},id=darpa0,netdev=darpa,addr=6",
                   "-qmp", f"unix:{sockets[0]},server=on,wait=off",
                   "-qtest", f"unix:{sockets[1]},server=on,wait=off", "-qtest-log", "/dev/null",
                   "-chardev", f"socket,id=serial,path={sockets[2]},server=on,wait=on", "-serial", "chardev:serial"]
        if self.watchdog:
            command += ["-device", "i6300esb,addr=7", "-action", "watchdog=reset"]
        with open(self.folder / "qemu.log", "ab") as said:
            self.process = self.network.start(self.network.box, *command, stdout=said, stderr=said,
                                              pass_fds=(team0, darpa0))
        self.console = console.Console(sockets[2], self.log)
        self.monitor = qmp.Monitor(sockets[0])
        self.pins = qmp.Pins(sockets[1], self.monitor.gpio_chip())

    def cut_power(self, chance=None):
        """Off, this very moment; with `chance` the disk loses what it may. How many writes that were."""
        self.process.kill()
        self.process.wait()

        for end in (self.pins, self.monitor, self.console):
            end.close()
        self.process = None
        return self.disk.is_off(chance)

    def is_on(self):
        return self.process is not None and self.process.poll() is None

    # What hands and eyes can do at the box.

    def lights(self):
        """{"health": True, ...}; a line that is not an output is dark."""
        levels, outputs = self.monitor.gpio()
        return {name: bool(levels & outputs & (1 << line)) for name, line in LIGHTS.items()}

    def watch_lights(self, seconds, every=0.02):
        """What they showed: a list of (seconds since the first, lights)."""
        began, seen = time.monotonic(), []
        while time.monotonic() - began < seconds:
            seen.append((time.monotonic() - began, self.lights()))
            time.sleep(every)
        return seen

    def press(self, seconds):
        self.pins.set(BUTTON, True)
        time.sleep(seconds)
        self.pins.set(BUTTON, False)

    def plug(self, port, plugged=True):
        """The cable of team0 or darpa0, in or out."""
        self.monitor.ask("set_link", name=port, up=plugged)

    def plug_stick(self, image):
        """A USB stick that cannot be written on, of an image of its bytes."""
        file = {"driver": "file", "filename": str(image), "read-only": True}
        self.monitor.ask("blockdev-add", **{"driver": "raw", "node-name": "stick", "read-only": True, "file": file})
        self.monitor.ask("device_add", driver="usb-storage", bus="usb.0", id="stick", drive="stick")

    def pull_stick(self):
        self.monitor.ask("device_del", id="stick")

    # What a client on the team's side sees.

    def wait_for_answer(self, within=180.0):
        """Until the first answer on team0. How long that took from the power switch on is in `answered_after`; how much
        of this machine's processor time, which is what the clock of an idle one would say, in `cpu_answered_after`."""
        self.wait_until(self.answers, "the box to answer", within)
        self.answered_after, self.cpu_answered_after = time.monotonic() - self.switched_on, self.cpu_seconds()

    def run_view(self):
        return self.ask("GET /adit/run")[1]

    def is_connected(self, endpoint):
        return any(each["connected"] for each in self.run_view()["endpoints"] if each["name"] == endpoint)

    @staticmethod
    def wants(ask, request, **members):
        """Whether the box answers, and these members are so."""
        try:
            said = ask(request)
        except OSError:
            return False
        return all(said[name] == value for name, value in members.items())

    def cpu_seconds(self):
        """Of QEMU, so far."""
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def said_last(self):
        return self.console.said()[-4000:]

    def start_took(self):
        return f"{self.answered_after:.1f} s ({self.cpu_answered_after:.1f} s of this machine's processor)"

    def wait_until(self, condition, what, within=20.0):
        """As programs.wait_until, for a box that may be away; a machine which has ended for good is said to have."""
        def is_so():
            if not self.is_on():
                raise AssertionError(f"QEMU has ended while waiting for {what}:\n"
                                     + (self.folder / "qemu.log").read_text(errors="replace"))
            if "You are in emergency mode" in self.console.said():
                raise AssertionError(f"systemd has given up while waiting for {what}")
            try:
                return condition()
            except (OSError, http.client.HTTPException):
                return False  # the box is away, or turned this one away
        try:
            return programs.wait_until(is_so, what, within)
        except AssertionError as error:
            raise AssertionError(f"{error}\n--- console:\n{self.said_last()}") from None

    def answers(self):
        try:
            return self.ask("GET /adit/session", token=None)[0] == 200
        except (OSError, ValueError):
            return False


def missing():
    """What keeps this machine from starting the other, in words; or ""."""
    wanted = ["qemu-system-aarch64", "qemu-img", "mkenvimage", "fdtput", "mcopy", "mtype", "setpriv", "dpkg-deb"]
    absent = [program for program in wanted if not shutil.which(program)]
    if absent:
        return f"not on this machine: {', '.join(absent)}; toolchain/setup test installs it"
    if not any(IMAGES.glob("adit-qemu-virt-*.img")):
        return "there is no image: toolchain/image qemu-virt makes it"
    return "" if os.path.exists("/dev/net/tun") else "no taps here: /dev/net/tun is missing"
