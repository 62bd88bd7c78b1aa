"""The man pages and completions that toolchain/manuals makes for the programs in $ADIT_BIN, made once per test program."""

import functools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

BIN = pathlib.Path(os.environ["ADIT_BIN"])
SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
FIXED = ["adit", "aditd", "adit-network", "adit-import", "adit-update", "adit-spare", "adit-certificate", "adit-panel", "adit-rehearsal", "adit-robots"]
PROGRAMS = [name for name in FIXED if (BIN / name).exists()]  # those to rehearse with may not be built

sys.path.insert(0, str(SOURCE / "toolchain"))
from manual.described import Program  # noqa: E402


@functools.cache
def made():
    """Their directory, laid out as share/. It is removed with the program."""
    folder = tempfile.TemporaryDirectory(prefix="adit-manuals-")
    made.kept = folder
    subprocess.run([SOURCE / "toolchain" / "manuals", folder.name, SOURCE / "firmware/rules/settings/example.json",
                    *(BIN / name for name in PROGRAMS)],
                   check=True, env={**os.environ, "SOURCE_DATE_EPOCH": "1566309785"})
    return pathlib.Path(folder.name)


@functools.cache
def program(name):
    return Program(BIN / name)


def options_in(text):
    """All options and words in --help, found in its text as a reader finds them."""
    block = next(block for block in text.split("\n\n") if "\n  --help " in block)
    return re.findall(r"^  ([a-z-][a-z-]*)", block, re.M)


@functools.cache
def help_of(*words):
    return subprocess.run([BIN / words[0], *words[1:], "--help"], check=True, capture_output=True, text=True).stdout
