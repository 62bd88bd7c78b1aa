"""What a process holds, as it goes on: memory, descriptors, timers and threads."""

import contextlib
import dataclasses
import os
import pathlib
import re
import statistics
import threading


@dataclasses.dataclass(frozen=True)
class Held:
    memory: int  # bytes of its own, not of files
    descriptors: int
    timers: int
    threads: int


def descriptors(pid):
    """What its descriptors are, as the kernel says it: "socket:[12]", "/a/file"."""
    folder = pathlib.Path(f"/proc/{pid}/fd")
    links = []
    for name in os.listdir(folder):
        with contextlib.suppress(FileNotFoundError):  # closed since it was listed
            links.append(os.readlink(folder / name))
    return links


def held(pid):
    """What it holds now."""
    process = pathlib.Path(f"/proc/{pid}")
    status = (process / "status").read_text(encoding="ascii", errors="replace")
    links = descriptors(pid)
    return Held(memory=int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) << 10, descriptors=len(links),
                timers=links.count("anon_inode:[timerfd]"), threads=int(re.search(r"Threads:\s+(\d+)", status)[1]))


class Watch(threading.Thread):
    """Looks once a second."""

    def __init__(self, pid):
        super().__init__(daemon=True)
        self.pid, self.seen, self.over = pid, [], threading.Event()

    def run(self):
        while not self.over.wait(1):
            self.seen.append(held(self.pid))

    def stop(self):
        self.over.set()
        self.join(10)

    def memory(self):
        """The median at the beginning and at the end, of a third of the time each, in bytes."""
        third = max(1, len(self.seen) // 3)
        return tuple(statistics.median(each.memory for each in part) for part in (self.seen[:third], self.seen[-third:]))
