"""Shared by the tests of the recipe: paths, and facts about a board."""
import re
import subprocess
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
BOARDS = sorted(path.parent.name for path in TOP.glob("board/*/board.conf"))
IMAGES = TOP / "build/image"
GROUP = "health", "scoring", "mapping", "attention", "button"  # of a panel
# Commands that every boot loader of a board must have (board/espressobin/README.md).
KNOWN = {"booti", "echo", "env", "load", "part", "reset", "setenv", "size", "sleep", "source", "test", "true"}


def conf(board: str, name: str) -> list[str]:
    """The words of a variable in board.conf, which is Bash."""
    script = f'. "{TOP}/board/{board}/board.conf"; printf "%s\\n" "${{{name}[@]}}"'
    return [word for word in subprocess.run(["bash", "-c", script], check=True, capture_output=True, text=True).stdout.split("\n") if word]


def some(found, otherwise: str = "") -> list:
    """The list of found items. If it is empty, a loop over it would check nothing, so the test is skipped with the reason
    `otherwise`, or fails."""
    found = list(found)
    if not found:
        raise unittest.SkipTest(otherwise) if otherwise else AssertionError("there is nothing to check")
    return found


def built() -> list[str]:
    """The boards that have an image."""
    return [board for board in BOARDS if list((IMAGES / board).glob("*.spdx.json"))]


def nodes(dtb: Path) -> dict[str, dict[str, str]]:
    """The enabled nodes of a device tree, by path, with their properties as dtc writes them."""
    source = subprocess.run(["dtc", "-q", "-I", "dtb", "-O", "dts", dtb], check=True, capture_output=True, text=True).stdout
    open_nodes: list[tuple[str, dict[str, str]]] = []
    found = {}
    for line in map(str.strip, source.splitlines()):
        if line.endswith("{"):
            open_nodes.append((line[:-1].strip().strip("/"), {}))
        elif line == "};":
            path = "/".join(name for name, _ in open_nodes) or "/"
            if not any(properties.get("status") == '"disabled"' for _, properties in open_nodes):
                found[path] = open_nodes[-1][1]
            open_nodes.pop()
        elif match := re.match(r"([^ =]+) = (.*);$", line):
            open_nodes[-1][1][match[1]] = match[2]
    return found
