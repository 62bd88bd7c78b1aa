"""A PC that GRUB starts: an update is installed, GRUB counts a start of it, and RAUC marks it good."""

import os
import pathlib
import re
import subprocess
import tempfile

import boards
import hosts
import inside_unit
import stage
from bundles import bundle, bundle_of_nothing
from stage import Stage, Story, load_tests, note  # unittest looks for them here
from updating import Updating

NEWER, REFUSED = "7.0.0", "6.0.0"
NOTICE = "/run/adit-notices/disks"


def setUpModule():
    hosts.needs_root()
    stage.skip_without(boards.PC)


class Pc(Updating, Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage(board=boards.PC, post_options=None))
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="adit-bundles-")))
        cls.newer = bundle(cls.folder, NEWER, board=boards.PC.name, source=boards.PC)

    def counts(self):
        """GRUB's environment: {"ORDER": "A B", "A_TRY": "1", ...}."""
        said = self.box.console.ask("grub-editenv /dev/disk/by-partlabel/adit-env list")
        return dict(line.split("=", 1) for line in said.splitlines() if "=" in line)

    def test_it_answers_on_the_first_port_of_two(self):
        self.stage.start()
        note("PC: first start, from power to the first answer on team0", self.box.start_took)
        self.box.console.wait_for_shell()
        self.assertEqual(self.box.console.ask("ls /sys/class/net").split(), ["darpa0", "lo", "team0"])

    def test_sandbox_of_the_unit_holds(self):
        refused = inside_unit.check(self, self.box.console.ask)
        note("PC: refused from inside adit.service", f"{refused} attempts")

    def test_memory_has_the_limit_of_the_board(self):
        """In the kernel, not only in the unit."""
        ask = self.box.console.ask
        most = int(ask("cat /sys/fs/cgroup/system.slice/adit.service/memory.max"))
        total = int(ask("sed -n 's/^MemTotal: *\\([0-9]*\\) kB/\\1/p' /proc/meminfo")) << 10
        said = re.search(r"^memory_max=(\d+)%$", (boards.SOURCE / "board" / boards.PC.name / "board.conf").read_text(), re.M)
        self.assertAlmostEqual(most / total, int(said[1]) / 100, delta=0.05)
        note("PC: adit.service, of its memory", f"{most >> 20} of {total >> 20} MiB")

    def test_kernel_protects_files_in_shared_directories(self):
        self.assertEqual(self.box.console.ask("cat /proc/sys/fs/protected_fifos /proc/sys/fs/protected_regular").split(), ["1", "2"])

    def hostile_stick(self):
        """Its superblock asks for a panic at an error, and its root directory is damaged."""
        image, path = self.folder / "hostile.img", {**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
        with open(image, "wb") as made:
            made.truncate(32 << 20)
        for command in ["mkfs.ext4", "-q", "-b", "4096", image], ["tune2fs", "-e", "panic", image]:
            subprocess.run(command, env=path, check=True, capture_output=True)
        block = subprocess.run(["debugfs", "-R", "blocks /", image], env=path, check=True, capture_output=True, text=True).stdout
        with open(image, "r+b") as damaged:
            damaged.seek(int(block) * 4096)
            damaged.write(os.urandom(4096))
        return image

    def test_stick_cannot_panic_the_kernel(self):
        self.box.plug_stick(self.hostile_stick(), "hostile")
        self.box.wait_until(lambda: self.box.console.run("journalctl -kq | grep 'EXT4-fs error.*Directory block'")[0] == 0, "it to be read")
        self.box.wait_until(self.box.answers, "the box to answer")
        self.box.pull_stick("hostile")
        left = "systemctl list-units --no-legend --state=active,activating,deactivating 'adit-stick@*'"
        self.box.wait_until(lambda: not self.box.console.ask(left).strip(), "it to be gone")

    def test_a_stick_with_exfat_is_read(self):
        image = self.folder / "exfat.img"
        with open(image, "wb") as made:
            made.truncate(64 << 20)
        subprocess.run(["mkfs.exfat", image], env={**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}, check=True, capture_output=True)
        self.box.plug_stick(image, "large")
        self.box.wait_until(lambda: self.box.console.run("grep '/run/adit-stick/.* exfat ro,' /proc/mounts")[0] == 0, "it to be mounted")
        self.box.pull_stick("large")

    def test_update_is_rejected_while_two_disks_hold_an_adit(self):
        self.box.plug_stick(boards.PC.image())
        self.box.wait_until(lambda: self.box.console.run(f"cat {NOTICE}")[0] == 0, "it to be noticed")
        self.box.wait_until(lambda: self.stands()["managed"], "adit-update to have told what runs")
        self.send(bundle_of_nothing(self.folder, REFUSED, boards.PC.name))
        self.box.wait_until(lambda: "2 disks hold an Adit" in (self.stands()["refusal"] or ""), "it to be refused")
        self.box.pull_stick()
        self.box.wait_until(lambda: self.box.console.run(f"ls {NOTICE}")[0] != 0, "it to be gone")

    def test_an_update_is_installed(self):
        began = self.box.moment()
        self.send(self.newer)
        self.settled("installed", NEWER, within=300)
        note(f"PC: update of {self.newer.stat().st_size / 1e6:.0f} MB", self.box.took(began))
        counts = self.counts()
        self.assertEqual((counts["ORDER"], counts["B_OK"], counts["B_TRY"]), ("B A", "1", "0"))

    def test_grub_counts_its_start(self):
        self.box.plug_stick(self.hostile_stick(), "again")  # stays in the box while it boots
        self.restart()
        self.box.console.wait_for(rb"Adit: slot b", 180)
        self.box.wait_until(lambda: self.stands()["slot"] == "B", "slot B to answer", 300)
        self.box.console.wait_for_shell()
        self.assertEqual(self.counts()["B_TRY"], "1")

    def test_and_rauc_marks_it_good(self):
        self.settled("good", NEWER, within=300)
        self.assertEqual((self.stands()["version"], self.stands()["slot"]), (NEWER, "B"))
        self.assertEqual(self.counts()["B_TRY"], "0")

    def test_the_stick_was_mounted_only_then(self):
        """A panic by it would not have used up a try."""
        good = int(self.box.console.ask("systemctl show -P InactiveEnterTimestampMonotonic adit-good"))
        read = "journalctl -kb -o short-monotonic | sed -n '/EXT4-fs error.*Directory block/{s/^\\[ *\\([0-9]*\\)\\.\\([0-9]*\\).*/\\1\\2/p;q}'"
        times = []  # the kernel writes its own lines to the console, too

        def is_read():
            times.extend(int(word) for word in self.box.console.ask(read).split() if word.isdigit())
            return times

        self.box.wait_until(is_read, "the stick to be read")
        self.assertGreater(times[0], good)
        self.assertGreater(good, 0)
        self.box.pull_stick("again")

    def test_a_panic_leaves_its_trace_in_the_journal(self):
        heard = len(self.box.console.heard)
        self.box.console.type("echo c > /proc/sysrq-trigger")
        self.box.console.wait_for(rb"Adit: slot .*/ # ", 300, heard)
        self.box.console.wait_for_shell()
        trace = "journalctl -b -t systemd-pstore -o cat --output-fields=FILE --no-pager"
        self.box.wait_until(lambda: "sysrq triggered crash" in self.box.console.run(trace)[1], "the trace of the panic")
