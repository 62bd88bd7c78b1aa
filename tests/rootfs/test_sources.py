"""toolchain/sources fetches each source that a list of parts names, or names those that are missing. A stand-in for apt-get has an archive."""
import hashlib
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import TOP

APT_GET = """#!/bin/sh
[ "$1" = source ] || exit 0
for last; do :; done
version=${last#*=}
cp "$ARCHIVE/${last%%=*}_${version#*:}".* .
"""


def part(name, sources, supplier="Organization: Debian"):
    return {"name": name, "supplier": supplier, "sourceInfo": sources}


class Sources(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for path in "toolchain", "bin", "archive", "build/image/debian-amd64/root/etc/apt":
            (self.folder / path).mkdir(parents=True)
        shutil.copy(TOP / "toolchain/sources", self.folder / "toolchain")
        (self.folder / "build/image/debian-amd64/root/etc/apt/sources.list").write_text("deb http://archive.invalid/debian bookworm main\n")
        (self.folder / "bin/apt-get").write_text(APT_GET)
        (self.folder / "bin/apt-get").chmod(0o755)
        for name in "foo_1.2-3", "bar_9.5-2":
            self.put(name)
        self.parts = [part("libfoo1", "built from Debian's source packages foo (1.2-3)"), {"name": "adit", "supplier": "NOASSERTION"},
                      part("bar", "built from Debian's source packages bar (1:9.5-2), foo (1.2-3)")]

    def put(self, name):
        """Into the archive: a source of one file and its description."""
        content = name.encode()
        (self.folder / "archive" / f"{name}.tar.xz").write_bytes(content)
        (self.folder / "archive" / f"{name}.dsc").write_text(
            f"Source: x\nChecksums-Sha1:\n {'0' * 40} 1 none\nChecksums-Sha256:\n {hashlib.sha256(content).hexdigest()} 9 {name}.tar.xz\nFiles:\n {'0' * 32} 1 none\n")

    def sources(self, *options):
        (self.folder / "parts").write_text(json.dumps({"packages": self.parts}))
        done = subprocess.run([self.folder / "toolchain/sources", *options, self.folder / "out", self.folder / "parts"], capture_output=True, text=True,
                              check=False, env={**os.environ, "ARCHIVE": str(self.folder / "archive"), "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        return done.returncode, done.stdout, done.stderr

    def test_each_is_fetched_once_and_listed_with_its_file(self):
        status, said, why = self.sources()
        self.assertEqual(status, 0, why)
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()),
                         ["bar_9.5-2.dsc", "bar_9.5-2.tar.xz", "foo_1.2-3.dsc", "foo_1.2-3.tar.xz"])
        self.assertEqual(said.splitlines()[2:], ["| bar | [1:9.5-2](https://snapshot.debian.org/package/bar/1:9.5-2/) | `bar_9.5-2.dsc` |",
                                                 "| foo | [1.2-3](https://snapshot.debian.org/package/foo/1.2-3/) | `foo_1.2-3.dsc` |"])
        self.assertEqual((self.folder / "build/sources/sources.list").read_text(), "deb-src http://archive.invalid/debian bookworm main\n")

    def test_without_fetching_the_list_is_the_same(self):
        (self.folder / "bin/apt-get").write_text("#!/bin/sh\ntouch called\nexit 1\n")
        status, said, _ = self.sources("--no-fetch")
        self.assertEqual((status, len(said.splitlines())), (0, 4))
        self.assertFalse((self.folder / "out").exists())

    def test_each_that_is_missing_or_incomplete_is_named_and_no_list_is_printed(self):
        for harm in (lambda path: path.unlink(), lambda path: path.write_bytes(b"other")):
            for kind in "dsc", "tar.xz":
                with self.subTest(kind):
                    for name in "foo_1.2-3", "bar_9.5-2":
                        self.put(name)
                        harm(self.folder / f"archive/{name}.{kind}")
                    shutil.rmtree(self.folder / "out", ignore_errors=True)
                    status, said, why = self.sources()
                    self.assertEqual((status, said), (1, ""))
                    self.assertIn("\nbar 1:9.5-2\nfoo 1.2-3\n", why)

    def test_a_part_of_debians_without_a_source_is_refused(self):
        for sources in "", "built from foo":
            self.parts.append(part("baz", sources))
            for options in [], ["--no-fetch"]:
                status, said, why = self.sources(*options)
                self.assertEqual((status, said), (1, ""))
                self.assertIn("without a source package: baz", why)
        self.parts = []
        self.assertIn("name no source package", self.sources()[2])

    def test_an_archive_that_cannot_be_read_is_an_error(self):
        (self.folder / "bin/apt-get").write_text("#!/bin/sh\nexit 100\n")
        self.assertIn("apt cannot read the lists", self.sources()[2])
        (self.folder / "build/image/debian-amd64/root/etc/apt/sources.list").unlink()
        self.assertIn("no archive to fetch from", self.sources()[2])
