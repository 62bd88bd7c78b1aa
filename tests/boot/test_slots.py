"""The slot that the boot loaders start, and the tries that they count: real U-Boot and GRUB with the image's scripts, on a small disk
whose slots have a line with their name instead of a kernel. RAUC's programs for both environments play RAUC's part."""

import dataclasses
import functools
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import boards

TOP = boards.SOURCE
MIB = 1 << 20
# As in rootfs/disk: the first four partitions, each as large as FAT needs.
PARTITIONS = {"adit-env": (16, 1), "adit-boot": (17, 40), "adit-boot-a": (57, 40), "adit-boot-b": (97, 40)}
STARTED = re.compile(rb"this is slot ([abx])|(no slot has come up|cannot decide)")
AGAIN = "again"
# A decision that starts no slot, and texts that are not scripts.
HANGS = 'echo "this is slot x"\nwhile true; do true; done\n'
BROKEN = "no_such_command\n", "if true; then\n", bytes(range(1, 256)) * 16


class Machine:
    """A board and a disk with both slots."""

    def __init__(self, folder, board):
        self.folder, self.board, self.disk = folder, board, folder / "disk.img"
        self.soldered = board.soldered(folder, board.memory)
        table = "label: gpt\nfirst-lba: 2048\n" + "".join(
            f'start={start}MiB, size={size}MiB, name={name}{", attrs=LegacyBIOSBootable, type=U" if name == "adit-boot" else ""}\n'
            for name, (start, size) in PARTITIONS.items())
        with open(self.disk, "wb") as disk:
            disk.truncate(160 * MIB)
        subprocess.run(["sfdisk", "--quiet", "--no-reread", "--no-tell-kernel", self.disk], input=table.encode(), check=True)
        self.make_loader()
        for slot in "ab":
            self.fill(slot)

    def place(self, file, partition):
        subprocess.run(["dd", f"if={file}", f"of={self.disk}", "bs=1M", f"seek={PARTITIONS[partition][0]}", "conv=notrunc", "status=none"],
                       check=True)

    def make_partition(self, partition, files):
        subprocess.run([TOP / "rootfs/vfat", "ADIT" if partition == "adit-boot" else "SLOT", "40", files, self.folder / "fat.img"],
                       check=True, env={"SOURCE_DATE_EPOCH": "1", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})
        self.place(self.folder / "fat.img", partition)

    def make_loader(self):
        files, debian = self.folder / "loader", next((TOP / "build/image").glob(f"debian-{self.architecture}"))
        files.mkdir()
        subprocess.run([TOP / "rootfs/boot/loader", self.board.name, debian, files], check=True,
                       env={"SOURCE_DATE_EPOCH": "1", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})
        self.make_partition("adit-boot", files)

    def fill(self, slot, decision=None):
        """`decision`: the text of the slot's script, or the bytes of the file; by default those of the image."""
        files = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        self.make_slot(files, slot)
        if isinstance(decision, bytes):
            (files / self.decision).write_bytes(decision)
        else:
            self.make_script(files / self.decision, decision or (TOP / "rootfs/boot" / self.source).read_text())
        self.make_partition(f"adit-boot-{slot}", files)

    def empty(self, slot):
        with open(self.disk, "r+b") as disk:
            disk.seek(PARTITIONS[f"adit-boot-{slot}"][0] * MIB)
            disk.write(bytes(MIB))

    def counts(self):
        """The content of adit-env."""
        with open(self.disk, "rb") as disk:
            disk.seek(PARTITIONS["adit-env"][0] * MIB)
            return disk.read(4 * 512)

    def lose(self, *sectors):
        """Writes adit-env."""
        with open(self.disk, "r+b") as disk:
            for sector in sectors:
                disk.seek(PARTITIONS["adit-env"][0] * MIB + 512 * sector)
                disk.write(b"\xff" * 512)

    def start(self):
        """Starts the machine until the boot loader has decided: "a", "b", "x" (HANGS), or AGAIN. Then cuts the power."""
        disk = ["-drive", f"if=none,id=card,format=raw,file={self.disk}", "-device", f"{self.board.card},drive=card"]
        emulator = [self.board.emulator, *self.soldered, "-m", str(self.board.memory), "-no-reboot", *disk, "-serial", "stdio"]
        with subprocess.Popen(emulator, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as machine:
            said = b""
            try:
                while piece := machine.stdout.read1(4096):
                    said += piece
                    if found := STARTED.search(said):
                        if found[1] is None:  # it writes that down before it restarts, which ends the emulator
                            machine.wait(120)
                        return found[1].decode() if found[1] else AGAIN
            finally:
                machine.kill()
        raise AssertionError(said.decode(errors="replace"))


class Arm(Machine):
    architecture, source, decision = "arm64", "decide.cmd", "decide.scr"

    def make_slot(self, files, slot):
        self.make_script(files / "slot.scr", f'echo "this is slot {slot}"\npoweroff\n')

    def make_script(self, file, text):
        script = self.folder / "script.cmd"
        script.write_text(text)
        subprocess.run(["mkimage", "-A", "arm64", "-T", "script", "-C", "none", "-d", script, file], check=True, capture_output=True)

    def make_loader(self):
        super().make_loader()
        self.write({"BOOT_ORDER": "A B", "BOOT_A_LEFT": "a", "BOOT_B_LEFT": "a"})

    def rauc(self, slot, *, primary):
        """RAUC 1.8's changes for a slot that was written and is to be started, or was found good."""
        left = {f"BOOT_{slot.upper()}_LEFT": "3" if primary else "a"}
        self.set(left | ({"BOOT_ORDER": "B A" if slot == "b" else "A B"} if primary else {}))

    def rauc_writes(self, slot):
        """RAUC 1.8's changes before it writes a slot."""
        self.set({f"BOOT_{slot.upper()}_LEFT": "0", "BOOT_ORDER": "A" if slot == "b" else "B"})

    def spend(self, slot, tries):
        self.set({f"BOOT_{slot.upper()}_LEFT": f"{10 - tries:x}"})

    def set(self, variables):
        self.write(self.known | variables)

    def write(self, variables):
        self.known = variables
        text, env = self.folder / "env.txt", self.folder / "env"
        text.write_text("".join(f"{name}={value}\n" for name, value in variables.items()))
        subprocess.run(["mkenvimage", "-s", "512", "-o", env, text], check=True)
        self.place(env, "adit-env")


class Pc(Machine):
    architecture, source, decision = "amd64", "decide.cfg", "decide.cfg"

    def make_loader(self):
        with open(self.disk, "r+b") as disk:
            archive = subprocess.run(["tar", "--format=ustar", "-b", "1", "-cf", "-", "-C", self.folder, *self.sectors()], check=True,
                                     capture_output=True).stdout
            disk.seek(PARTITIONS["adit-env"][0] * MIB)
            disk.write(archive)
        self.edit("A_TRY=0")
        super().make_loader()

    def sectors(self):
        names = "grubenv", "grubenv2"
        for name in names:
            (self.folder / name).write_bytes(bytes(512))
        return names

    def make_slot(self, files, slot):
        self.make_script(files / "slot.cfg", f'echo "this is slot {slot}"\nsleep 30\n')

    def make_script(self, file, text):
        file.write_text(text)

    def edit(self, *variables):
        """Runs the image's grub-editenv on a copy of the partition."""
        part, at = self.folder / "adit-env", PARTITIONS["adit-env"][0] * MIB
        with open(self.disk, "r+b") as disk:
            disk.seek(at)
            part.write_bytes(disk.read(MIB))
            subprocess.run([TOP / "rootfs/boot/grub-editenv", part, "set", *variables], check=True)
            disk.seek(at)
            disk.write(part.read_bytes())

    def spend(self, slot, tries):
        self.edit(f"{slot.upper()}_TRY={tries}")

    def rauc_writes(self, slot):
        self.edit(f"{slot.upper()}_OK=0", f"{slot.upper()}_TRY=0")

    def rauc(self, slot, *, primary):
        name = slot.upper()
        self.edit(*[f"ORDER={'B A' if slot == 'b' else 'A B'}"] * primary, f"{name}_OK=1", f"{name}_TRY=0")


class Slots:
    """Tests for each boot loader."""

    def setUp(self):
        missing = self.board.missing()
        if missing:
            self.skipTest(missing)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="adit-slots."))
        self.addCleanup(shutil.rmtree, self.folder)
        self.machine = self.kind(self.folder, self.board)

    def starts(self, times):
        return "".join(self.machine.start() for _ in range(times))

    def test_proven_slot_has_ten_tries_before_the_other(self):
        self.machine.rauc("a", primary=True)
        self.machine.rauc("a", primary=False)
        self.assertEqual(self.starts(1), "a")
        self.assertIn(self.one_used, self.machine.counts())
        self.machine.spend("a", 8)
        self.assertEqual(self.starts(3), "aab")

    def test_a_slot_on_trial_has_three_until_it_is_good(self):
        self.machine.rauc("b", primary=True)
        self.assertEqual(self.starts(2), "bb")
        self.machine.rauc("b", primary=False)
        self.assertEqual(self.starts(4), "bbbb")
        self.machine.rauc("b", primary=True)
        self.assertEqual(self.starts(4), "bbba")

    def test_an_empty_slot_is_never_tried(self):
        self.machine.empty("b")
        self.machine.rauc("b", primary=True)
        self.assertEqual(self.machine.start(), "a")
        self.machine.rauc("a", primary=True)
        # If the only slot has no tries left, the boot loader starts once more and tries it again.
        self.assertEqual([self.machine.start() for _ in range(5)], ["a", "a", "a", AGAIN, "a"])

    def test_good_slot_runs_its_script_unless_it_hung(self):
        self.machine.fill("a", HANGS)
        self.machine.spend("b", 8)
        for _ in range(2):
            self.machine.rauc("a", primary=False)
            self.assertEqual(self.starts(2), "xa")

    def test_broken_script_is_skipped_at_the_next_start(self):
        self.machine.spend("b", 8)
        for decision in BROKEN:
            with self.subTest(decision[:20]):
                self.machine.fill("a", decision)
                self.machine.rauc("a", primary=False)
                self.assertEqual([self.machine.start() for _ in range(2)], [AGAIN, "a"])

    def test_script_of_a_slot_in_writing_or_on_trial_does_not_run(self):
        self.machine.fill("b", HANGS)
        self.machine.rauc("b", primary=True)
        self.machine.rauc("b", primary=False)
        self.machine.rauc_writes("b")
        self.machine.spend("a", 8)
        self.assertEqual(self.machine.start(), "a")
        self.machine.rauc("b", primary=True)
        self.assertEqual(self.machine.start(), "b")

    def test_invalid_environment_starts_the_first_slot_without_scripts(self):
        for slot in "ab":
            self.machine.fill(slot, HANGS)
        self.machine.lose(*self.sectors)
        self.assertEqual(self.machine.start(), "a")


