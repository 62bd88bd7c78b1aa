"""Scripts that the initrd calls in the root: usr/lib/adit/state, which chooses the box's state partition, with a sysfs directory and
programs made here, and usr/lib/adit/early, which runs before the network is up. tests/boot runs both from a real disk. But QEMU has
no eMMC, whose boot areas are in that directory too."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from recipe import TOP

SCRIPTS = TOP / "rootfs/overlay/usr/lib/adit"
SECTORS = {"env": 2048, "boot": 81920, "boot-a": 131072, "boot-b": 131072, "root-a": 262144, "root-b": 262144}
OWN = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount"]
# It writes to /run, /var and the console, so it gets a mount namespace of its own.
CALL = """mount -t tmpfs tmpfs /run && mount -t tmpfs tmpfs /var && eval "$3" && { [ ! -e /dev/console ] || mount --bind "$1/console" /dev/console; } || exit 99
PATH="$1/bin:$PATH" sh "$2" "$1/mmcblk0" 60; cat /run/adit-notices/state 2>/dev/null
for folder in run var; do find /$folder ! -type l -printf '%P %m\\n' -o -printf '%P %l\\n' | sort >$1/$folder; done"""
VALID, ERRORS = 1, 2  # s_state, as the kernel's ext4 has it
MOUNTED = ["mount -t ext4 -o noatime,nosuid,nodev,errors=remount-ro /dev/mmcblk0p7 /var"]
REPAIRED = ["e2fsck -p /dev/mmcblk0p7"]
FOLDERS = {"cache": "755", "cache/private": "700", "lib": "755", "lib/private": "700", "lib/rauc": "755", "log": "755", "log/private": "700",
           "run": "../run", "tmp": "1777"}
RECORD = 'echo "${0##*/} $*" >>"${0%/*}/../called"\n'


def setUpModule():
    if subprocess.run([*OWN, "mount", "-t", "tmpfs", "tmpfs", "/run"], capture_output=True).returncode:
        raise unittest.SkipTest("this machine gives nobody a mount namespace")


class Script(unittest.TestCase):
    name = ""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "bin").mkdir()
        (self.folder / "console").touch()

    def program(self, name, does=""):
        path = self.folder / "bin" / name
        path.write_text("#!/bin/sh\n" + RECORD + does)
        path.chmod(0o755)

    def run_it(self, before=":"):
        """The notice that it leaves. `before`: earlier changes of /run and /var."""
        done = subprocess.run([*OWN, "sh", "-c", CALL, "state", self.folder, SCRIPTS / self.name, before], capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def called(self, name):
        lines = (self.folder / "called").read_text().splitlines()
        return [line for line in lines if line.split()[0] in name.split()]

    def left(self, folder):
        """The modes and links in /run or /var, by path."""
        return dict(line.rsplit(" ", 1) for line in (self.folder / folder).read_text().splitlines())


class State(Script):
    name = "state"

    def setUp(self):
        super().setUp()
        self.disk = self.folder / "mmcblk0"
        self.disk.mkdir()
        self.end = 32768
        for number, (name, sectors) in enumerate(SECTORS.items(), 1):
            self.partition(number, sectors, f"adit-{name}")
        for area in "mmcblk0boot0", "mmcblk0boot1", "mmcblk0rpmb":
            self.area(area, size="8192\n", uevent=f"MAJOR=179\nDEVNAME={area}\nDEVTYPE=disk\n")
        self.room(2_000_000)
        for name in "modprobe", "mount", "systemd-growfs", "e2fsck":
            self.program(name)
        self.program("busybox", "exec sleep 60\n")
        self.state_is(VALID)
        self.makes(7)

    def area(self, name, **files):
        (self.disk / name).mkdir()
        for file, text in files.items():
            (self.disk / name / file).write_text(text)

    def partition(self, number, sectors, label=None):
        name = f"mmcblk0p{number}"
        event = f"DEVNAME={name}\nDEVTYPE=partition\nPARTN={number}\n" + (f"PARTNAME={label}\n" if label else "")
        self.area(name, partition=f"{number}\n", start=f"{self.end}\n", size=f"{sectors}\n", uevent=event)
        self.end += sectors

    def room(self, sectors):
        (self.disk / "size").write_text(f"{self.end + sectors + 34}\n")

    def makes(self, number):
        """Like systemd-repart, which does not tell the kernel the label."""
        new = f"{self.disk}/mmcblk0p{number}"
        lines = [f"mkdir {new}"] + [f"echo {text} >{new}/{file}" for file, text in
                                    (("partition", number), ("start", self.end), ("size", 1_000_000), ("uevent", f"PARTN={number}"))]
        self.program("systemd-repart", "\n".join(lines) + "\n")

    def state_is(self, flags):
        """The state of the superblock."""
        self.program("hexdump", f'for last; do :; done; [ "$last" = /dev/mmcblk0p7 ] && printf {flags}\n')

    def has_state(self):
        self.partition(7, 1_000_000, "adit-state")
        self.room(0)

    def is_state(self, device):
        self.assertEqual({line.split()[-1] for line in self.called("hexdump")}, {device})
        self.assertEqual([line.split()[-2:] for line in self.called("mount")], [[device, "/var"]])
        self.assertEqual(self.called("e2fsck"), [])

    def test_first_boot_uses_the_new_partition_not_an_emmc_boot_area(self):
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(self.called("systemd-growfs"), ["systemd-growfs /var"])

    def test_later_boot_uses_the_labelled_partition(self):
        self.has_state()
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(self.called("systemd-repart") + self.called("systemd-growfs"), [])

    def test_on_a_larger_disk_it_grows(self):
        self.partition(7, 1_000_000, "adit-state")
        self.room(131_073)
        self.program("systemd-repart")
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")
        self.assertEqual(len(self.called("systemd-repart") + self.called("systemd-growfs")), 2)

    def test_foreign_partition_without_a_label_is_untouched(self):
        self.partition(8, 1_000_000)
        self.room(2_000_000)
        self.assertEqual(self.run_it(), "")
        self.is_state("/dev/mmcblk0p7")

    def test_without_room_the_state_is_in_memory_with_a_notice(self):
        self.partition(8, 1_000_000)
        self.room(0)
        self.program("systemd-repart", "exit 1\n")
        self.assertIn("the disk has no room for it", self.run_it())
        self.assertEqual(self.called("e2fsck"), [])
        self.assertTrue(self.called("mount")[0].endswith("tmpfs /var"))

    def test_file_system_with_errors_is_repaired_before_mounting(self):
        self.has_state()
        for flags in (ERRORS, VALID | ERRORS):
            with self.subTest(flags):
                self.state_is(flags)
                self.assertEqual(self.run_it(), "")
                self.assertEqual(self.called("e2fsck mount"), [*REPAIRED, *MOUNTED])
                (self.folder / "called").unlink()

    def test_unmountable_file_system_is_repaired_and_mounted(self):
        self.has_state()
        self.program("mount", 'grep -q ^e2fsck "${0%/*}/../called" || { echo "mount: bad superblock" >&2; exit 1; }\n')
        for unreadable in (False, True):
            with self.subTest(unreadable):
                if unreadable:
                    self.program("hexdump", "exit 1\n")
                self.assertEqual(self.run_it(), "")
                self.assertEqual(self.called("e2fsck mount"), [*MOUNTED, *REPAIRED, *MOUNTED])
                (self.folder / "called").unlink()

    def test_file_system_that_needs_a_forced_repair(self):
        self.state_is(ERRORS)
        self.program("e2fsck", '[ "$1" = -f ] || exit 4\n')
        self.assertEqual(self.run_it(), "")
        self.assertEqual(self.called("e2fsck mount"), [*REPAIRED, "e2fsck -f -y /dev/mmcblk0p7", *MOUNTED])

    def test_the_watchdog_is_fed_during_a_repair(self):
        self.has_state()
        self.state_is(ERRORS)
        fed = 'grep -q "^busybox timeout .* watchdog -F -T 60 " "${0%/*}/../called" && exit 0'
        self.program("e2fsck", f"for _ in $(seq 500); do {fed}; sleep 0.01; done\nexit 8\n")
        self.assertEqual(self.run_it(), "")

    def test_irreparable_file_system_is_unchanged(self):
        self.state_is(ERRORS)
        self.program("e2fsck", "exit 8\n")
        self.assertIn("it cannot be repaired", self.run_it())
        self.assertTrue(self.called("mount")[0].endswith("tmpfs /var"))
        self.assertIn("tmp", self.left("var"), "in memory")

    def test_new_file_system_has_the_expected_directories(self):
        self.assertEqual(self.run_it(), "")
        var = self.left("var")
        self.assertEqual({name: var[name] for name in FOLDERS}, FOLDERS)

    def test_directories_are_completed_after_a_cut(self):
        self.assertEqual(self.run_it("mkdir -p /var/cache /var/lib/rauc"), "")
        self.assertEqual({name: self.left("var")[name] for name in FOLDERS}, FOLDERS)

    def test_leftovers_of_a_service_are_deleted_and_the_rest_is_kept(self):
        self.has_state()
        self.assertEqual(self.run_it("mkdir -p /var/tmp/systemd-private-1/tmp /var/tmp/systemd-private-2 /var/lib/adit"), "")
        self.assertEqual(set(self.left("var")), {"", "lib", "lib/adit", "tmp"})


FIREWALL = 'nft -D others="drop" -f /usr/share/adit/nftables.conf'
ADDRESSES = "adit-network --start --team team0 --command-post darpa0"


class Early(Script):
    name = "early"

    def setUp(self):
        super().setUp()
        for name in "nft", "adit-network":
            self.program(name)

    def leaves_out(self, *services, card=": >/run/adit-card-is-empty"):
        self.run_it(card)
        self.assertEqual({name.partition("/")[2] for name in self.left("run") if name.startswith("adit-early/")}, set(services))
        return (self.folder / "called").read_text().splitlines()

    def test_both_services_are_skipped_afterwards(self):
        self.assertEqual(self.leaves_out("adit-nftables", "adit-network-start"), [FIREWALL, ADDRESSES])
        self.assertEqual((self.left("run")["systemd/network"], self.left("var")["lib/adit-network"]), ("755", "755"))

    def test_as_their_units_would(self):
        for unit, command in ("adit-nftables", FIREWALL), ("adit-network-start", ADDRESSES):
            said = (TOP / f"services/{unit}.service").read_text().replace("\\", "").replace('"others="drop""', 'others="drop"')
            self.assertIn(f"ExecStart={command}\n", said)
            condition = (TOP / f"rootfs/overlay/usr/lib/systemd/system/{unit}.service.d/early.conf").read_text()
            self.assertIn("ConditionPathExists=!/run/adit-early/%N\n", condition)

    def test_failures_are_left_to_the_service(self):
        self.program("nft", "exit 1\n")
        self.assertEqual(self.leaves_out("adit-network-start"), [FIREWALL, ADDRESSES])
        self.program("adit-network", "exit 1\n")
        self.leaves_out()

    def test_card_with_addresses_comes_first(self):
        self.assertEqual(self.leaves_out("adit-nftables", card=":"), [FIREWALL])
