#!/usr/bin/env python3
"""Every board is whole, and the image that was built for it has a driver for each device that it cannot do without."""
import json
import re
import subprocess
import sys
import unittest

from recipe import BOARDS, IMAGES, TOP, built, conf, nodes

NEEDED = re.compile(r"^(ethernet|mmc|gpio|watchdog|usb|i2c|switch\d*|mdio|phy)@")  # kinds of nodes
GROUP = "health", "scoring", "mapping", "attention", "button"


class Folders(unittest.TestCase):
    def test_every_folder_is_a_board(self):
        self.assertIn("qemu-virt", BOARDS)
        for folder in (path for path in (TOP / "board").iterdir() if path.is_dir()):
            with self.subTest(folder.name):
                self.assertIn(folder.name, BOARDS)
                self.assertRegex(folder.name, r"^[A-Za-z0-9_-]+$")

    def test_a_board_says_what_it_is_and_how_it_boots(self):
        for board in BOARDS:
            with self.subTest(board):
                for name in "title", "architecture", "kernel_package", "bootloader", "console", "initrd_modules", "modules":
                    self.assertTrue(conf(board, name), f"board.conf: no {name}")
                self.assertRegex(conf(board, "memory_max")[0], r"^[1-9]\d%$")
                self.assertTrue((TOP / "board" / board / "README.md").exists())

    def test_what_the_box_reads_is_the_same_board_with_all_lines_of_a_panel_or_none(self):
        for board in BOARDS:
            with self.subTest(board):
                data = json.loads((TOP / "board" / board / "board.json").read_text())
                self.assertEqual(data["name"], board)
                self.assertEqual([data["title"]], conf(board, "title"))
                if panel := data.get("panel"):
                    self.assertEqual(set(panel), {"chip", "active_low", "button_active_low", *GROUP})
                    self.assertEqual(len({panel[light] for light in GROUP}), len(GROUP))

    def test_the_ports_are_named_by_path_and_not_by_the_order_in_which_they_are_found(self):
        for board in BOARDS:
            with self.subTest(board):
                links = sorted((TOP / "board" / board).glob("*.link"))
                if not links:  # usr/lib/adit/ports does it, for ports on PCI, which are in no device tree
                    self.assertFalse(conf(board, "dtb"))
                    continue
                self.assertEqual([link.name for link in links], ["10-darpa0.link", "10-team0.link"])
                matches = [re.search(r"^(Path|OriginalName)=(.*)$", link.read_text(), re.M) for link in links]
                self.assertTrue(all(matches))
                self.assertNotEqual(matches[0][2], matches[1][2])
                self.assertFalse(any(re.match(r"eth\d|\*", match[2]) for match in matches))


class Wiring(unittest.TestCase):
    """What a board's README says of its panel is what its `lines`, its picture and its panel have; each line has its source."""

    def wired(self):
        for board in BOARDS:
            if (TOP / "board" / board / "lines").exists():
                text = (TOP / "board" / board / "README.md").read_text()
                yield board, text, dict(re.findall(r"^\| (health|scoring|mapping|attention|button) \| (.*) \|$", text, re.M))

    @staticmethod
    def lines(board):
        """By what they are: (node, line, comment)."""
        found = re.findall(r"^(\S+) +(\d+) +ADIT_(\w+) *(?:# (.*))?$", (TOP / "board" / board / "lines").read_text(), re.M)
        return {name.lower(): (node, int(line), comment) for node, line, name, comment in found}

    def test_each_row_of_a_table_names_a_source_that_is_listed(self):
        for board, text, panel in self.wired():
            with self.subTest(board):
                self.assertEqual(set(panel), set(GROUP))
                listed = set(re.findall(r"^- (\[[A-Z]\]) ", text, re.M))
                for row in re.findall(r"^\| (?!--).* \|$(?!\n\| --)", text, re.M):
                    sources = set(re.findall(r"\[[A-Z]\]", row))
                    self.assertTrue(sources and sources <= listed, row)

    def test_a_line_is_the_same_in_the_table_the_picture_and_the_device_tree(self):
        for board, _, panel in self.wired():
            picture = (TOP / "board" / board / "board.svg").read_text()
            for name, (node, line, comment) in self.lines(board).items():
                with self.subTest(board, line=name):
                    drawn = re.search(rf">{name}</text><text [^>]*>([^<]*)<", picture)[1]
                    if chip := re.match(r"GPIO(\d)_([A-D])(\d), pin (\d+)$", comment):
                        bank, group, bit, pin = chip.groups()
                        self.assertEqual(line, "ABCD".index(group) * 8 + int(bit))
                        self.assertEqual(node, f"/pinctrl/gpio@ff2{int(bank) + 1}0000")
                        self.assertEqual(panel[name].split(" | ")[:2], [f"GPIO{bank}_{group}{bit}", pin])
                        self.assertEqual(drawn, comment)
                    else:
                        self.assertRegex(panel[name], rf"\bline {line}\b")
                        self.assertRegex(drawn, rf"\bline {line}\b")


