"""The rooms of firmware/: their floors; and from their CMakeLists.txt their order, the rooms that they name, and their public
headers."""
import pathlib
import re

FIRMWARE = pathlib.Path(__file__).resolve().parents[2] / "firmware"
ROOMS = re.findall(r"add_subdirectory\((\w+)/(\w+)\)", (FIRMWARE / "CMakeLists.txt").read_text())  # floor and room, in order


def order():
    return [room for _, room in ROOMS]


def floors():
    """The rooms of each floor, bottom up."""
    rooms = {}
    for floor, room in ROOMS:
        rooms.setdefault(floor, []).append(room)
    return rooms


def folder(room):
    return next(FIRMWARE / floor / room for floor, name in ROOMS if name == room)


def named_by(room):
    """The rooms that a room's CMakeLists.txt names, and its public headers."""
    rooms, public = set(), set()
    for file in folder(room).rglob("CMakeLists.txt"):
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
    """The room, the rooms that it names, and theirs."""
    reached, ahead = set(), {room}
    while ahead:
        each = ahead.pop()
        reached.add(each)
        ahead |= named.get(each, set()) - reached
    return reached
