"""What a program's --help says of its words and options, which comes from the tables that it is read by."""
import re
import subprocess

ROW = re.compile(r"  (\S+(?: \S+)*)  +(.*)")
TAKERS = re.compile(r"(without a subcommand|with ([a-z, ]+)): (.*)")
CHOICES = re.compile(r"((?:[a-z][a-z0-9-]*(?:, | or ))+[a-z][a-z0-9-]*)[:;]")
FILES, FOLDERS = {"FILE", "CSV", "SETTINGS"}, {"DIR"}


class Row:
    """A word or an option: its value's name ("" where it stands alone), and what it is for."""

    def __init__(self, head, sentence):
        self.word, _, self.value = head.partition(" ")
        self.sentence = sentence
        takers = TAKERS.match(sentence)
        self.takers = None  # which of a command's words take it ("": none of them); None: each
        if takers:
            self.takers = set(takers[2].split(", ")) if takers[2] else {""}
            self.sentence = takers[3]

    @property
    def is_option(self):
        return self.word.startswith("--")

    @property
    def short(self):
        """What a shell shows beside it."""
        return re.split(r"[;:.(]", self.sentence, maxsplit=1)[0].strip()

    @property
    def choices(self):
        """What the value may be, where the sentence begins with that, or the value's name is no name."""
        if "|" in self.value:
            return [each for each in self.value.split("|") if each.islower()]
        listed = CHOICES.match(re.sub(r" \([^)]*\)", "", self.sentence))
        return re.split(r", | or ", listed[1]) if self.value and listed else []

    @property
    def is_file(self):
        return self.value in FILES

    @property
    def is_folder(self):
        return self.value in FOLDERS


class Help:
    """What PROGRAM [COMMAND] --help prints: its usage, what it does, its rows, and what else is to be known."""

    def __init__(self, *command):
        text = subprocess.run([*command, "--help"], check=True, capture_output=True, text=True).stdout
        blocks = text.rstrip("\n").split("\n\n")
        at = next(i for i, block in enumerate(blocks) if "\n  --help " in block)
        self.usage = blocks[0].removeprefix("Usage: ")
        self.about, self.notes = "\n\n".join(blocks[1:at]), "\n\n".join(blocks[at + 1:])
        heads = []
        for line in blocks[at].splitlines():
            row = ROW.match(line)
            if row and line[2] != " ":
                heads.append(list(row.groups()))
            else:
                heads[-1][1] += " " + line.strip()
        self.rows = [Row(*each) for each in heads]

    @property
    def options(self):
        return [row for row in self.rows if row.is_option]

    @property
    def words(self):
        return [row for row in self.rows if not row.is_option]

    @property
    def argument(self):
        """What stands behind a command that has no words: "FILE"; "" where nothing does."""
        found = re.search(r" \[?([A-Z]+)(?:\.\.\.)?\]? \[OPTION\]\.\.\.$", self.usage)
        return found[1] if found else ""

    def options_at(self, word):
        """Those that one of its words takes."""
        return [row for row in self.options if row.takers is None or word in row.takers]


class Program:
    """A program, and each of its commands."""

    def __init__(self, path):
        self.name = path.name
        self.help = Help(path)
        self.version = subprocess.run([path, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
        has_commands = "COMMAND" in self.help.usage
        self.commands = {row.word: Help(path, row.word) for row in self.help.words if has_commands and row.word != "help"}

    @property
    def sentence(self):
        return self.help.about.replace("\n", " ").split(". ")[0].removeprefix(self.name + " - ").rstrip(".")

    def lists_at(self, command, word):
        """The argument of `adit complete` that lists the words after a command and its word: "reports send"; "": none."""
        if self.name != "adit":
            return ""
        behind = {row.word: row.value for row in self.commands[command].words}.get(word, self.commands[command].argument)
        return {
            ("reports", "NUMBER"): f"reports {word}", ("reports", "NUMBER..."): f"reports {word}", ("rejected", "NUMBER..."): "rejected",
            ("course", "NAME"): "courses", ("runs", "KEY"): "runs", ("settings", "[KEY]"): "keys",
            ("settings", "KEY VALUE"): "keys", ("alarms", "ID"): "alarms", ("tokens", "NAME"): "tokens",
            ("tokens", "NAME [FILE]"): "tokens", ("context", "NAME"): "contexts",
        }.get((command, behind), "")

    def lists_values_at(self, command, word):
        """Whether the values of a key may stand behind it."""
        return self.name == "adit" and (command, word) == ("settings", "set")

    def wants_file(self, command, word):
        if word:
            return {row.word: row.value for row in self.commands[command].words}[word].strip("[].") in FILES
        return self.commands[command].argument in FILES
