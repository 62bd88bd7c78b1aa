"""adit-settings(5), of the table of all keys, as `adit complete keys --json` prints it."""
import json
import subprocess

from manual.page import head, kept, paragraphs, roff, see_also

ABOUT = """What aditd is set to is one JSON file (RFC 8259) of version 1. Only the keys that have to be there have to be there;
everything else has a default. A key that is not known, one that is given twice and a value of the wrong kind are errors, never
ignored. `adit check` names them all.

Tokens are never in it: they are files of their own in the folder of `--secrets`, scoring.token, mapping.token and team.token.

What is saved by the page or by `adit settings apply` is kept in the state folder and counts from then on; the file that came
with the box is left as it is.

In the list of keys, `command_post.rates.map_hz` stands for {"command_post": {"rates": {"map_hz": 1}}}, and [] for each item of a
list. A name that ends in _ms is in milliseconds, _hz in times a second, _mbit in megabits a second, _bytes in bytes."""


def allowed(key):
    usual = "It has to be there." if key["required"] else f"If not given: {json.dumps(key['default'], ensure_ascii=False)}."
    return f"It may be {key['range']}. {usual}"


def settings_page(adit, example, version):
    told = subprocess.run([adit, "complete", "keys", "--json"], check=True, capture_output=True, text=True).stdout
    lines = head("adit-settings", 5, version, "the settings of aditd(8)")
    lines += [".SH DESCRIPTION", *paragraphs(ABOUT.replace("\n\n", "\0").replace("\n", " ").replace("\0", "\n\n"))]
    lines += [".SH KEYS"]
    for key in json.loads(told):
        lines += [".TP", f"\\fB{roff(key['path'])}\\fR", roff(key["meaning"]), ".br", roff(allowed(key))]
    lines += [".SH EXAMPLE", *kept(example.read_text().splitlines())]
    lines += [".SH FILES", ".TP", ".I /etc/adit/settings.json", "what came with the box"]
    lines += [".TP", ".I /var/lib/adit/settings.json", "what was saved since; whole, with all that is by default"]
    lines += see_also(["adit(1)", "aditd(8)"])
    return "\n".join(lines) + "\n"
