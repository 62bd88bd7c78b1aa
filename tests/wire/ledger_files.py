"""A reader of the ledger's files that shares no code with aditd, written from firmware/doors/store/README.md and
firmware/doors/ledger/README.md. It repairs no damage: a missing record is an error."""

import re
import struct
import typing
import zlib

NAME = re.compile(r"(log|snapshot)-(\d{8})\.([0-9a-f]{16})")
HEADER = struct.Struct("<4sIIBBHQQQ")  # magic, CRC, length, kind, copy, zeros, sequence, process, durable
BEGINS, ENDS, STEPS = 0, 127, 1  # kinds
ON_DISK, IN_SNAPSHOT = 4096, 8  # alignment
LAYOUTS = {"report": "number:n type:t x:r y:r z:r robot:t sender:t received:r changed:r state:t note:t run:n asked:n same_as:n tries:n "
                     "sending:n sent:r before:s status:n content_type:t answer:t reconciled:n "
                     "beside:n counted:n uncertain:t",
           "run": "number:n id:t began:r why:t last:s heard:r post:t unreliable:t turn:n may_be:n status_clock:c answer_clock:c "
                  "signs:g name_trouble:t"}


class Damaged(Exception):
    """Records are missing."""


class Frame(typing.NamedTuple):
    kind: int
    sequence: int
    durable: int
    body: bytes


def frames(file, align):
    """The file's frames in order, each once."""
    data, salt = file.read_bytes(), int(NAME.fullmatch(file.name)[3], 16)
    found, newest, at = {}, 0, 0
    while at + HEADER.size <= len(data):
        magic, crc, length, kind, _, _, sequence, process, durable = HEADER.unpack_from(data, at)
        end = at + HEADER.size + length
        if magic != b"ADTL" or end > len(data) or zlib.crc32(struct.pack("<QQ", salt, at) + data[at + 8:end]) != crc:
            at += align
            continue
        if process >= newest:  # else the newer process did not know it
            newest = process
            found.setdefault(sequence, Frame(kind, sequence, durable, data[at + HEADER.size:end]))
        at += -(-(HEADER.size + length) // align) * align
    return list(found.values())


def write_stamps(file, floor, wall):
    """Writes `stamps` of the state directory: one frame in two copies, with salt 0."""
    body, data = struct.pack("<3d4Q2d", floor, wall, 0, 0, 0, 0, 0, 0, 0), b""
    for copy in (0, 1):
        data = data.ljust(copy * ON_DISK, b"\0")
        frame = HEADER.pack(b"ADTL", 0, len(body), 1, copy, 0, 0, 0, 0) + body
        data += frame[:4] + struct.pack("<I", zlib.crc32(struct.pack("<QQ", 0, copy * ON_DISK) + frame[8:])) + frame[8:]
    file.write_bytes(data)


def base(file_frames):
    """The base in the file's header; None if the file is empty."""
    if file_frames and file_frames[0].kind != BEGINS:
        raise Damaged("a file without a header")
    return struct.unpack_from("<5Q", file_frames[0].body)[3] if file_frames else None


def snapshot(file):
    """The records of a snapshot, and the sequence number up to which it replaces the log."""
    found = frames(file, IN_SNAPSHOT)
    if [each.sequence for each in found] != list(range(len(found))) or found[-1].kind != ENDS:
        raise Damaged(file.name)
    return [(each.kind, each.body) for each in found[1:-1]], base(found)


def records(directory):
    """(kind, body) of each record, in order."""
    files = sorted((int(name[2]), name[1], directory / name[0])
                   for name in (NAME.fullmatch(each.name) for each in directory.iterdir()) if name)
    snapshots = [(number, file) for number, what, file in files if what == "snapshot"]
    said, last = snapshot(snapshots[-1][1]) if snapshots else ([], 0)
    first = snapshots[-1][0] if snapshots else 0
    logs = [frames(file, ON_DISK) for number, what, file in files if what == "log" and number >= first]
    bases = [base(log) for log in logs]
    durable = max([last, *(each for each in bases if each), *(frame.durable for log in logs for frame in log)])
    for place, log in enumerate(logs):
        void = min((each for each in bases[place + 1:] if each is not None), default=2**64)
        for frame in log[1:]:
            if frame.sequence > last + 1 and frame.sequence <= void:
                if last >= durable:
                    return said  # a torn end, which was never synced
                raise Damaged(f"records {last + 1} to {frame.sequence - 1}")
            if last < frame.sequence <= void:
                said, last = [*said, (frame.kind, frame.body)], frame.sequence
    if last < durable:
        raise Damaged(f"records {last + 1} to {durable}")
    return said


class Values:
    """Reads the values of a record one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def raw(self, size):
        self.at += size
        if self.at > len(self.data):
            raise Damaged("a record that ends too early")
        return self.data[self.at - size:self.at]

    def n(self):
        return int.from_bytes(self.raw(8), "little", signed=True)

    def r(self):
        return struct.unpack("<d", self.raw(8))[0]

    def part(self):
        return self.raw(self.n())

    def t(self):
        return self.part().decode(errors="surrogateescape")

    def s(self):
        known, *status = self.n(), self.n(), self.r(), self.n(), self.t()
        return status if known else None

    def c(self):
        known, *clock = self.n(), self.r(), self.n()
        return clock if known else None

    def g(self):
        return [self.n() for _ in range(4)]

    def members(self, layout):
        return {name: getattr(self, kind)() for name, kind in (member.split(":") for member in LAYOUTS[layout].split())}

    def steps(self):
        steps = []
        while self.at < len(self.data):
            steps.append((self.r(), self.t(), self.t()))
        return steps


def read(directory):
    """The latest reports and runs by number. A report's `history` has its steps: (when, state, note)."""
    reports, runs = {}, {}
    for kind, body in records(directory):
        if kind != STEPS:
            raise Damaged(f"a record of the unknown kind {kind}")
        record = Values(body)
        record.n()  # the highest number
        for _ in range(record.n()):
            report, steps = Values(record.part()).members("report"), Values(record.part()).steps()
            history = reports.get(report["number"], {"history": []})["history"]
            reports[report["number"]] = {**report, "history": history + steps}
        for _ in range(record.n()):
            run = Values(record.part()).members("run")
            runs[run["number"]] = run
    return reports, runs
