"""A root shell on the machine's console, which the owner of the card can enable (rootfs/README.md). For things that a user of the box
cannot see or do: hung and killed processes, memory, timing."""

import re
import socket
import threading
import time

import qmp
from patience import patient



class Console:
    """Reads the machine's output into a file, and types commands."""

    def __init__(self, path, log):
        self.socket = qmp.connected(path)
        self.log, self.heard, self.asked = log, b"", 0
        self.news = threading.Condition()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        with open(self.log, "ab") as log:
            while True:
                try:
                    some = self.socket.recv(65536)
                except OSError:
                    some = b""
                if not some:
                    return
                log.write(some)
                log.flush()
                with self.news:
                    self.heard += some
                    self.news.notify_all()

    def said(self):
        with self.news:
            return self.heard.decode(errors="replace")

    def wait_for(self, pattern, within, after=0):
        """The match of a regular expression in the output after byte `after`."""
        within = patient(within)
        end = time.monotonic() + within
        with self.news:
            while True:
                found = re.search(pattern, self.heard[after:], re.DOTALL)
                if found:
                    return found
                left = end - time.monotonic()
                if left <= 0:
                    raise AssertionError(
                        f"the console did not say {pattern!r} within {within:g} s:\n"
                        + self.heard[-2000:].decode(errors="replace")
                    )
                self.news.wait(left)

    def type(self, line):
        self.socket.sendall(line.encode() + b"\n")

    def wait_for_shell(self, within=180.0):
        """Waits until the shell answers. Input before there is a shell is lost, and the boot loader stops if it gets input."""
        end = time.monotonic() + patient(within)
        self.wait_for(rb"Adit: slot .*/ # ", within)
        while True:
            try:
                return self.ask("true", within=5.0)
            except AssertionError:
                if time.monotonic() > end:
                    raise

    def run(self, command, within=120.0):
        """Exit status and output. The marks are typed in two halves, so that their echo does not match."""
        self.asked += 1
        with self.news:
            after = len(self.heard)
        self.type(f"echo be''gin{self.asked}; {command}; echo en''d{self.asked} $?")
        begin, end = (f"{word}{self.asked}".encode() for word in ("begin", "end"))
        found = self.wait_for(begin + rb"\r?\n(.*?)" + end + rb" (\d+)\s", within, after)
        return int(found.group(2)), found.group(1).decode(errors="replace").replace("\r", "")

    def ask(self, command, within=120.0):
        """The output of a command that must succeed."""
        status, said = self.run(command, within)
        if status != 0:
            raise AssertionError(f"{command}: {status}\n{said}")
        return said

    def reload(self):
        """systemctl daemon-reload. PID 1 does not feed the hardware watchdog meanwhile, and an emulated machine on a busy host takes
        longer than the watchdog's 20 s. So it gets ten minutes meanwhile."""
        watchdog = "busctl set-property org.freedesktop.systemd1 /org/freedesktop/systemd1 org.freedesktop.systemd1.Manager RuntimeWatchdogUSec t"
        self.ask(f"{watchdog} 600000000 && systemctl daemon-reload && {watchdog} 20000000")

    def close(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()
        self.reader.join()
