"""The image that was built here: small, and with only the parts on its list."""
import gzip
import json
import os
import re
import subprocess
import unittest
from pathlib import Path

from recipe import GROUP, IMAGES, KNOWN, TOP, built, conf, nodes, some

ARCHITECTURE = subprocess.run(["dpkg", "--print-architecture"], check=True, capture_output=True, text=True).stdout.strip()
ID = re.compile(r"SPDXRef-[A-Za-z0-9.-]+")
NEEDED = re.compile(r"^(ethernet|mmc|gpio|watchdog|usb|i2c|switch\d*|mdio|phy)@")  # kinds of nodes of a device tree
SPDX_IDS = {"Apache-2.0", "Artistic-1.0-Perl", "BSD-2-Clause", "BSD-3-Clause", "BSD-4-Clause", "BSL-1.0", "CC0-1.0", "GFDL-1.2-or-later", "GFDL-1.3-or-later",
            "GPL-1.0-or-later", "GPL-2.0-only", "GPL-2.0-or-later", "GPL-3.0-only", "GPL-3.0-or-later", "ISC", "LGPL-2.0-only", "LGPL-2.0-or-later",
            "LGPL-2.1-only", "LGPL-2.1-or-later", "LGPL-3.0-or-later", "MIT", "Zlib"}  # those of the SPDX list, version 3.19, that parts have
BOARDS = built()


def setUpModule():
    some(BOARDS, "no image was built here; toolchain/image builds one")


def parts_of(board: str) -> dict:
    return json.loads((IMAGES / board / "work/parts.spdx.json").read_text())


def elf_files(root: Path):
    for path in root.rglob("*"):
        if path.is_file() and not path.is_symlink():
            with path.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield str(path.relative_to(root))


