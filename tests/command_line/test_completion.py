"""Completion in bash, zsh and fish, run by these shells. Missing shells are skipped with a message."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

import shells
from manuals import BIN, PROGRAMS, SOURCE, help_of, made, options_in, program

LISTERS = {"bash": shells.by_bash, "fish": shells.by_fish}


def installed(names):
    return [name for name in names if shutil.which(name)]


class Offers(unittest.TestCase):
    """The common offers of all shells."""

    def offered(self, line):
        """The offers of each shell."""
        for shell in installed(LISTERS):
            with self.subTest(shell=shell, line=line):
                yield LISTERS[shell](line)

    def offers(self, line, *words):
        for said in self.offered(line):
            self.assertEqual(sorted(said), sorted(words))

    def test_commands(self):
        for said in self.offered("adit "):
            self.assertLessEqual(set(program("adit").commands) | {"help"}, set(said))
        self.offers("adit sta", "status")
        self.offers("adit help re", "rejected", "reports", "reset")
        self.offers("adit --json wa", "watch")
        self.offers("adit --at 10.0.0.1:8000 wa", "watch")
        self.offers("adit --settings status wa", "watch")

    def test_words_of_a_command(self):
        self.offers("adit reports s", "show", "send", "settle")
        self.offers("adit reports --json s", "show", "send", "settle")
        self.offers("adit run n", "new")
        self.offers("adit settings se", "set")

    def test_options(self):
        self.offers("adit --ver", "--version")
        self.offers("adit reports --ru", "--run")
        self.offers("adit reports --la", "--last")
        self.offers("adit reports send --y", "--yes")
        self.offers("adit update --st", "--stay", "--stick")
        self.offers("aditd --setti", "--settings")
        self.offers("adit-panel --si", "--simulated")
        self.offers("adit run new --cs")
        self.offers("adit reports show --ru")

    def test_values(self):
        self.offers("adit-robots --style cbor-", "cbor-plain", "cbor-body-gzip")
        self.offers("adit-rehearsal --counts l", "last-bytes")
        self.offers("adit reports --run a", "all")

    def test_keys_of_the_settings(self):
        self.offers("adit settings show reports.n", "reports.near_metres")
        self.offers("adit settings show robots[].al", "robots[].alias")
        self.offers("adit settings set reports.n", "reports.near_metres")
        self.offers("adit settings set reports.review a", "all")
        self.offers("adit settings set team.require_token ", "false", "true")

    def test_files_and_folders(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "box.json").touch()
            pathlib.Path(folder, "secrets").mkdir()
            for line, found in (("adit settings apply ", "box.json"), ("adit check ", "box.json"), ("aditd --settings ", "box.json"),
                                ("aditd --secrets ", "secrets")):
                for said in self.offered(f"{line}{folder}/{found[0]}"):
                    self.assertEqual([each.rstrip("/") for each in said], [f"{folder}/{found}"])

    def test_each_word_and_option_of_the_help(self):
        for name in PROGRAMS:
            for said in self.offered(f"{name} -"):
                self.assertEqual(sorted(said), sorted(word for word in options_in(help_of(name)) if word[0] == "-"))
            for command, about in program(name).commands.items():
                known = set(options_in(help_of(name, command)))
                lines = [f"{name} {command} ", *(f"{name} {command} {row.word} " for row in about.words)]
                for shell in installed(LISTERS):
                    said = {word for line in lines for dash in ("", "-") for word in LISTERS[shell](line + dash)}
                    self.assertLessEqual(known, said | {"--help"}, f"{shell}: {name} {command}")

    def test_exactly_the_accepted_options_are_offered(self):
        """All accepted words are offered: the real program is asked."""
        about = {row.word: row.value for row in program("adit").help.options}
        for command, told in program("adit").commands.items():
            about |= {row.word: row.value for row in told.options}
        for command, told in program("adit").commands.items():
            for word in [row.word for row in told.words] or [""]:
                offered = {each for each in shells.by_bash(f"adit {command} {word} -".replace("  ", " ")) if each != "--help"}
                hidden = {"--settings"} if command == "check" else set()  # SETTINGS says the same
                for option in set(about) - {"--help", "--version"} - hidden:
                    value = [{"--run": "all", "--last": "5", "--scoring": "10.0.0.1:80", "--mapping": "10.0.0.1:80"}.get(option, "/none")] if about[option] else []
                    words = [each for each in (command, word) if each]
                    said = subprocess.run([BIN / "adit", *words, option, *value], capture_output=True, text=True).stderr
                    alone = command == "update" and option in ("--anyway", "--again")  # these want another beside them
                    self.assertEqual("does not take" not in said or alone, option in offered, f"adit {words} {option}: {said}")

    def test_each_offered_value_is_accepted(self):
        for name in ("adit-robots", "adit-rehearsal"):
            for row in program(name).help.options if name in PROGRAMS else []:
                for choice in row.choices:
                    said = subprocess.run([BIN / name, row.word, choice], capture_output=True, text=True).stderr
                    self.assertNotIn(f"{row.word}: ", said.splitlines()[0])


class AtATerminal(unittest.TestCase):
    """A typed Tab."""

    def completes(self, shell):
        if not shutil.which(shell):
            self.skipTest(f"there is no {shell} here")
        with tempfile.TemporaryDirectory(prefix="adit-shell-") as folder:
            terminal = shells.Terminal(shell, pathlib.Path(folder))
            self.addCleanup(terminal.close)
            for line, words in (("adit sta", "adit status"), ("adit rep", "adit reports"), ("adit reports sen", "adit reports send"),
                                ("adit reports send --y", "adit reports send --yes"), ("adit help wa", "adit help watch"),
                                ("adit settings show reports.n", "adit settings show reports.near_metres"),
                                ("adit --at 10.0.0.1:8000 id", "adit --at 10.0.0.1:8000 identify"),
                                (f"adit check {SOURCE}/firmware/rules/settings/exam", f"adit check {SOURCE}/firmware/rules/settings/example.json"),
                                ("aditd --setti", "aditd --settings"), ("adit-robots --style ro", "adit-robots --style ros"),
                                ("adit-panel --so", "adit-panel --socket")):
                with self.subTest(shell=shell, line=line):
                    self.assertEqual([each for each in terminal.completed(line) if each], words.split())

    def test_in_bash(self):
        self.completes("bash")

    def test_in_zsh(self):
        self.completes("zsh")


class Scripts(unittest.TestCase):
    def test_are_good_bash(self):
        if not shutil.which("shellcheck"):
            self.skipTest("there is no shellcheck here")
        subprocess.run(["shellcheck", "-s", "bash", *sorted((made() / "bash-completion/completions").iterdir())], check=True)

    def are_read_by(self, shell, pattern):
        if not shutil.which(shell):
            self.skipTest(f"there is no {shell} here")
        scripts = sorted(made().glob(pattern))
        self.assertTrue(scripts)
        for script in scripts:
            subprocess.run([shell, "-n", script], check=True)

    def test_are_read_by_zsh(self):
        self.are_read_by("zsh", "zsh/site-functions/_*")

    def test_are_read_by_fish(self):
        self.are_read_by("fish", "fish/vendor_completions.d/*")
