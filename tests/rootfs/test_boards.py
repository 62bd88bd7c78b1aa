"""Checks the files of every board; test_image.py checks the images."""
import json
import re
import unittest

from recipe import BOARDS, GROUP, KNOWN, TOP, conf, some


class Folders(unittest.TestCase):
    def test_every_folder_is_a_board(self):
        self.assertIn("qemu-virt", BOARDS)
        for folder in (path for path in (TOP / "board").iterdir() if path.is_dir()):
            with self.subTest(folder.name):
                self.assertIn(folder.name, BOARDS)
                self.assertRegex(folder.name, r"^[A-Za-z0-9_-]+$")
                self.assertIn(f"\n| [{folder.name}]({folder.name}/README.md) |", (TOP / "board/README.md").read_text())

    def test_board_conf_is_complete(self):
        for board in BOARDS:
            with self.subTest(board):
                for name in "title", "architecture", "kernel_package", "bootloader", "console", "initrd_modules", "modules":
                    self.assertTrue(conf(board, name), f"board.conf: no {name}")
                self.assertRegex(conf(board, "memory_max")[0], r"^[1-9]\d%$")
                self.assertTrue((TOP / "board" / board / "README.md").exists())

    def test_board_json_matches_and_has_all_panel_lines_or_none(self):
        for board in BOARDS:
            with self.subTest(board):
                data = json.loads((TOP / "board" / board / "board.json").read_text())
                self.assertEqual(data["name"], board)
                self.assertEqual([data["title"]], conf(board, "title"))
                if panel := data.get("panel"):
                    self.assertEqual(set(panel), {"chip", "active_low", "button_active_low", *GROUP})
                    self.assertEqual(len({panel[light] for light in GROUP}), len(GROUP))

    def test_ports_are_named_by_path(self):
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
    """A board's README describes its panel as its `lines`, its picture and its panel have it. Each line has its source."""

    def wired(self):
        for board in some(board for board in BOARDS if (TOP / "board" / board / "lines").exists()):
            text = (TOP / "board" / board / "README.md").read_text()
            yield board, text, dict(re.findall(r"^\| (health|scoring|mapping|attention|button) \| (.*) \|$", text, re.M))

    @staticmethod
    def lines(board):
        """By function: (node, line, comment)."""
        found = re.findall(r"^(\S+) +(\d+) +ADIT_(\w+) *(?:# (.*))?$", (TOP / "board" / board / "lines").read_text(), re.M)
        return {name.lower(): (node, int(line), comment) for node, line, name, comment in found}

    def test_each_row_names_a_listed_source(self):
        for board, text, panel in self.wired():
            with self.subTest(board):
                self.assertEqual(set(panel), set(GROUP))
                listed = set(re.findall(r"^- (\[[A-Z]\]) ", text, re.M))
                for row in some(re.findall(r"^\| (?!--).* \|$(?!\n\| --)", text, re.M)):
                    sources = set(re.findall(r"\[[A-Z]\]", row))
                    self.assertTrue(sources and sources <= listed, row)

    def test_table_picture_and_device_tree_agree(self):
        for board, _, panel in self.wired():
            picture = (TOP / "board" / board / "board.svg").read_text()
            lines = self.lines(board)
            self.assertEqual(set(lines), set(GROUP), board)
            for name, (node, line, comment) in lines.items():
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
    """Facts about the boards' own boot loaders that can be checked without the boards."""

    SCRIPTS = ["rootfs/boot/boot.cmd", "rootfs/boot/decide.cmd", "rootfs/boot/slot.cmd.in"]
    SHELL = {"if", "elif", "else", "fi", "for", "do", "done", "then"}

    def commands(self):
        text = "".join((TOP / script).read_text() for script in self.SCRIPTS)
        pieces = re.split(r"\n|; |&&|\|\|", re.sub(r'^ *#.*|@load_dtb@|"[^"]*"', "", text, flags=re.M))
        words = [re.sub(r"^(?:(?:if|elif|then|do|else) )+", "", piece.strip()).split(" ")[0] for piece in pieces]
        return {word for word in words if word} - self.SHELL

    def test_scripts_use_only_commands_of_2017(self):
        self.assertEqual(self.commands() - {"${devtype}"}, KNOWN)
        text = "".join((TOP / script).read_text() for script in self.SCRIPTS)
        for imported in some(re.findall(r"env import -[ct] (.*)", text)):  # address and size: a name after them would be taken for no size
            self.assertEqual(len(re.match(r"[^|;]*", imported)[0].split()), 2, imported)
