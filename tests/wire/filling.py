"""A full file system."""

import errno
import os


class Filler:
    """A file that uses all free space except `leaves` bytes, whatever other programs write meanwhile."""

    def __init__(self, folder, leaves=0):
        self.path, self.leaves = folder / "filler", leaves
        self.fill()

    def fill(self):
        """Never uses more than that, not even for a moment."""
        with open(self.path, "ab", buffering=0) as file:
            try:
                while (room := self.room()) > 0:
                    file.write(bytes(min(room, 65536)))
            except OSError as error:  # somebody else has taken the last of it
                if error.errno != errno.ENOSPC:
                    raise

    def room(self):
        there_is = os.statvfs(self.path.parent)
        return there_is.f_bavail * there_is.f_frsize - self.leaves

    def make_room(self):
        self.path.unlink()
