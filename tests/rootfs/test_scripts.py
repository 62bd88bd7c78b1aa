"""Scripts of the recipe and of the box, called with test files and directories: GRUB's environment, two disks, toolchain/image's
options."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import TOP

SECTOR = 512
FIRST = b"# GRUB Environment Block\n"
DEFAULTS = {"ORDER": "A B", "A_OK": "1", "B_OK": "1", "A_TRY": "0", "B_TRY": "0", "A_MOST": "9", "B_MOST": "9"}
MACHINE_ID = b"0123456789abcdef0123456789abcdef\n"


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def call(self, *command, **environment):
        return subprocess.run([*map(str, command)], capture_output=True, text=True, env=os.environ | environment, cwd=self.folder)


class GrubsEnvironment(Scripts):
    def setUp(self):
        super().setUp()
        self.partition = self.folder / "adit-env"
        self.write(b"\0" * SECTOR, b"\0" * SECTOR)

    def write(self, first, second):
        """After a tar's headers, and before the initrd's own files."""
        self.rest = [b"grubenv".ljust(SECTOR, b"\0"), b"grubenv2".ljust(SECTOR, b"\0"), bytes(2048) + MACHINE_ID]
        self.partition.write_bytes(self.rest[0] + first + self.rest[1] + second + self.rest[2])

    def written(self):
        """Both copies, and the files beside them."""
        now = self.partition.read_bytes()
        first, second = (now[at:at + SECTOR] for at in (SECTOR, 3 * SECTOR))
        return first, second, [now[:SECTOR], now[2 * SECTOR:3 * SECTOR], now[4 * SECTOR:]]

    def edit(self, *words):
        return self.call(TOP / "rootfs/boot/grub-editenv", self.partition, *words)

    def set(self, *words):
        done = self.edit("set", *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def listed(self):
        done = self.edit("list")
        self.assertEqual(done.returncode, 0, done.stderr)
        return dict(line.split("=", 1) for line in done.stdout.splitlines())

    def test_set_values_are_listed_and_others_kept(self):
        self.set("A_TRY=2")
        self.set("A_TRY=0", "ORDER=B A")
        self.assertEqual(self.listed(), {**DEFAULTS, "ORDER": "B A", "B_MOST": "3"})

    def test_new_slot_has_three_tries_and_a_good_one_ten(self):
        self.set("ORDER=B A", "B_OK=1", "B_TRY=0")  # as RAUC has it
        self.set("B_TRY=2")
        listed = self.listed()
        self.assertEqual((listed["A_MOST"], listed["B_MOST"]), ("9", "3"))
        self.set("B_OK=1", "B_TRY=0")
        listed = self.listed()
        self.assertEqual((listed["A_MOST"], listed["B_MOST"]), ("9", "10"))

    def test_exactly_two_sectors_are_written(self):
        self.set("B_TRY=3")
        first, second, rest = self.written()
        self.assertEqual((first, rest), (second, self.rest))
        self.assertTrue(first.startswith(FIRST))
        self.assertEqual(first.rstrip(b"#")[-1:], b"\n")

    def test_second_copy_is_used_if_the_first_is_lost_and_both_are_rewritten(self):
        self.set("ORDER=B A", "A_OK=0", "B_TRY=0")
        first, second, _ = self.written()
        self.write(b"\xff" * SECTOR, second)
        self.assertEqual(self.listed(), {**DEFAULTS, "ORDER": "B A", "A_OK": "0", "B_MOST": "3"})
        self.set("B_TRY=0", "ORDER=B A")
        self.assertEqual(self.written()[:2], (self.written()[0],) * 2)
        self.assertEqual(self.listed()["A_OK"], "0")

    def test_first_copy_is_used_if_only_grub_changed_it(self):
        self.set("A_TRY=0")
        first, second, _ = self.written()
        self.write(first.replace(b"A_TRY=0", b"A_TRY=4"), second)
        self.assertEqual(self.listed()["A_TRY"], "4")

    @unittest.skipUnless(shutil.which("grub-editenv"), "no grub-editenv here")
    def test_grub_editenv_reads_it(self):
        self.set("ORDER=B A", "B_TRY=1")
        alone = self.folder / "grubenv"
        alone.write_bytes(self.partition.read_bytes()[SECTOR:2 * SECTOR])
        said = self.call("grub-editenv", alone, "list").stdout
        self.assertEqual(dict(line.split("=", 1) for line in said.splitlines()), {**DEFAULTS, "ORDER": "B A", "B_TRY": "1", "B_MOST": "3"})

    def test_damaged_environment_is_replaced_by_the_defaults(self):
        for damaged in bytes(SECTOR), b"\xff" * SECTOR, b"#" * SECTOR, FIRST[:9] + bytes(SECTOR - 9):
            with self.subTest(damaged[:12]):
                self.write(damaged, damaged)
                self.assertEqual(self.listed(), DEFAULTS)
        self.set("A_TRY=1")
        self.assertEqual(self.listed(), {**DEFAULTS, "A_TRY": "1"})

    def test_invalid_words_change_nothing(self):
        self.set("A_TRY=1")
        before = self.partition.read_bytes()
        for words in (["set", "A_TRY"], ["set", "A_TRY=$x"], ["set", "A_TRY=1\n2"], ["set", "A_TRY=2", "=1"], ["set", "A=1=2"],
                      ["unset", "A_TRY"], ["set", "X=" + "x" * 500]):
            with self.subTest(words):
                done = self.edit(*words)
                self.assertEqual(done.returncode, 1)
                self.assertTrue(done.stderr.startswith("grub-editenv: "), done.stderr)
                self.assertEqual(self.partition.read_bytes(), before)

    def test_missing_partition_is_an_error_and_is_not_created(self):
        self.partition.unlink()
        for words in ["list"], ["set", "A_TRY=1"]:
            self.assertIn("there is no", self.edit(*words).stderr)
        self.assertFalse(self.partition.exists())


class TwoDisks(Scripts):
    def held_by(self, *disks):
        sysfs, notice = self.folder / "sys", self.folder / "notices/disks"
        shutil.rmtree(sysfs, ignore_errors=True)
        for disk in (*disks, "other"):
            name = "adit-env" if disk != "other" else "somebodys"
            (sysfs / "class/block" / f"{disk}1").mkdir(parents=True)
            (sysfs / "class/block" / f"{disk}1/uevent").write_text(f"DEVTYPE=partition\nPARTNAME={name}\n")
        done = self.call(TOP / "rootfs/overlay/usr/lib/adit/disks", sysfs, notice)
        return done.returncode, notice.read_text() if notice.exists() else None

    def test_two_disks_with_an_adit_are_reported_until_one_is_removed(self):
        self.assertEqual(self.held_by("sda"), (0, None))
        status, notice = self.held_by("sda", "sdb")
        self.assertEqual(status, 1)
        self.assertRegex(notice, "^2 disks hold an Adit: .*\n$")
        self.assertEqual(self.held_by("sda"), (0, None))

    def test_rauc_and_udev_run_the_check(self):
        self.assertIn("\npre-install=/usr/lib/adit/disks\n", (TOP / "rootfs/rauc.conf.in").read_text())
        self.assertIn('RUN+="/usr/lib/adit/disks"', (TOP / "rootfs/overlay/usr/lib/udev/rules.d/70-adit-disks.rules").read_text())


class Greeting(Scripts):
    """The consoles' output for a box of plain files, over that many seconds. `sleep` takes no time, and ends it."""

    def shown(self, code="12345678", passwords="", addresses=("10.0.0.1", "192.168.7.11"), consoles="tty0 ttyS0", seconds=10, status=""):
        state, devices = self.folder / "state", self.folder / "dev"
        for path in state, devices, self.folder / "bin":
            shutil.rmtree(path, ignore_errors=True)
            path.mkdir()
        for name in consoles.split():
            (devices / name).touch()
        if code:
            (state / "first-start.code").write_text(code + "\n")
        if passwords:
            (state / "access.json").write_text(passwords)
        (self.folder / "active").write_text(consoles + "\n")
        said = "".join(f"2: team0    inet {address}/24 brd 10.0.0.255 scope global team0\\n" for address in addresses)
        ends = f"read -r slept <slept; slept=$((slept + $1)); echo $slept >slept; [ $slept -lt {seconds} ] || kill $PPID"
        for name, does in ("ip", f"printf '{said}'"), ("sleep", ends):
            (self.folder / "bin" / name).write_text(f"#!/bin/sh\n{does}\n")
            (self.folder / "bin" / name).chmod(0o755)
        (self.folder / "slept").write_text("0\n")
        (self.folder / "status.json").write_text(status)
        self.call(TOP / "rootfs/overlay/usr/lib/adit/greeting", state, self.folder / "active", devices, self.folder / "status.json",
                  PATH=f"{self.folder}/bin:/usr/bin:/bin")
        return [(devices / name).read_text() for name in consoles.split()]

    def test_each_console_shows_the_address_of_the_page_and_the_code(self):
        screen, serial = self.shown(addresses=("169.254.47.111", "10.0.0.1", "192.168.7.11"))
        self.assertEqual(screen, serial)
        self.assertRegex(screen, r"(?s)10\.0\.0\.1.*192\.168\.7\.11.*169\.254\.47\.111", "the link-local one is the last resort")
        for words in "http://10.0.0.1", "http://192.168.7.11", "code that it asks for: 12345678":
            self.assertEqual(screen.count(words), 1, screen)
        self.assertNotIn("\n\n", screen.replace("\r", "").strip())

    def test_serial_console_repeats_it_each_minute(self):
        consoles = self.shown(consoles="tty0 ttyS2 ttyMV0 ttyAMA0", seconds=125)
        self.assertEqual([said.count("12345678") for said in consoles], [1, 3, 3, 3])

    def test_missing_code_is_shown(self):
        self.assertIn("no code yet", self.shown(code=None)[0])

    def test_fingerprint_of_the_certificate_is_shown(self):
        sha256 = ":".join(f"{number:02X}" for number in range(32))
        shown = self.shown(status=json.dumps({"nonce": "", "refusal": "", "fingerprint": sha256, "until": "2036-11-28"}))[0]
        self.assertIn("https://", shown)
        self.assertIn(f"  {sha256[:47]}\n  {sha256[48:]}\n", shown)
        self.assertLess(max(map(len, shown.splitlines()[3:])), 80, shown)
        self.assertNotIn("https", self.shown(status='{"fingerprint":""}')[0])

    def test_unreadable_passwords_count_as_unset(self):
        """Asks for a new code, which is written."""
        self.assertIn("12345678", self.shown(passwords='{"version":1,"oper')[0])

    def test_greeting_ends_once_a_password_is_set(self):
        self.assertEqual(self.shown(code=None, passwords="{}"), ["", ""])


