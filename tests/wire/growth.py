"""The resources of a process over time: memory, descriptors, timers and threads."""

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
    """Its descriptors as the kernel names them: "socket:[12]", "/a/file"."""
    folder = pathlib.Path(f"/proc/{pid}/fd")
    links = []
    for name in os.listdir(folder):
        with contextlib.suppress(FileNotFoundError):  # closed since it was listed
            links.append(os.readlink(folder / name))
    return links


def held(pid):
    """Its resources now."""
    process = pathlib.Path(f"/proc/{pid}")
    status = (process / "status").read_text(encoding="ascii", errors="replace")
    links = descriptors(pid)
    return Held(memory=int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) << 10, descriptors=len(links),
                timers=links.count("anon_inode:[timerfd]"), threads=int(re.search(r"Threads:\s+(\d+)", status)[1]))


class Watch(threading.Thread):
    """Measures once a second."""

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
        """The medians of the first and of the last third of the time, in bytes."""
        third = max(1, len(self.seen) // 3)
        return tuple(statistics.median(each.memory for each in part) for part in (self.seen[:third], self.seen[-third:]))
