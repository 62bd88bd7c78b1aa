"""Differences of the machines that the tests start: emulator, hardware, image."""

import dataclasses
import os
import pathlib
import shutil
import subprocess

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
FLASH_SIZE = 64 << 20  # of each of the two flashes of arm64's virt


@dataclasses.dataclass(frozen=True)
class Board:
    """`soldered(folder, memory)` makes the delivered hardware in `folder` and returns QEMU's options for it. `card` and `ports` are
    QEMU's devices, the ports in order. `words` are for the kernel, as in adit/boot.env. `memory` is in megabytes. `needs` are
    programs and files of the host."""

    name: str
    emulator: str
    soldered: callable
    card: str
    ports: tuple
    words: str
    memory: int = 256
    has_panel: bool = False
    needs: tuple = ()

    @property
    def images(self):
        return SOURCE / "build" / "image" / self.name

    def image(self):
        """The newest image."""
        return max(self.images.glob(f"adit-{self.name}-*.img"), key=lambda path: path.stat().st_mtime)

    def missing(self):
        """The reason why this machine cannot start the other one, or ""."""
        wanted = [self.emulator, "qemu-img", "mcopy", "setpriv", *self.needs]
        absent = [program for program in wanted if not (shutil.which(program) or os.path.exists(program))]
        if absent:
            return f"not on this machine: {', '.join(absent)}; toolchain/setup full installs it"
        if not any(self.images.glob(f"adit-{self.name}-*.img")):
            return f"there is no image: toolchain/image {self.name} makes it"
        return "" if os.path.exists("/dev/net/tun") else "no taps here: /dev/net/tun is missing"


# QEMU's arm64 `virt`, started by U-Boot, with eight GPIO lines as in board.json. Line 3 is the machine's own power
# key.
VIRT = ["-M", "virt,acpi=off", "-cpu", "cortex-a53", "-smp", "2", "-nodefaults", "-display", "none"]
LINES = ["ADIT_HEALTH", "ADIT_SCORING", "ADIT_MAPPING", "POWER_KEY", "ADIT_ATTENTION", "ADIT_BUTTON", "", ""]


def environment_of(board):
    """The lines of board/BOARD/u-boot.env, one per variable."""
    lines = (SOURCE / "board" / board / "u-boot.env").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def virt(folder, memory, told=None):
    """Boot loader, its environment (`told`, or the board's own), device tree."""
    loader, environment, tree = folder / "loader.bin", folder / "environment.bin", folder / "machine.dtb"
    package = next((SOURCE / "build" / "image" / "debian-arm64").glob("*/u-boot-qemu_*.deb"))
    opened = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE, check=True).stdout
    with open(loader, "wb") as made:
        subprocess.run(["tar", "-xO", "./usr/lib/u-boot/qemu_arm64/u-boot.bin"], input=opened, stdout=made, check=True)
    text = folder / "environment.txt"
    text.write_text("".join(line + "\n" for line in told or environment_of("qemu-virt")))
    subprocess.run(["mkenvimage", "-s", "0x40000", "-o", environment, text], check=True)
    for flash in (loader, environment):
        os.truncate(flash, FLASH_SIZE)
    dump = [word + f",dumpdtb={tree}" if word.startswith("virt") else word for word in VIRT]
    subprocess.run(["qemu-system-aarch64", *dump, "-m", str(memory)], check=True, stderr=subprocess.DEVNULL)
    subprocess.run(["fdtput", "-t", "s", tree, "/pl061@9030000", "gpio-line-names", *LINES], check=True)
    return [*VIRT, "-dtb", tree, *flashes(loader, environment)]


# A PC that GRUB starts by UEFI from a SATA disk. Its ports are of two models.
PC_FIRMWARE = pathlib.Path("/usr/share/OVMF")


def pc(folder, _):
    """UEFI with a copy of its variables, and a clock with an empty battery."""
    variables = folder / "variables.fd"
    shutil.copy(PC_FIRMWARE / "OVMF_VARS_4M.fd", variables)
    machine = ["-M", "q35", "-cpu", "qemu64", "-smp", "2", "-nodefaults", "-display", "none", "-rtc", "base=2020-01-01T00:00:00"]
    return [*machine, *flashes(PC_FIRMWARE / "OVMF_CODE_4M.fd", variables)]


def flashes(fixed, written):
    return ["-drive", f"if=pflash,format=raw,unit=0,readonly=on,file={fixed}",
            "-drive", f"if=pflash,format=raw,unit=1,file={written}"]


# The hardware watchdog counts the host's time, of which an emulated machine may get a tenth. After 20 s it would
# restart a machine whose PID 1 starts or reloads. So it has ten minutes, except in its own test (test_recovery.py).
WORDS = "adit.console systemd.watchdog_sec=600"

QEMU_VIRT = Board(
    name="qemu-virt",
    emulator="qemu-system-aarch64",
    soldered=virt,
    card="virtio-blk-pci",
    ports=("virtio-net-pci,addr=5,romfile=", "virtio-net-pci,addr=6,romfile="),
    words=WORDS,
    has_panel=True,
    needs=("dpkg-deb", "mkenvimage", "fdtput"),
)
PC = Board(
    name="generic-x86_64",
    emulator="qemu-system-x86_64",
    soldered=pc,
    card="ide-hd,bootindex=0",
    ports=("e1000e,addr=5,romfile=", "virtio-net-pci,addr=6,romfile="),
    words=f'"{WORDS} console=ttyS0,115200"',  # the console is the screen, and a test has none
    memory=512,
    needs=(str(PC_FIRMWARE / "OVMF_CODE_4M.fd"),),
)