LOCKED = "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt)"


class SetUp(Scripts):
    """toolchain/setup on a machine without any of its packages, with an apt-get that prints the lines of `says`, one per call."""

    def setUp(self):
        super().setUp()
        for name, does in (("dpkg-query", "exit 1"), ("sleep", ":"), ("sudo", 'exec "$@"'),
                           ("apt-get", 'echo "$*" >>calls; [ -s says ] || exit 0; head -n 1 says >&2; sed -i 1d says; exit 100')):
            path = self.folder / "bin" / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"#!/bin/sh\n{does}\n")
            path.chmod(0o755)
        for name in "setup", "packages":
            shutil.copy(TOP / "toolchain" / name, self.folder / name)

    def set_up(self, *says, groups=("sanitizers",)):
        (self.folder / "says").write_text("".join(line + "\n" for line in says))
        done = self.call(self.folder / "setup", *groups, PATH=f"{self.folder}/bin:/usr/sbin:/usr/bin:/sbin:/bin")
        return done, [line.split()[0] for line in (self.folder / "calls").read_text().splitlines()]

    def test_it_waits_for_another_apt_and_reports_it_once(self):
        done, calls = self.set_up(LOCKED, LOCKED)
        self.assertEqual((done.returncode, calls), (0, ["update", "update", "update", "-o"]))
        self.assertEqual(done.stdout.count("waits for another apt"), 1)

    def test_another_error_of_apt_ends_it_and_is_shown(self):
        done, calls = self.set_up("E: Could not resolve the mirror")
        self.assertEqual((done.returncode, calls), (1, ["update"]))
        self.assertIn("Could not resolve", done.stderr)

    def test_a_machine_without_apt_is_told_of_the_container(self):
        for absent in "dpkg-query", "apt-get":
            with self.subTest(absent):
                tools = Path(tempfile.mkdtemp(dir=self.folder))
                for name in {"bash", "dirname", "dpkg-query", "apt-get"} - {absent}:
                    (tools / name).symlink_to(shutil.which(name))
                done = self.call(self.folder / "setup", PATH=str(tools))
                self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (1, "", 1), done.stderr)
                self.assertRegex(done.stderr, r"^toolchain/setup: .* not Debian 12 or 13: put toolchain/container/run before the command")

    def test_container_has_the_packages_of_both_commands(self):
        """Their groups; and the step that installs them needs no more files than are copied before it."""
        dockerfile = (TOP / "toolchain/container/Dockerfile").read_text()
        copied, place, groups = re.search(r"^COPY ([\w ]+) (/\S+/)\nRUN \2setup ([a-z ]+) &&", dockerfile, re.M).groups()
        self.assertEqual(set(copied.split()), {"setup", "packages"}, "as in setUp()")
        self.assertEqual(self.set_up(groups=groups.split())[0].returncode, 0)
        for script, asks in ("run", r"^toolchain/setup ([a-z ]+)$"), ("test", r"^groups=\(([a-z ]+)\)"):
            self.assertLessEqual(set(re.search(asks, (TOP / "toolchain" / script).read_text(), re.M)[1].split()), set(groups.split()), script)

    def test_editors_build_the_same_container(self):
        folder = TOP / ".devcontainer"
        build = json.loads((folder / "devcontainer.json").read_text())["build"]
        file, context = ((folder / build[name]).resolve().relative_to(TOP) for name in ("dockerfile", "context"))
        self.assertIn(f" --file {file} {context}\n", (TOP / "toolchain/container/run").read_text())

    def test_sanitizers_are_those_of_the_compiler_in_use(self):
        compiler = re.search(r"CXX_COMPILER clang\+\+-(\d+)", (TOP / "toolchain/cmake/ships.cmake").read_text())
        done, _ = self.set_up()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"libclang-rt-{compiler[1]}-dev", (self.folder / "calls").read_text().split())


