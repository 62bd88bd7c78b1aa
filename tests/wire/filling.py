"""A file system that is full."""

import errno


class Filler:
    """A file that takes up all the room there is but `leaves` bytes, whatever others write meanwhile."""

    def __init__(self, folder, leaves=0):
        self.path, self.leaves = folder / "filler", leaves
        self.fill()

    def fill(self):
        with open(self.path, "ab", buffering=0) as file:
            for size in (65536, 4096, 1):
                try:
                    while file.write(bytes(size)):
                        pass
                except OSError as error:
                    if error.errno != errno.ENOSPC:
                        raise
            file.truncate(max(file.tell() - self.leaves, 0))

    def make_room(self):
        self.path.unlink()
