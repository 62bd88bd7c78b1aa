"""A man page of a program (man(7)), of what its --help says."""
import os
import re
import time

FOR_EVERYBODY = {"adit", "adit-rehearsal", "adit-robots"}  # the others are of section 8: a service starts them
SEE_ALSO = {
    "adit": ["aditd(8)", "adit-settings(5)"],
    "aditd": ["adit(1)", "adit-settings(5)", "adit-panel(8)", "adit-network(8)", "adit-update(8)", "adit-clock(8)", "adit-spare(8)", "adit-certificate(8)", "adit-import(8)"],
    "adit-rehearsal": ["adit-robots(1)", "aditd(8)"],
    "adit-robots": ["adit-rehearsal(1)", "aditd(8)"],
}


def section_of(name):
    return 1 if name in FOR_EVERYBODY else 8


def roff(text):
    """As it is; what stands in backticks is bold."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("^", "\\(ha").replace("~", "\\(ti")
    text = re.sub(r"`([^`\n]+)`", r"\\fB\1\\fR", text)
    return re.sub(r"^\.", r"\\&.", text, flags=re.M)


def kept(lines):
    return [".RS", ".nf", *(roff(line.removeprefix("  ")) or "\\&" for line in lines), ".fi", ".RE"]


def paragraphs(text):
    """Lines that begin with a blank stay as they are."""
    lines, as_is, begins = [], [], False
    for line in text.splitlines() + [""]:
        if line.startswith(" "):
            as_is.append(line)
            continue
        if as_is:
            lines += kept(as_is)
            as_is = []
        if line:
            lines += [".PP", roff(line)] if begins else [roff(line)]
            begins = False
        else:
            begins = True
    return lines


def sections(text):
    """`Exit status:`, `Environment:` and the like, each with the lines under it; "": the rest."""
    found, name = {"": []}, ""
    for line in text.splitlines():
        if re.fullmatch(r"[A-Z][a-z ]+:", line):
            name = line[:-1]
            found[name] = []
        elif name and line and not line.startswith(" "):
            name = ""
            found[name].append(line)
        else:
            found[name].append(line)
    return {title: "\n".join(lines).strip("\n") for title, lines in found.items()}


def rows(all_rows):
    lines = []
    for row in all_rows:
        value = f" \\fI{roff(row.value)}\\fR" if row.value else ""
        takers = ""
        if row.takers is not None:
            takers = "Without a subcommand: " if row.takers == {""} else "With " + ", ".join(sorted(row.takers)) + ": "
        lines += [".TP", f"\\fB{roff(row.word)}\\fR{value}", roff(takers + row.sentence)]
    return lines


def synopsis(usage):
    name, _, rest = usage.partition(" ")
    return f"\\fB{roff(name)}\\fR {roff(rest)}"


def date():
    """Of $SOURCE_DATE_EPOCH, so that a package is the same each time it is made; without it a page has none."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    return time.strftime("%Y-%m-%d", time.gmtime(int(epoch))) if epoch else ""


def head(name, section, version, sentence):
    return [f'.TH {name.upper()} {section} "{date()}" "Adit {version}" "Adit"', ".SH NAME", roff(f"{name} - {sentence}")]


def see_also(others):
    return [".SH SEE ALSO", ",\n".join(f".BR {roff(each.split('(')[0])} ({each.split('(')[1]}" for each in others).replace("),\n", ") ,\n")]


def command(about, common):
    """One of a program's commands, without the options that all of them take."""
    texts = sections(about.notes)
    lines = [f".SS {roff(about.usage)}", *paragraphs(about.about.split(" - ", 1)[1])]
    lines += rows([row for row in about.rows if row.word not in common])
    for title in ("Exit status", "Examples"):
        if texts.get(title):
            lines += [".PP", title + ":", *kept(texts[title].splitlines())]
    return lines


def page(program):
    about = program.help
    common = {row.word for row in about.options}
    texts = sections(about.notes)
    lines = head(program.name, section_of(program.name), program.version, program.sentence)
    lines += [".SH SYNOPSIS", synopsis(about.usage)]
    lines += [".SH DESCRIPTION", *paragraphs(re.sub(rf"^{program.name} - (.)", lambda first: first[1].upper(), about.about))]
    lines += [".SH OPTIONS", *rows(about.options if program.commands else about.rows)]
    if program.commands:
        lines += [".SH COMMANDS"]
        for each in program.commands.values():
            lines += command(each, common)
        lines += [".SS " + roff(f"{program.name} help [COMMAND]"), "explain a command"]
    for title in ("Exit status", "Environment", "Files", "Bugs"):
        if texts.get(title):
            lines += [f".SH {title.upper()}", *kept(texts[title].splitlines())]
    if texts[""]:
        lines += [".SH NOTES", *paragraphs(texts[""])]
    lines += see_also(SEE_ALSO.get(program.name, ["aditd(8)"]))
    return "\n".join(lines) + "\n"
