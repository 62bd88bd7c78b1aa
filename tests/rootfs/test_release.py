#!/usr/bin/python3 -B
"""test_release.py BUILD [--refusals]: checks a release of this build and one board as its README says. Other files are rejected (only
these checks with --refusals). Needs the requirements of tests/boot's container."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

from recipe import TOP

BUILD = sys.argv[1]
VERSION = subprocess.run([TOP / "toolchain/version"], capture_output=True, text=True, check=True).stdout.strip()
FOLDER = TOP / f"build/release-{VERSION}"


def release(*words, **signer):
    done = subprocess.run([TOP / "toolchain/release", *words], capture_output=True, text=True, check=False, env={**os.environ, **signer})
    return done.returncode, done.stdout + done.stderr


def shell(script, good=True):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=FOLDER, capture_output=True, text=True, check=False)
    assert (done.returncode == 0) == good, f"{script}: {done.stdout}{done.stderr}"


def pair(folder, name, days="30", kind=("ec", "-pkeyopt", "ec_paramgen_curve:P-256")):
    """A key and its certificate."""
    key, certificate = f"{folder}/{name}.key", f"{folder}/{name}.cert"
    subprocess.run(["openssl", "req", "-x509", "-newkey", *kind, "-nodes", "-subj", f"/CN={name}", "-days", days, "-keyout", key, "-out", certificate],
                   check=True, capture_output=True)
    return key, certificate


def refuses_who_cannot_sign():
    """Before it builds."""
    with tempfile.TemporaryDirectory() as folder:
        (key, certificate), (other, _), (old, at_its_end) = pair(folder, "team"), pair(folder, "other"), pair(folder, "old", days="1")
        short, of_short = pair(folder, "short", kind=["ed25519"])
        team = {"ADIT_SIGNING_KEY": key, "ADIT_SIGNING_CERT": certificate, "ADIT_APT_KEY": "0" * 40, "ADIT_MAINTAINER": "Team <team@adit.invalid>"}
        for signer, why in (({"ADIT_SIGNING_KEY": key}, "belong together"), ({"ADIT_SIGNING_CERT": certificate}, "belong together"),
                            ({"ADIT_SIGNING_KEY": f"{folder}/none", "ADIT_SIGNING_CERT": certificate}, "is no private key"),
                            ({"ADIT_SIGNING_KEY": other, "ADIT_SIGNING_CERT": certificate}, "is not the key of the certificate"),
                            ({"ADIT_SIGNING_KEY": old, "ADIT_SIGNING_CERT": at_its_end}, "ends within a week"),
                            ({"ADIT_SIGNING_KEY": short, "ADIT_SIGNING_CERT": of_short}, "cannot sign by SHA-256"),
                            ({"ADIT_SIGNING_KEY": key, "ADIT_SIGNING_CERT": certificate}, "ADIT_APT_KEY is not"),
                            ({"ADIT_SIGNING_KEY": key, "ADIT_SIGNING_CERT": certificate, "ADIT_APT_KEY": "0" * 40}, "ADIT_MAINTAINER is not"),
                            (team, "ADIT_STANDBY_CERT is not"),
                            (team | {"ADIT_STANDBY_CERT": certificate}, "expected the certificate of another key"),
                            ({"ADIT_APT_KEY": "nobody@adit.invalid"}, "expected a fingerprint"),
                            ({"ADIT_APT_KEY": "0" * 40}, "GnuPG cannot sign by the key")):
            status, said = release("--programs", BUILD, VERSION, "generic-x86_64", **signer)
            assert status != 0 and why in said, said


def main():
    for program in ("mmdebstrap", "mksquashfs", "mkimage", "dpkg-buildpackage", "dh"):
        if os.geteuid() != 0 or not shutil.which(program):
            print(f"skipped: needs root and {program}")
            sys.exit(77)
    for words, why in (((), "which version?"), (("9.9.9",), f"has version {VERSION}, not 9.9.9"), ((VERSION, "toaster"), "no board 'toaster'")):
        status, said = release("--programs", BUILD, *words)
        assert status != 0 and why in said, said
    if "(unreleased)" in (TOP / "CHANGELOG.md").read_text():  # with a date it would begin an hour's work
        status, said = release(VERSION)
        assert status != 0 and f"CHANGELOG.md gives {VERSION} no date" in said, said
    refuses_who_cannot_sign()
    if "--refusals" in sys.argv:
        return
    status, said = release("--no-sources", "--programs", BUILD, VERSION, "generic-x86_64")
    assert status == 0, said
    readme = (FOLDER / "README.md").read_text()
    check = re.search(r"```\n(.*?)```", readme, re.S)[1]
    shell(check)
    assert re.search(r"\n    sha256 Fingerprint=(\w\w:){31}\w\w\n", readme) and "a key of one checkout alone" in readme, readme
    assert re.search(r"\n\| linux \| \[6\.[^]]+\]\(https://snapshot\.debian\.org/package/linux/6\.[^)]+/\) \| `linux_6\..*\.dsc` \|\n", readme), readme
    assert (FOLDER / "CHANGES.md").read_text().startswith(f"# Adit {VERSION}\n")
    listed = {line.split()[1] for line in (FOLDER / "SHA256SUMS").read_text().splitlines()}
    present = {str(path.relative_to(FOLDER)) for path in FOLDER.rglob("*") if path.is_file()}
    assert present == listed | {"SHA256SUMS", "SHA256SUMS.sig", "adit.pub"}, present ^ listed
    for kind in ("apt/dists/bookworm/InRelease", f"adit_{VERSION}.dsc", f"adit_{VERSION}.tar.xz", f"apt/pool/bookworm/adit_{VERSION}_", f"adit_{VERSION}_", f"adit-rehearsal_{VERSION}_", ".oci.tar", ".oci.spdx.json", ".raucb", ".img", f"64-{VERSION}.spdx.json"):
        assert any(kind in name for name in listed), kind
    with open(FOLDER / "CHANGES.md", "a", encoding="utf-8") as changes:
        changes.write("And more.\n")
    shell(check, good=False)
    shell("echo >>SHA256SUMS; openssl dgst -sha256 -verify adit.pub -signature SHA256SUMS.sig SHA256SUMS", good=False)


main()
