"""The cost of a boot and the privileges of its units: printed, and kept for rootfs/README.md."""

import re

from stage import note

QUIET = "SYSTEMD_COLORS=0 SYSTEMD_PAGER= "


def of_a_later_start(box):
    """The parts of the boot's duration. The box has a shell."""
    box.wait_until(lambda: box.console.run("systemd-analyze time")[0] == 0, "the start to be over", 400)
    said = box.console.ask(QUIET + "systemd-analyze time --no-pager").splitlines()[0]
    note("kernel and initrd, and user space, from the kernel's start", said)
    chain = box.console.ask(QUIET + "systemd-analyze critical-chain adit.service --no-pager --fuzz=10s")
    note("the units before aditd, and aditd", "\n" + re.sub(r"\x1b[^a-zA-Z]*[a-zA-Z]", "", chain))


def memory_in_use(box):
    """Used memory in MB."""
    used = int(box.console.ask("free -m | grep Mem").split()[2])
    note("RAM in use when idle", f"{used} MB of {box.memory}")
    return used


def exposures(box):
    """systemd-analyze's rating of each of Adit's units that a boot starts, and its limit."""
    units = box.console.ask("cd /usr/lib/systemd/system; ls adit*.service").split()
    for unit in (name for name in units if "@" not in name and name != "adit-console.service"):
        said = box.console.ask(f"{QUIET} systemd-analyze security --no-pager {unit} | tail -n 1")
        exposure = float(re.search(r"(\d+\.\d)", said).group(1))
        note(f"exposure of {unit}", exposure)
        yield unit, exposure, 1.5 if unit == "adit.service" else 3.0