class Options(Scripts):
    """Arguments of toolchain/image, in a tree whose recipe records its arguments."""

    def setUp(self):
        super().setUp()
        for path in "board/one", "toolchain", "rootfs", "programs":
            (self.folder / path).mkdir(parents=True)
        for path in "toolchain/image", "toolchain/image-key", "toolchain/version":
            shutil.copy(TOP / path, self.folder / path)
        (self.folder / "board/one/board.conf").write_text("architecture=amd64 kernel_package=linux boot_packages=()\n")
        (self.folder / "CMakeLists.txt").write_text("project(adit VERSION 0.1.0)\n")
        (self.folder / "rootfs/packages").touch()
        (self.folder / "programs/CMakeCache.txt").touch()
        for path in "toolchain/setup", "rootfs/debian", "rootfs/disk", "rootfs/bundle":
            self.program(path, "")
        self.program("rootfs/slot", 'echo "$2" >told; cp "$ADIT_KEYRING" keyring; touch "$5/parts.spdx.json"\n')

    def program(self, path, does):
        (self.folder / path).write_text("#!/bin/sh\n" + does)
        (self.folder / path).chmod(0o755)

    def told(self, *options):
        done = self.call(self.folder / "toolchain/image", *options, "--programs", "programs", "one")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "told").read_text().strip()

    def certificate(self, name, days="30"):
        """Of a new key; with days of -1 it has ended."""
        path = self.folder / f"{name}.pem"
        key = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-keyout", "key", "-subj", f"/CN={name}"]
        self.assertEqual(self.call("openssl", "req", "-x509", *key, "-out", path).returncode, 0)
        self.assertEqual(self.call("openssl", "x509", "-in", path, "-signkey", "key", "-days", days, "-out", path).returncode, 0)
        return path

    def keyring(self, signing="", standby=""):
        """What the box accepts, or why toolchain/image ends."""
        done = self.call(self.folder / "toolchain/image", "--programs", "programs", "one", ADIT_SIGNING_CERT=str(signing), ADIT_STANDBY_CERT=str(standby))
        return (self.folder / "keyring").read_text() if done.returncode == 0 else done.stderr

    def test_version_is_comparable(self):
        good = "1.2.3", "0.0.0", "1.2.3-rc.1", "1.2.3-0a", "1.2.3--", "1.2.3+5.01", "1.2.3-rc.1+b-2"
        self.assertEqual(self.told(*(word for version in good for word in ("--version", version))), good[-1], "each is checked")
        for version in ("", "1.2", "1.2.3~rc1", "1.2.3.4", "01.2.3", "1.2.3+a+b", "1.2.3-01", "1.2.3-", "1.2.3-a..b", "v1.2.3", "1.2.3-a_b",
                        "1.2.3-" + "a" * 60):
            with self.subTest(version):
                done = self.call(self.folder / "toolchain/image", "--version", version, "one")
                self.assertEqual(done.returncode, 2)
                self.assertIn("--version wants", done.stderr)

    def test_the_version_is_that_of_the_tree_unless_it_is_said(self):
        self.assertEqual(self.told(), "0.1.0")
        (self.folder / "CMakeLists.txt").write_text('project(adit DESCRIPTION "no version")\n')
        done = self.call(self.folder / "toolchain/image", "--programs", "programs", "one")
        self.assertEqual((done.returncode, done.stdout), (1, ""))

    def test_the_box_accepts_the_certificate_that_updates_are_signed_for_and_the_standby(self):
        signing, standby = self.certificate("signing"), self.certificate("standby")
        self.assertEqual(self.keyring(signing), signing.read_text())
        self.assertEqual(self.keyring(signing, standby), signing.read_text() + standby.read_text())
        self.assertEqual(self.keyring(), (self.folder / "build/image/keys/cert.pem").read_text())
        self.assertEqual(self.keyring(standby=standby), (self.folder / "build/image/keys/cert.pem").read_text() + standby.read_text())

    def test_no_box_gets_a_certificate_that_has_ended_or_a_standby_that_is_none(self):
        good, ended = self.certificate("good"), self.certificate("ended", days="-1")
        (self.folder / "two.pem").write_text(good.read_text() * 2)
        (self.folder / "damaged.pem").write_text(good.read_text().replace("\n", "\nA", 2))
        for signing, standby, why in ((good, ended, "ended.pem: the certificate has ended"), (ended, good, "ended.pem: the certificate has ended"),
                                      (good, good, "another key"), (good, "two.pem", "two.pem: expected one"), (good, "key", "key: expected one"),
                                      (good, "none.pem", "none.pem"), (good, "damaged.pem", "damaged.pem")):
            with self.subTest(why):
                self.assertIn(why, self.keyring(signing, standby))
                self.assertFalse((self.folder / "keyring").exists())
