"""Man pages contain all of --help, and man(1) and mandoc(1) read them without warnings."""

import json
import re
import shutil
import subprocess
import unittest

from manuals import BIN, PROGRAMS, SOURCE, help_of, made, options_in, program


def pages():
    return sorted(made().glob("man/man*/*"))


def shown(page):
    """The page as text in one line, formatted so wide that no word is cut."""
    text = subprocess.run(["groff", "-man", "-Tascii", "-P-bcu", "-rLL=2000n", page], check=True, capture_output=True, text=True).stdout
    return re.sub(r"\s+", " ", text)


@unittest.skipUnless(shutil.which("groff"), "there is no groff here")
class ManPages(unittest.TestCase):
    def page_of(self, name):
        found = [page for page in pages() if page.stem == name]
        self.assertEqual(len(found), 1, name)
        return found[0]

    def test_each_program_and_the_settings_have_a_page(self):
        names = [page.name for page in pages()]
        for name in ("adit.1", "aditd.8", "adit-settings.5", *(f"{each}.1" for each in PROGRAMS if each in ("adit-rehearsal", "adit-robots"))):
            self.assertIn(name, names)
        self.assertEqual(len(names), len(PROGRAMS) + 1)

    def test_each_word_and_option_of_the_help_is_in_the_page(self):
        for name in PROGRAMS:
            text = shown(self.page_of(name))
            self.assertIn(f"{name} - ", text)
            self.has_each(options_in(help_of(name)), text, name)
            for command in program(name).commands:
                begin = text.index(f" {name} {command} ", text.index(" COMMANDS "))
                own = text[begin:text.index(" Exit status: ", begin)] + text[:begin]  # and what stands above all commands
                self.has_each(options_in(help_of(name, command)), own, f"{name} {command}")

    def has_each(self, words, text, where):
        missing = [word for word in words if not re.search(rf"(?<![\w-]){word}(?![\w-])", text)]
        self.assertEqual(missing, [], where)

    def test_sentences_are_those_of_the_help(self):
        self.assertIn("--settings FILE read the settings (JSON, version 1) from FILE, unless the state directory holds saved ones; adit",
                      shown(self.page_of("aditd")))
        adit = shown(self.page_of("adit"))
        self.assertIn("--run N|all Without a subcommand: list the reports of this run; if not given, of the present run", adit)
        self.assertIn("adit reports --run all --json | jq -r '.[] | [.number, .type, .state] | @tsv'", adit)
        self.assertIn("ENVIRONMENT ADIT_AT used if", adit)
        self.assertIn("SEE ALSO aditd(8), adit-settings(5)", adit)
        address = re.search(r'^set\(ADIT_BUGS "(.+)"\)$', (SOURCE / "CMakeLists.txt").read_text(), re.M)[1]
        self.assertIn(f"BUGS report them at {address}, with the file that adit bundle writes", adit)

    def test_each_key_of_the_settings_is_in_their_page(self):
        text = shown(self.page_of("adit-settings"))
        keys = json.loads(subprocess.run([BIN / "adit", "complete", "keys", "--json"], check=True, capture_output=True, text=True).stdout)
        self.assertGreater(len(keys), 50)
        missing = [key["path"] for key in keys if f" {key['path']} {key['meaning']} Allowed: {key['range']}" not in text]
        self.assertEqual(missing, [])
        review = next(key for key in keys if key["path"] == "reports.review")
        self.assertIn(f'{review["meaning"]} Allowed: "off", "duplicates" or "all". Default: "off".', text)

    def test_groff_reports_no_fault(self):
        for page in pages():
            told = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-z", page], capture_output=True, text=True).stderr
            self.assertEqual(told, "", page.name)

    @unittest.skipUnless(shutil.which("mandoc"), "there is no mandoc here")
    def test_mandoc_reports_no_fault(self):
        for page in pages():
            told = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], capture_output=True, text=True).stdout
            self.assertEqual(told, "", page.name)


class Versions(unittest.TestCase):
    def test_each_program_shows_its_version(self):
        told = {name: subprocess.run([BIN / name, "--version"], check=True, capture_output=True, text=True).stdout for name in PROGRAMS}
        version = told["aditd"].split()[1]
        self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        self.assertEqual(told, {name: f"{name} {version}\n" for name in PROGRAMS})
