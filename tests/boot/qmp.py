"""QEMU from outside: its monitor (QMP), with which a test reads the lights' lines, and qtest, with which it presses the button."""

import json
import socket
import time

PL061_REGISTERS = 0x90303FC  # all eight lines' levels, and beside them which of them are outputs


class Monitor:
    """A connection to QEMU's machine protocol."""

    def __init__(self, path):
        self.socket = connected(path)
        self.lines = self.socket.makefile("rwb")
        self.lines.readline()  # its greeting
        self.ask("qmp_capabilities")

    def ask(self, command, **arguments):
        self.lines.write(json.dumps({"execute": command, "arguments": arguments}).encode() + b"\n")
        self.lines.flush()
        while True:
            line = self.lines.readline()
            if not line:
                raise ConnectionError("QEMU has ended")
            said = json.loads(line)
            if "error" in said:
                raise AssertionError(f"{command}: {said['error']['desc']}")
            if "return" in said:
                return said["return"]

    def human(self, command):
        return self.ask("human-monitor-command", **{"command-line": command})

    def gpio(self):
        """Levels and directions of the PL061's lines, as two numbers of eight bits."""
        words = self.human(f"xp /2wx {PL061_REGISTERS:#x}").split(":")[1].split()
        return tuple(int(word, 16) for word in words)

    def gpio_chip(self):
        """The chip's path among QEMU's objects, for qtest."""
        for line in self.human("info qom-tree /machine/unattached").splitlines():
            if "(pl061)" in line:
                return "/machine/unattached/" + line.split()[0].strip("/")
        raise AssertionError("the machine has no PL061")

    def close(self):
        self.lines.close()
        self.socket.close()


class Pins:
    """Drives the machine's inputs with the protocol of QEMU's own tests."""

    def __init__(self, path, chip):
        self.socket, self.chip = connected(path), chip
        self.lines = self.socket.makefile("rwb")

    def set(self, line, level):
        self.lines.write(f"set_irq_in {self.chip} unnamed-gpio-in {line} {level:d}\n".encode())
        self.lines.flush()
        said = self.lines.readline()
        if not said.startswith(b"OK"):
            raise AssertionError(f"qtest: {said!r}")

    def close(self):
        self.lines.close()
        self.socket.close()


def connected(path, within=60.0):
    """Connects to a socket that QEMU is about to make."""
    end = time.monotonic() + within
    while True:
        made = socket.socket(socket.AF_UNIX)
        try:
            made.connect(str(path))
            return made
        except (FileNotFoundError, ConnectionRefusedError):
            made.close()
            if time.monotonic() > end:
                raise
            time.sleep(0.02)
