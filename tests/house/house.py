"""The rooms of firmware/: their floors; and as their CMakeLists.txt say their order, whom each names, and its public headers."""
import pathlib
import re

FIRMWARE = pathlib.Path(__file__).resolve().parents[2] / "firmware"
FLOORS = {
    "the interface": "icd codec",
    "the rules": "queues pack picture pace dispatch settings network update clock spare access alarms",
    "the doors": "command_line loop store ledger uplink intake panel host spool journal archive",
    "the flow": "forward",
    "the box": "admin box",
    "the faces": "site api cli",
    "the programs": "gateway applier rehearsal",
}


def order():
    text = (FIRMWARE / "CMakeLists.txt").read_text()
    return re.findall(r"add_subdirectory\((\w+)\)", text)


def named_by(room):
    """The rooms that a room's CMakeLists.txt names, and its public headers."""
    rooms, public = set(), set()
    for file in (FIRMWARE / room).rglob("CMakeLists.txt"):
        text = re.sub(r"#[^\n]*", "", file.read_text())
        for call in re.findall(r"adit_room\(([^)]*)\)", text):
            parts = re.split(r"\b(SOURCES|OPTIMIZED_SOURCES|PLATFORM_SOURCES|PUBLIC_HEADERS|ROOMS|LIBRARIES)\b", call)
            lists = dict(zip(parts[1::2], parts[2::2]))
            rooms |= set(lists.get("ROOMS", "").split())
            public |= set(lists.get("PUBLIC_HEADERS", "").split())
        for call in re.findall(r"target_link_libraries\(([^)]*)\)", text):
            rooms |= set(re.findall(r"\badit_(\w+)", call)) - {"options"}
    return rooms - {room}, public


def closure(room, named):
    """The room, those that it names, and what these name."""
    reached, ahead = set(), {room}
    while ahead:
        each = ahead.pop()
        reached.add(each)
        ahead |= named.get(each, set()) - reached
    return reached
