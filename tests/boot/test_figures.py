"""What a start costs, and what the units may do: printed, and kept for rootfs/README.md."""

import lzma
import re
import unittest

from stage import Stage, Story, load_tests, note, setUpModule  # unittest looks for them here

QUIET = "SYSTEMD_COLORS=0 SYSTEMD_PAGER= "


class Figures(Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage())
        cls.stage.start().began()

    def test_a_later_start(self):
        self.box.console.wait_for_shell()
        self.box.console.ask("sync")
        self.box.cut_power()
        self.stage.start()
        note("later start, from power to the first answer on team0", self.box.start_took())
        self.box.console.wait_for_shell()

    def test_what_it_is_made_of(self):
        self.box.wait_until(lambda: self.box.console.run("systemd-analyze time")[0] == 0, "the start to be over", 400)
        said = self.box.console.ask(QUIET + "systemd-analyze time --no-pager").splitlines()[0]
        note("kernel and initrd, and user space, from the kernel's start", said)
        chain = self.box.console.ask(QUIET + "systemd-analyze critical-chain adit.service --no-pager --fuzz=10s")
        note("the units before aditd, and aditd", "\n" + re.sub(r"\x1b[^a-zA-Z]*[a-zA-Z]", "", chain))

    def test_memory_when_idle(self):
        used = int(self.box.console.ask("free -m | grep Mem").split()[2])
        note("RAM in use when idle", f"{used} MB of {self.box.memory}")
        self.assertLessEqual(used, 64)

    def test_the_image_is_small(self):
        packed = self.box.board.image().with_suffix(".img.xz")
        if packed.exists():
            size = packed.stat().st_size
        else:
            squeezer = lzma.LZMACompressor(preset=0)
            size = sum(len(squeezer.compress(some)) for some in blocks(self.box.board.image())) + len(squeezer.flush())
        note("image, compressed", f"{size / 1e6:.1f} MB")
        self.assertLessEqual(size, 40e6 if packed.exists() else 60e6)

    def test_what_the_units_may_do(self):
        units = self.box.console.ask("cd /usr/lib/systemd/system; ls adit*.service").split()
        self.assertIn("adit.service", units)
        for unit in (name for name in units if "@" not in name and name != "adit-console.service"):
            said = self.box.console.ask(f"{QUIET} systemd-analyze security --no-pager {unit} | tail -n 1")
            exposure = float(re.search(r"(\d+\.\d)", said).group(1))
            note(f"exposure of {unit}", exposure)
            self.assertLessEqual(exposure, 1.5 if unit == "adit.service" else 3.0, unit)


def blocks(path):
    with open(path, "rb") as file:
        while some := file.read(1 << 20):
            yield some


if __name__ == "__main__":
    unittest.main()
