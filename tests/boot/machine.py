"""The box as a machine: QEMU, started from its card by the boot loader like a board, with two ports, a hardware watchdog, and, if the
board has them, four lights and a button."""

import http.client
import os
import pathlib
import time

import boards
import console
import programs
import qmp

SOURCE, IMAGES = boards.SOURCE, boards.QEMU_VIRT.images
image, missing = boards.QEMU_VIRT.image, boards.QEMU_VIRT.missing
LIGHTS = {"health": 0, "scoring": 1, "mapping": 2, "attention": 4}  # lines of the panel's chip
BUTTON = 5
GAVE_UP = "adit: the start failed"  # rootfs/overlay's emergency.service says so


class Machine(programs.Page):
    """`cables` are plugged in from the beginning; `disk` is the card."""

    def __init__(self, cables, folder, disk, board=boards.QEMU_VIRT):
        self.network, self.folder, self.disk, self.board = cables, folder, disk, board
        self.memory = board.memory
        self.soldered = board.soldered(folder, board.memory)
        self.process = self.pins = None
        self.cuts = 0  # of its power, so far
        self.log = folder / "console.log"

    def power_on(self):
        self.switched_on = time.monotonic()
        team0, darpa0 = self.network.ports
        sockets = [self.folder / name for name in ("qmp", "qtest", "serial")]
        for path in sockets:
            path.unlink(missing_ok=True)
        first, second = self.board.ports
        command = ["setpriv", "--pdeathsig", "KILL",
                   self.board.emulator, *self.soldered, "-accel", "tcg", "-m", str(self.memory),
                   *self.disk.options(self.board.card), "-device", "virtio-rng-pci", "-device", "qemu-xhci,id=usb",
                   "-device", "i6300esb,addr=7", "-action", "watchdog=reset",
                   "-netdev", f"tap,id=team,fd={team0}", "-device", f"{first},id=team0,netdev=team",
                   "-netdev", f"tap,id=darpa,fd={darpa0}", "-device", f"{second},id=darpa0,netdev=darpa",
                   "-qmp", f"unix:{sockets[0]},server=on,wait=off",
                   "-qtest", f"unix:{sockets[1]},server=on,wait=off", "-qtest-log", "/dev/null",
                   "-chardev", f"socket,id=serial,path={sockets[2]},server=on,wait=on", "-serial", "chardev:serial"]
        with open(self.folder / "qemu.log", "ab") as said:
            self.process = self.network.start(self.network.box, *command, stdout=said, stderr=said,
                                              pass_fds=(team0, darpa0))
        self.console = console.Console(sockets[2], self.log)
        self.monitor = qmp.Monitor(sockets[0])
        if self.board.has_panel:
            self.pins = qmp.Pins(sockets[1], self.monitor.gpio_chip())

    def cut_power(self, chance=None):
        """Cuts the power. With `chance`, the disk loses unflushed writes. Returns their number."""
        self.cuts += 1
        self.process.kill()
        self.process.wait()
        for end in (self.pins, self.monitor, self.console):
            if end is not None:
                end.close()
        self.process = None
        return self.disk.is_off(chance)

    def is_on(self):
        return self.process is not None and self.process.poll() is None

    # Actions and observations of a user at the box.

    def lights(self):
        """{"health": True, ...}; a line that is not an output is off."""
        levels, outputs = self.monitor.gpio()
        return {name: bool(levels & outputs & (1 << line)) for name, line in LIGHTS.items()}

    def watch_lights(self, seconds, every=0.02):
        """The lights over time: a list of (seconds since the first, lights)."""
        began, seen = time.monotonic(), []
        while time.monotonic() - began < seconds:
            seen.append((time.monotonic() - began, self.lights()))
            time.sleep(every)
        return seen

    def press(self, seconds):
        self.pins.set(BUTTON, True)
        time.sleep(seconds)
        self.pins.set(BUTTON, False)
        time.sleep(0.2)  # for less, it would be a bounce

    def plug(self, port, plugged=True):
        """Plugs the cable of team0 or darpa0 in or out."""
        self.monitor.ask("set_link", name=port, up=plugged)

    def plug_stick(self, image, name="stick"):
        """Plugs in a read-only USB stick with the bytes of an image."""
        file = {"driver": "file", "filename": str(image), "read-only": True, "locking": "off"}
        self.monitor.ask("blockdev-add", **{"node-name": name, "driver": "raw", "read-only": True, "file": file})
        self.monitor.ask("device_add", driver="usb-storage", bus="usb.0", id=name, drive=name)

    def pull_stick(self, name="stick"):
        self.monitor.ask("device_del", id=name)

    # Observations of a client on the team's side.

    def wait_for_answer(self, within=400.0):
        """Waits for the first answer on team0. `start_took` is the time since power-on."""
        self.wait_until(self.answers, "the box to answer", within)
        self.start_took = self.took((self.switched_on, 0.0))

    def run_view(self):
        return self.ask("GET /adit/run")[1]

    def is_connected(self, endpoint):
        return any(each["connected"] for each in self.run_view()["endpoints"] if each["name"] == endpoint)

    @staticmethod
    def wants(ask, request, **members):
        """Whether the box answers with these members."""
        try:
            said = ask(request)
        except OSError:
            return False
        return all(said[name] == value for name, value in members.items())

    def cpu_seconds(self):
        """QEMU's CPU seconds so far."""
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def moment(self):
        """For took(): the clock, and QEMU's CPU seconds."""
        return time.monotonic(), self.cpu_seconds()

    def took(self, began):
        """The cost since a moment(), in words. CPU seconds say more than the clock, because the host is often busy."""
        (clock, cpu), (clock_then, cpu_then) = self.moment(), began
        return f"{clock - clock_then:.1f} s ({cpu - cpu_then:.1f} s of the host's processors)"

    def said_last(self):
        return self.console.said()[-4000:]

    def wait_until(self, condition, what, within=120.0):
        """As programs.wait_until, for a box that may be unreachable. Fails if the machine has ended."""
        def is_so():
            if not self.is_on():
                raise AssertionError(f"QEMU has ended while waiting for {what}:\n"
                                     + (self.folder / "qemu.log").read_text(errors="replace"))
            if GAVE_UP in self.console.said():
                raise AssertionError(f"systemd has given up while waiting for {what}:\n{self.said_last()}")
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
            return self.ask("GET /adit/session", token=None, timeout=5)[0] == 200
        except (OSError, ValueError):
            return False