class Loaders(unittest.TestCase):
    """Of the boards' own boot loaders, what can be known without the boards."""

    SCRIPTS = ["rootfs/boot/boot.cmd", "rootfs/boot/slot.cmd.in"]
    # KNOWN: to every boot loader that a board may have (board/espressobin/README.md).
    SHELL = {"if", "elif", "else", "fi", "for", "do", "done", "then"}
    KNOWN = {"booti", "echo", "env", "load", "part", "reset", "setenv", "size", "sleep", "source", "test", "true"}

    def commands(self):
        text = "".join((TOP / script).read_text() for script in self.SCRIPTS)
        pieces = re.split(r"\n|; |&&|\|\|", re.sub(r'^ *#.*|@load_dtb@|"[^"]*"', "", text, flags=re.M))
        words = [re.sub(r"^(?:(?:if|elif|then|do|else) )+", "", piece.strip()).split(" ")[0] for piece in pieces]
        return {word for word in words if word} - self.SHELL

    def test_the_scripts_use_only_what_the_boot_loaders_of_2017_know(self):
        self.assertEqual(self.commands() - {"${devtype}"}, self.KNOWN)
        text = (TOP / self.SCRIPTS[0]).read_text()
        for imported in re.findall(r"env import -[ct] (.*)", text):  # address and size: a name after them would be taken for no size
            self.assertEqual(len(re.match(r"[^|;]*", imported)[0].split()), 2, imported)

    @staticmethod
    def package(name):
        packages = list((IMAGES / "debian-arm64").glob(f"*/{name}_*.deb"))
        return packages[0] if packages else None

    def test_the_loader_in_the_image_knows_each_command_and_has_the_environment(self):
        name, file = "u-boot-rockchip", "./usr/lib/u-boot/rock-pi-e-rk3328/u-boot-nodtb.bin"
        if not (package := self.package(name)):
            self.skipTest(f"{name} was not fetched here: toolchain/image rock-pi-e does")
        opened = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE, check=True).stdout
        loader = subprocess.run(["tar", "-xO", file], input=opened, stdout=subprocess.PIPE, check=True).stdout
        for command in self.KNOWN | {"mmc"}:
            self.assertIn(command.encode() + b"\0", loader, command)
        for line in (TOP / "board/rock-pi-e/u-boot.env").read_text().splitlines():
            if not line.startswith("#"):
                self.assertRegex(loader, re.escape(line.encode()) + b" ?\0")

    def test_what_is_loaded_does_not_overlap(self):
        boards = [board for board in built() if (TOP / "board" / board / "u-boot.env").exists()]
        if not boards:
            self.skipTest("no image of a board with U-Boot was built here")
        for board in boards:
            slot = IMAGES / board / "work/slot"
            kernel = slot.joinpath("Image").read_bytes()[16:24]  # Linux, Documentation/arm64/booting.rst: image_size
            sizes = {"scriptaddr": 1 << 16, "kernel_addr_r": int.from_bytes(kernel, "little") + (2 << 20),  # it is moved to whole 2 MiB
                     "ramdisk_addr_r": (slot / "initrd").stat().st_size}
            if (slot / "board.dtb").exists():
                sizes["fdt_addr_r"] = (slot / "board.dtb").stat().st_size + (64 << 10)  # U-Boot adds to it
            with self.subTest(board):
                self.check_apart(board, sizes)

    def check_apart(self, board, sizes):
        text = (TOP / "board" / board / "u-boot.env").read_text()
        places = sorted((int(re.search(rf"^{name}=(0x[0-9a-f]+)$", text, re.M)[1], 16), size, name) for name, size in sizes.items())
        for (start, size, name), (after, _, other) in zip(places, places[1:]):
            self.assertLessEqual(start + size, after, f"{name} runs into {other}")
        self.assertLess(sum(places[-1][:2]) - places[0][0], 192 << 20, "the smallest board has 256 MB, and U-Boot is at its end")


