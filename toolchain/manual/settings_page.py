"""adit-settings(5), of the table of all keys, as `adit complete keys --json` prints it."""
import json
import subprocess

from manual.page import head, kept, paragraphs, roff, see_also

ABOUT = """The settings of aditd are one JSON file (RFC 8259) of version 1. Only required keys must be given; all others have a
default. An unknown key, a key that is given twice, and a value of the wrong kind are errors. `adit check` lists all errors of a file.

The file contains no tokens. Tokens are files in the directory of `--secrets`: scoring.token, mapping.token and team.token.

Settings that are saved by the page or by `adit settings` are kept in the state directory and used from then on. The installed file
stays as it is.

In the list of keys, `command_post.rates.map_hz` stands for {"command_post": {"rates": {"map_hz": 1}}}, and [] for each item of a
list. The unit of a name that ends in _ms is milliseconds; in _hz, times a second; in _mbit, megabits a second; in _bytes, bytes."""


def allowed(key):
    usual = "Required." if key["required"] else f"Default: {json.dumps(key['default'], ensure_ascii=False)}."
    return f"Allowed: {key['range']}. {usual}"


def settings_page(adit, example, version):
    told = subprocess.run([adit, "complete", "keys", "--json"], check=True, capture_output=True, text=True).stdout
    lines = head("adit-settings", 5, version, "the settings of aditd(8)")
    lines += [".SH DESCRIPTION", *paragraphs(ABOUT.replace("\n\n", "\0").replace("\n", " ").replace("\0", "\n\n"))]
    lines += [".SH KEYS"]
    for key in json.loads(told):
        lines += [".TP", f"\\fB{roff(key['path'])}\\fR", roff(key["meaning"]), ".br", roff(allowed(key))]
    lines += [".SH EXAMPLE", *kept(example.read_text().splitlines())]
    lines += [".SH FILES", ".TP", ".I /etc/adit/settings.json", "the installed settings"]
    lines += [".TP", ".I /var/lib/adit/settings.json", "the saved settings, with all defaults"]
    lines += see_also(["adit(1)", "aditd(8)"])
    return "\n".join(lines) + "\n"
