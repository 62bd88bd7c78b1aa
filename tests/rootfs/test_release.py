#!/usr/bin/python3 -B
"""A release as its README has it checked, of this build and one board; and what is no release is refused. Needs what tests/boot's
container needs."""
import os
import re
import shutil
import subprocess
import sys

from recipe import TOP, skip

BUILD = sys.argv[1]
VERSION = subprocess.run([TOP / "toolchain/version"], capture_output=True, text=True, check=True).stdout.strip()
FOLDER = TOP / f"build/release-{VERSION}"


def release(*words):
    done = subprocess.run([TOP / "toolchain/release", *words], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def shell(script, good=True):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=FOLDER, capture_output=True, text=True, check=False)
    assert (done.returncode == 0) == good, f"{script}: {done.stdout}{done.stderr}"


def main():
    for program in ("mmdebstrap", "mksquashfs", "mkimage", "dpkg-buildpackage", "dh"):
        if os.geteuid() != 0 or not shutil.which(program):
            skip(f"needs root and {program}")
    for words, why in (((), "which version?"), (("9.9.9",), f"has version {VERSION}, not 9.9.9"), ((VERSION, "toaster"), "no board 'toaster'")):
        status, said = release("--programs", BUILD, *words)
        assert status != 0 and why in said, said
    status, said = release("--programs", BUILD, VERSION, "generic-x86_64")
    assert status == 0, said
    readme = (FOLDER / "README.md").read_text()
    check = re.search(r"```\n(.*?)```", readme, re.S)[1]
    shell(check)
    assert (FOLDER / "CHANGES.md").read_text().startswith(f"# Adit {VERSION}\n")
    listed = {line.split()[1] for line in (FOLDER / "SHA256SUMS").read_text().splitlines()}
    present = {path.name for path in FOLDER.iterdir()}
    assert present == listed | {"SHA256SUMS", "SHA256SUMS.sig", "adit.pub"}, present ^ listed
    for kind in (f"adit_{VERSION}_", f"adit-rehearsal_{VERSION}_", ".oci.tar", ".raucb", ".img", ".spdx.json"):
        assert any(kind in name for name in listed), kind
    with open(FOLDER / "CHANGES.md", "a", encoding="utf-8") as changes:
        changes.write("And more.\n")
    shell(check, good=False)
    shell("echo >>SHA256SUMS; openssl dgst -sha256 -verify adit.pub -signature SHA256SUMS.sig SHA256SUMS", good=False)


main()