class Drivers(unittest.TestCase):
    """Of the images that were built here."""

    def test_each_device_that_is_needed_has_a_driver_in_the_image_or_in_the_kernel(self):
        for board, dtb in self.device_trees():
            root = IMAGES / board / "work/root"
            modules = next(root.glob("usr/lib/modules/*"))
            aliases = re.findall(r"^alias (of:\S+) (\S+)$", (modules / "modules.alias").read_text(), re.M)
            kernel = next((IMAGES / board / "work/slot").glob("Image")).read_bytes()
            for path, properties in nodes(dtb).items():
                if not NEEDED.match(path.rsplit("/", 1)[-1]) or "compatible" not in properties:
                    continue
                names = properties["compatible"].strip('"').split("\\0")
                with self.subTest(f"{board} {path}", compatible=names):
                    module = any(self.fits(alias, name) for alias, _ in aliases for name in names)
                    builtin = any(b"\0" + name.encode() + b"\0" in kernel for name in names)
                    self.assertTrue(module or builtin or names[0].startswith("ethernet-phy-id"))

    def test_what_finds_the_root_is_in_the_initrd(self):
        for board in built():
            with self.subTest(board):
                order = (IMAGES / board / "work/initrd.modules").read_text()
                builtin = next((IMAGES / board / "work/root").glob("usr/lib/modules/*/modules.builtin")).read_text()
                for module in [*conf(board, "initrd_modules"), "squashfs"]:
                    self.assertRegex(order + builtin, "/" + re.sub("[-_]", "[-_]", module) + r"\.ko")

    def test_the_lines_of_the_panel_have_their_names_in_the_device_tree(self):
        for board, dtb in self.device_trees():
            panel = json.loads((TOP / "board" / board / "board.json").read_text()).get("panel")
            if not panel:
                continue
            names = {name for properties in nodes(dtb).values() for name in properties.get("gpio-line-names", "").strip('"').split("\\0")}
            with self.subTest(board):
                self.assertLessEqual({panel[light] for light in GROUP}, names)

    def test_the_ports_are_where_the_device_tree_has_them(self):
        for board, dtb in self.device_trees():
            tree = nodes(dtb)
            for link in (TOP / "board" / board).glob("*.link"):
                with self.subTest(board, link=link.name):
                    kind, what = re.search(r"^(Path|OriginalName)=(.*)$", link.read_text(), re.M).groups()
                    if kind == "Path":  # platform-ff540000.ethernet is the node ethernet@ff540000
                        address, device = re.fullmatch(r"platform-([0-9a-f]+)\.(\w+)", what).groups()
                        self.assertIn(f"/{device}@{address}", tree)
                    else:
                        self.assertIn(f'"{what}"', [properties.get("label") for properties in tree.values()])

    def device_trees(self):
        boards = [board for board in built() if (IMAGES / board / "work/slot/board.dtb").exists()]
        if not boards:
            self.skipTest("no image with a device tree was built here")
        return [(board, IMAGES / board / "work/slot/board.dtb") for board in boards]

    @staticmethod
    def fits(alias: str, name: str) -> bool:
        return re.fullmatch(r"of:N\*T\*C" + re.escape(name) + r"(C\*)?", alias) is not None


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main()
