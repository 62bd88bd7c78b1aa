"""A machine's disk that loses as much in a power cut as a real one may.

QEMU that is killed leaves all writes of the guest in the host's cache: a cut without loss. So QEMU writes to
a copy that is thrown away, and keeps a log of each write and flush beside it, in the order in which they ended. Once the
machine is off, the log is played back on the disk itself: after a power cut all up to the last flush, and of what was
written since, each write or not, by chance, as a disk does that has a cache of its own and no battery.
"""

import random
import struct
import subprocess

SECTOR = 512
MAGIC = 0x6A736677736872
BOOT_PARTITION = 17 << 20  # where rootfs/disk puts it
FLUSH, FUA, DISCARD = 1, 2, 4  # flags of a write, as Linux's dm-log-writes has them


class Disk:
    def __init__(self, folder, image, size="1G"):
        """A copy of `image` on a card of `size`."""
        self.file, self.copy, self.log = folder / "disk.img", folder / "disk.qcow2", folder / "writes.log"
        subprocess.run(["cp", "--sparse=always", "--reflink=auto", image, self.file], check=True)
        subprocess.run(["truncate", "-s", size, self.file], check=True)

    def options(self, device):
        """QEMU's options for this disk, from a new copy on."""
        subprocess.run(["qemu-img", "create", "-q", "-f", "qcow2", "-b", self.file, "-F", "raw", self.copy], check=True)
        self.log.write_bytes(b"")
        quick = "cache.no-flush=on"  # what the guest flushes is in the log; the host need not wait for its own disk
        copy = f"driver=qcow2,node-name=copy,{quick},file.driver=file,file.{quick},file.filename={self.copy}"
        return ["-blockdev", copy,
                "-blockdev", f"driver=file,node-name=log,{quick},filename={self.log}",
                "-blockdev", "driver=blklogwrites,node-name=disk,file=copy,log=log",
                "-device", f"{device},drive=disk"]

    def is_off(self, chance=None):
        """Plays the log back: all of it, or with a `chance` (random.Random) as after a power cut. Returns the number of lost writes."""
        writes = list(entries(self.log))
        flushed = max((index for index, (flags, *_) in enumerate(writes) if flags & FLUSH), default=-1)
        lost = 0
        with open(self.log, "rb") as log, open(self.file, "r+b") as disk:
            for index, (flags, sector, length, at) in enumerate(writes):
                if flags & DISCARD or not length:
                    continue
                if chance and index > flushed and not flags & FUA and chance.random() < 0.5:
                    lost += 1
                    continue
                play(log, at, disk, sector * SECTOR, length)
        return lost

    def has_flushed(self, text):
        """Whether a power cut cannot lose these bytes: they were written since power-on, and flushed afterwards."""
        writes = list(entries(self.log))
        flushed = max((index for index, (flags, *_) in enumerate(writes) if flags & FLUSH), default=0)
        with open(self.log, "rb") as log:
            for _, _, length, at in writes[:flushed]:
                log.seek(at)
                if text in log.read(length):
                    return True
        return False

    # The boot partition, as seen with a card reader.
    def put(self, name, text):
        """Puts a file on the FAT partition: put("adit/settings.json", "...")."""
        subprocess.run(["mcopy", "-o", *self._boot_partition(), "-", f"::{name}"], input=text.encode(), check=True)

    def make_folder(self, name):
        subprocess.run(["mmd", *self._boot_partition(), f"::{name}"], check=True)

    def _boot_partition(self):
        return ["-i", f"{self.file}@@{BOOT_PARTITION}"]


def entries(path):
    """For each write in the log: its flags, sector, length, and the place of its bytes."""
    size = path.stat().st_size
    with open(path, "rb") as log:
        head = log.read(SECTOR)
        if len(head) < SECTOR:
            return  # nothing was flushed yet, so that its head was not written either
        magic, _, _, sector_size = struct.unpack_from("<QQQL", head)
        if magic not in (MAGIC, 0) or (magic and sector_size != SECTOR):
            raise AssertionError(f"{path}: not a log of writes: {head[:28].hex()}")
        at = SECTOR
        while at + SECTOR <= size:
            log.seek(at)
            sector, count, flags, _ = struct.unpack_from("<QQQQ", log.read(SECTOR))
            if not count and not flags:
                return
            length = 0 if flags & (DISCARD | FLUSH) else count * SECTOR
            at += SECTOR
            if at + length > size:
                return  # QEMU was killed while it wrote this
            yield flags, sector, length, at
            at += length


def play(log, at, disk, to, length):
    """Copies bytes, a megabyte at a time. Skips zeros over zeros, so that the disk stays a sparse file."""
    log.seek(at)
    for done in range(0, length, 1 << 20):
        some = log.read(min(1 << 20, length - done))
        disk.seek(to + done)
        if some.count(0) == len(some) and disk.read(len(some)) == some:
            continue
        disk.seek(to + done)
        disk.write(some)


def dice(seed):
    return random.Random(seed)