class UBoot(Slots, unittest.TestCase):
    board, kind, sectors, one_used = boards.QEMU_VIRT, Arm, (0,), b"BOOT_A_LEFT=9"


class BoardsLoaders(unittest.TestCase):
    """boot.scr is found and works with the environments of the real boards' boot loaders. The boot loader itself is virt's: a board
    has memory from 0 on and its card at mmc, virt has memory from RAM on and its card at virtio. tests/rootfs/test_boards.py has the
    facts about the boards' own loaders."""

    RAM = 0x40000000
    ADDRESS = re.compile(r"\b0x[0-9a-f]{6,8}\b")

    def start_with(self, environment, starts):
        here = [self.ADDRESS.sub(lambda found: hex(int(found[0], 16) + self.RAM), line).replace("mmc", "virtio") for line in environment]
        here = [line.replace("bootcmd=", "bootcmd=pci enum; virtio scan; ", 1) if line.startswith("bootcmd=") else line for line in here]
        consoles = [f"{name}=pl011@9000000" for name in ("stdin", "stdout", "stderr")]
        board = dataclasses.replace(boards.QEMU_VIRT, soldered=functools.partial(boards.virt, told=[*here, *consoles, "bootdelay=-2"]))
        if missing := board.missing():
            self.skipTest(missing)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="adit-slots."))
        self.addCleanup(shutil.rmtree, folder)
        machine = Arm(folder, board)
        machine.spend("a", 8)
        self.assertEqual("".join(machine.start() for _ in starts), starts)

    def test_mainline_environment_starts_the_slots_and_counts(self):
        others = {file.parent.name for file in (TOP / "board").glob("*/u-boot.env")} - {boards.QEMU_VIRT.name}
        for board in sorted(others):
            with self.subTest(board):
                self.start_with(boards.environment_of(board), "aab")

    def test_espressobin_readme_starts_the_slots_and_counts(self):
        text = (TOP / "board/espressobin/README.md").read_text()
        told = re.findall(r"^setenv (\w+) (?:'(.*)'|(\S+))$", text, re.M)
        self.assertEqual({name for name, *_ in told}, {"bootcmd", "scriptaddr", "kernel_addr_r", "ramdisk_addr_r", "fdt_addr_r"})
        self.start_with([f"{name}={quoted or plain}" for name, quoted, plain in told], "aab")


class Grub(Slots, unittest.TestCase):
    board, kind, sectors, one_used = boards.PC, Pc, (1, 3), b"A_TRY=1"

    def test_second_copy_of_the_counts_is_used_if_the_first_is_lost(self):
        """And counts tries: a slot that does not come up is not started for ever."""
        self.machine.rauc("b", primary=True)
        self.machine.rauc("b", primary=False)
        self.machine.edit("A_OK=0", "A_TRY=0")  # it was left
        self.machine.spend("b", 8)
        self.machine.lose(1)
        self.assertEqual(self.starts(3), "bb" + AGAIN)
