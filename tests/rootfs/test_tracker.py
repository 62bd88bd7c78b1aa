"""toolchain/tracker lists open entries of the parts, and rejects remote ones without an exception."""
import json
import pathlib
import subprocess
import tempfile
import unittest

from recipe import TOP

OPEN = {"bookworm": {"status": "open", "urgency": "medium"}}


def part(name, version, source):
    return {"name": name, "versionInfo": version, "supplier": "Organization: Debian", "sourceInfo": f"built from Debian's source packages {source}"}


PARTS = [part("libssl3", "3.0.1-1", "openssl (3.0.1-1)"), part("libfoo1", "1.2-3+b1", "foo (1.2-3)"), part("bar", "2:1-1", "bar (1:9.5-2)"),
         part("linux-image-6.1.0-1-amd64", "6.1.192-2", "linux-signed-amd64 (6.1.192+2), linux (6.1.192-2)"), {"name": "adit"}]


class Tracker(unittest.TestCase):
    def check(self, found, exposed="faces foo bytes\n", parts=None):
        """`found`: entries by source package."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "data").write_text(json.dumps({"linux": {}, "glibc": {}, "openssl": {}, **found}))
            (folder / "exposed").write_text(exposed)
            (folder / "parts").write_text(json.dumps({"packages": PARTS if parts is None else parts}))
            done = subprocess.run([TOP / "toolchain/tracker", *(folder / each for each in ("data", "exposed", "parts"))],
                                  capture_output=True, text=True, check=False)
            return done.returncode, done.stdout, done.stderr

    def one(self, source="openssl", exposed="faces foo bytes\n", releases=None, parts=None, **entry):
        return self.check({source: {"CVE-2026-1": {"description": "Bytes are read.", "releases": releases or OPEN, **entry}}}, exposed, parts)

    def test_without_an_open_entry_a_release_passes(self):
        status, said, _ = self.check({"other": {"CVE-2026-1": {"releases": OPEN, "scope": "remote"}}})
        self.assertEqual(status, 0)
        self.assertIn("0 open entries", said)
        self.assertNotIn("Rebuild", said)
        self.assertIn("not packages of Debian: adit", said)

    def test_remote_entry_is_rejected_unless_excused(self):
        for exposed in "", "excuse openssl CVE-2026-2 other\n", "excuse openssl * all\n", "excuse foo CVE-2026-1 other\n":
            status, said, why = self.one(scope="remote", exposed=exposed)
            self.assertEqual(status, 1, exposed)
            self.assertIn("| openssl | CVE-2026-1 | remote | medium | **not excused** |", said)
            self.assertIn("openssl CVE-2026-1 (remote): Bytes are read.", why)
        status, said, _ = self.one(scope="remote", exposed="excuse openssl CVE-2026-1 Adit has no such server.\n")
        self.assertEqual(status, 0)
        self.assertIn("| Adit has no such server. |", said)
        self.assertRegex(said, r"1 open entry on .*\. Rebuild by 20")

    def test_unknown_scope_counts_as_remote_for_network_parts(self):
        self.assertEqual(self.one("foo")[0], 1)
        self.assertEqual(self.one("foo", exposed="faces foo bytes\nexcuse foo * not used\n")[0], 0)
        self.assertEqual(self.one("foo", scope="local")[0], 0)
        self.assertEqual(self.one("bar")[0], 0)

    def test_entry_is_open_before_the_fixed_version(self):
        for source, fixed, status in (("foo", "1.2-4", 1), ("foo", "1.2-3", 0), ("foo", "0", 0), ("bar", "1:9.5-3", 1), ("bar", "1:9.5-2", 0),
                                      ("linux", "6.1.192-3", 1), ("linux", "6.1.192-2", 0)):
            with self.subTest(source=source, fixed=fixed):
                releases = {"bookworm": {"status": "resolved", "fixed_version": fixed}, "trixie": {"status": "open"}}
                self.assertEqual(self.one(source, releases=releases, scope="remote")[0], status)
        self.assertEqual(self.one(releases={"bookworm": {"status": "undetermined"}}, scope="remote")[0], 1)
        self.assertEqual(self.one(releases={"bookworm": {"status": "open", "urgency": "unimportant"}}, scope="remote")[0], 0)

    def test_each_version_that_is_in_a_part_is_checked_and_an_entry_is_named_once(self):
        releases = {"bookworm": {"status": "resolved", "fixed_version": "1.2-4"}}
        for built_from, status in ("foo (1.2-4)", 0), ("baz (1-1), foo (1.2-3)", 1):
            with self.subTest(built_from):
                parts = [part("libfoo1", "1.2-4", "foo (1.2-4)"), part("static", "1-1", built_from)]
                self.assertEqual(self.check({"foo": {"CVE-2026-1": {"releases": releases, "scope": "remote"}}}, parts=parts)[0], status)
        self.assertIn("1 open entry", self.one("foo", parts=[part("one", "1-1", "foo (1-1)"), part("other", "2-1", "foo (2-1)")])[1])

    def test_data_that_cannot_be_right_is_refused(self):
        for found in {"linux": None}, {"foo": {"CVE-2026-1": {}}}, {"foo": {"CVE-2026-1": {"releases": {"bookworm": {}}}}}:
            self.assertEqual(self.check(found)[0], 1, found)
        for exposed in "face foo bytes\n", "excuse foo CVE-2026-1\n", "excuse foo all reason\n":
            status, _, why = self.check({}, exposed)
            self.assertEqual(status, 1)
            self.assertIn("exposed:1: expected 'faces SOURCE PURPOSE'", why)
        for parts in [], [{"name": "x", "supplier": "Organization: Debian"}]:
            self.assertEqual(self.check({}, parts=parts)[0], 1, parts)
        self.assertRegex((TOP / "toolchain/exposed").read_text(), r"(?m)^faces boost\S+ ", "Beast reads the Command Post's answers")
        done = subprocess.run([TOP / "toolchain/tracker", "/dev/null", TOP / "toolchain/exposed", "/dev/null"], capture_output=True, text=True, check=False)
        self.assertIn("/dev/null: ", done.stderr)
        self.assertEqual(done.returncode, 1)