class Parts(unittest.TestCase):
    def test_the_list_is_spdx_2_3(self):
        for board in BOARDS:
            with self.subTest(board):
                document = parts_of(board)
                self.assertEqual((document["spdxVersion"], document["dataLicense"], document["SPDXID"]), ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
                self.assertRegex(document["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
                self.assertTrue(document["creationInfo"]["creators"][0].startswith("Tool: "))
                self.assertRegex(document["documentNamespace"], r"^urn:uuid:[0-9a-f-]{36}$")
                ids = [package["SPDXID"] for package in document["packages"]]
                self.assertEqual(len(ids), len(set(ids)))
                self.assertTrue(all(ID.fullmatch(each) for each in ids))
                ends = {end for relation in document["relationships"] for end in (relation["spdxElementId"], relation["relatedSpdxElement"])}
                self.assertLessEqual(ends, {*ids, "SPDXRef-DOCUMENT"})
                self.assertLessEqual(set(ids), ends)

    def test_no_part_has_a_gap(self):
        """Version, licence, source: of the list that is published."""
        for board, package, texts in self.published():
            with self.subTest(board, package=package["name"]):
                self.assertTrue(package["versionInfo"])
                self.assertEqual(package["licenseDeclared"], package["licenseConcluded"])
                terms = re.sub(r" AND | OR |[()]", " ", package["licenseDeclared"]).split()
                self.assertTrue(terms)
                self.assertEqual(set(terms) - SPDX_IDS - set(texts), set())
                if package["SPDXID"] not in ("SPDXRef-image", "SPDXRef-adit"):
                    self.assertRegex(package["downloadLocation"], r"^https://snapshot\.debian\.org/package/[^/]+/[^/]+/$")
                    self.assertRegex(package["sourceInfo"], r"^built from Debian's source packages \S+ \(\S+\)(, \S+ \(\S+\))*$")
                if package["SPDXID"].startswith("SPDXRef-deb-"):
                    self.assertRegex(package["checksums"][0]["checksumValue"], r"^[0-9a-f]{64}$")

    def test_each_text_of_a_licence_is_in_a_copyright_file_and_says_more_than_a_name(self):
        def words(text):
            return " ".join(re.sub(r"^ *\.$", "", text, flags=re.M).split())

        for board in BOARDS:
            files = [words(path.read_text()) for path in (IMAGES / board / "work/root/usr/share/doc").glob("*/copyright")]
            for licence in json.loads(self.list_of(board).read_text())["hasExtractedLicensingInfos"]:
                with self.subTest(board, licence=licence["licenseId"]):
                    text = licence["extractedText"]
                    self.assertGreaterEqual(len(text), 50)
                    for paragraph in map(words, text.split("\n\n")):
                        self.assertTrue(any(paragraph in file for file in files), paragraph)

    def test_the_image_has_the_copyright_file_of_each_part_and_each_licence_that_it_refers_to(self):
        for board, package, _ in self.published():
            if package["SPDXID"] not in ("SPDXRef-image", "SPDXRef-boost"):
                with self.subTest(board, package=package["name"]):
                    share = IMAGES / board / "work/root/usr/share"
                    text = (share / "doc" / package["name"] / "copyright").read_text()
                    self.assertGreater(len(text), 400)
                    for name in re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", text):
                        self.assertGreater((share / "common-licenses" / name).stat().st_size, 1000, name)

    @staticmethod
    def list_of(board: str) -> Path:
        return max((IMAGES / board).glob(f"adit-{board}-*.spdx.json"), key=lambda path: path.stat().st_mtime)

    def published(self):
        """(board, part, texts of licences by their references) of each part of each list."""
        for board in BOARDS:
            document = json.loads(self.list_of(board).read_text())
            for package in document["packages"]:
                yield board, package, {each["licenseId"]: each["extractedText"] for each in document["hasExtractedLicensingInfos"]}

    def test_list_has_the_boot_parts_and_only_installed_packages(self):
        for board in BOARDS:
            with self.subTest(board):
                names = {package["name"] for package in parts_of(board)["packages"]}
                self.assertLessEqual({"adit", "busybox-static", "systemd", "libc6", *conf(board, "boot_packages")}, names)
                self.assertEqual(len([name for name in names if name.startswith("linux-image-")]), 1)
                self.assertFalse(names & {"adduser", "passwd", "debconf", "libpam-modules"})

    def test_every_program_and_library_is_of_a_listed_part(self):
        for board in BOARDS:
            with self.subTest(board):
                work = IMAGES / board / "work"
                names = {package["name"] for package in parts_of(board)["packages"]}
                owners = dict(line.split("\t") for line in (work / "parts.spdx.json.owners").read_text().splitlines())
                adit = {line.rpartition(f"{work.name}/root/")[2] for line in (work / "install.log").read_text().splitlines()}
                for path in some(elf_files(work / "root")):
                    owner = owners.get(path) or owners.get(re.sub("^usr/", "", path))
                    self.assertTrue(owner in names or path in adit, f"{path} is of no part")

    def test_the_box_has_its_own_list_with_it(self):
        for board in BOARDS:
            with self.subTest(board):
                inside = gzip.decompress((IMAGES / board / "work/root/usr/share/adit/parts.spdx.json.gz").read_bytes())
                self.assertEqual(json.loads(inside), parts_of(board))


class Root(unittest.TestCase):
    def test_an_image_is_at_most_40_mb_compressed(self):
        """If it exists: a release has it, and a build without --no-xz."""
        for image in some((image for board in BOARDS for image in (IMAGES / board).glob("*.img.xz")), "no image was compressed here"):
            with self.subTest(image.name):
                self.assertLessEqual(image.stat().st_size, 40_000_000)

    def test_a_slot_is_small(self):
        """Compressed, the image of an arm64 board is a third of that (rootfs/README.md)."""
        for board in BOARDS:
            with self.subTest(board):
                slot = [IMAGES / board / "work/root.squashfs", *(IMAGES / board / "work/slot").rglob("*")]
                self.assertLessEqual(sum(path.stat().st_size for path in slot if path.is_file()), 100_000_000)

    def test_no_setuid_files_and_no_package_manager(self):
        for board in BOARDS:
            root = IMAGES / board / "work/root"
            with self.subTest(board):
                for path in root.rglob("*"):
                    if not path.is_symlink():
                        self.assertFalse(path.stat().st_mode & 0o6000 and path.is_file(), path)
                for program in "apt", "apt-get", "dpkg", "sudo", "su", "login", "sshd", "passwd":
                    self.assertFalse(list(root.glob(f"usr/*bin/{program}")))

    def test_libraries_for_tls_and_downloads_are_absent(self):
        """libnettle is allowed, because chronyd uses its checksums."""
        for board in BOARDS:
            there = {path.name.partition(".so")[0] for path in (IMAGES / board / "work/root").rglob("lib*.so*")}
            with self.subTest(board):
                self.assertEqual(there & {"libhogweed", "libp11-kit", "libkrb5", "libldap-2", "libssh2", "libnghttp2"}, set())
                self.assertLessEqual({"libgcc_s", "libidn2"}, there, "opened by name")

    def test_programs_of_a_like_board_resolve_each_function(self):
        """Including the stand-ins: linked at their start, without lazy binding."""
        alike = (board for board in BOARDS if conf(board, "architecture") == [ARCHITECTURE])
        for board in some(alike, f"no image of a board of {ARCHITECTURE} was built here"):
            root = IMAGES / board / "work/root"
            for program in "aditd", "adit", "rauc":
                with self.subTest(board, program=program):
                    said = subprocess.run(["chroot", root, f"/usr/bin/{program}", "--version"], capture_output=True, text=True,
                                          env={"LD_BIND_NOW": "1", "PATH": "/usr/sbin:/usr/bin"})
                    self.assertEqual((said.returncode, said.stderr), (0, ""), said)

    def test_each_required_library_exists(self):
        for board in BOARDS:
            root = IMAGES / board / "work/root"
            there = {path.name for path in root.rglob("*.so*")}
            with self.subTest(board):
                files = some(root / path for path in elf_files(root) if not path.endswith(".ko"))
                said = subprocess.run(["readelf", "-d", *files], capture_output=True, text=True).stdout
                self.assertLessEqual(set(re.findall(r"\(NEEDED\).*\[(.*)\]", said)), there)

    def test_each_program_of_a_unit_exists(self):
        for board in BOARDS:
            root = IMAGES / board / "work/root"
            for unit in some(root.glob("usr/lib/systemd/system/**/*")):
                if not unit.is_file() or unit.is_symlink():
                    continue
                for line in re.findall(r"^Exec\w+=[-@:+!|]*([^\s$]+)", unit.read_text(), re.M):
                    with self.subTest(board, unit=unit.name):
                        places = [root / line.lstrip("/")] if line.startswith("/") else [root / "usr/bin" / line, root / "usr/sbin" / line]
                        self.assertTrue(any(os.path.lexists(place) for place in places), line)


class Loaders(unittest.TestCase):
    def test_loader_has_each_command_and_the_environment(self):
        packages = IMAGES.glob("debian-arm64/*/u-boot-rockchip_*.deb")
        package, *_ = some(packages, "u-boot-rockchip was not fetched here: the image of an arm64 board does")
        file = "./usr/lib/u-boot/rock-pi-e-rk3328/u-boot-nodtb.bin"
        opened = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE, check=True).stdout
        loader = subprocess.run(["tar", "-xO", file], input=opened, stdout=subprocess.PIPE, check=True).stdout
        for command in KNOWN | {"mmc"}:
            self.assertIn(command.encode() + b"\0", loader, command)
        for line in (TOP / "board/rock-pi-e/u-boot.env").read_text().splitlines():
            if not line.startswith("#"):
                self.assertRegex(loader, re.escape(line.encode()) + b" ?\0")

    def test_loaded_parts_do_not_overlap(self):
        boards = (board for board in BOARDS if (TOP / "board" / board / "u-boot.env").exists())
        for board in some(boards, "no image of a board with U-Boot was built here"):
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
    def test_each_required_device_has_a_driver(self):
        for board, dtb in self.device_trees():
            root = IMAGES / board / "work/root"
            modules = next(root.glob("usr/lib/modules/*"))
            aliases = re.findall(r"^alias (of:\S+) (\S+)$", (modules / "modules.alias").read_text(), re.M)
            kernel = next((IMAGES / board / "work/slot").glob("Image")).read_bytes()
            tree = nodes(dtb).items()
            for path, properties in some((path, has) for path, has in tree if NEEDED.match(path.rsplit("/", 1)[-1]) and "compatible" in has):
                names = properties["compatible"].strip('"').split("\\0")
                with self.subTest(f"{board} {path}", compatible=names):
                    module = any(self.fits(alias, name) for alias, _ in aliases for name in names)
                    builtin = any(b"\0" + name.encode() + b"\0" in kernel for name in names)
                    self.assertTrue(module or builtin or names[0].startswith("ethernet-phy-id"), "board.conf: modules has no driver of it")

    def test_initrd_has_the_modules_for_the_root(self):
        for board in BOARDS:
            with self.subTest(board):
                order = (IMAGES / board / "work/initrd.modules").read_text()
                builtin = next((IMAGES / board / "work/root").glob("usr/lib/modules/*/modules.builtin")).read_text()
                for module in [*conf(board, "initrd_modules"), "squashfs"]:
                    self.assertRegex(order + builtin, "/" + re.sub("[-_]", "[-_]", module) + r"\.ko")

    def test_panel_lines_are_named_in_the_device_tree(self):
        for board, dtb in self.device_trees():
            panel = json.loads((TOP / "board" / board / "board.json").read_text()).get("panel")
            if not panel:
                continue
            names = {name for properties in nodes(dtb).values() for name in properties.get("gpio-line-names", "").strip('"').split("\\0")}
            with self.subTest(board):
                self.assertLessEqual({panel[light] for light in GROUP}, names)

    def test_ports_match_the_device_tree(self):
        for board, dtb in self.device_trees():
            tree = nodes(dtb)
            for link in some((TOP / "board" / board).glob("*.link")):
                with self.subTest(board, link=link.name):
                    kind, what = re.search(r"^(Path|OriginalName)=(.*)$", link.read_text(), re.M).groups()
                    if kind == "Path" and "-usb-" not in what:  # platform-ff540000.ethernet is the node ethernet@ff540000
                        self.assertIn(re.sub(r"platform-(\w+)\.(\w+).*", r"/\2@\1", what), tree)
                    elif kind == "OriginalName":
                        self.assertIn(f'"{what}"', [properties.get("label") for properties in tree.values()])

    def device_trees(self):
        trees = ((board, IMAGES / board / "work/slot/board.dtb") for board in BOARDS)
        return some(((board, dtb) for board, dtb in trees if dtb.exists()), "no image of a board with a device tree was built here")

    @staticmethod
    def fits(alias: str, name: str) -> bool:
        return re.fullmatch(r"of:N\*T\*C" + re.escape(name) + r"(C\*)?", alias) is not None
