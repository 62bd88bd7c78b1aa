"""fish's completion of a program."""

LISTS = """function __{name}_lists # WORD...: what `{name} complete` lists, of the {name} that the line asks
    set -l said (commandline -opc)
    set -l asked
    for at in (seq 2 (count $said))
        if contains -- $said[(math $at - 1)] --at --settings --token-file
            set -a asked $said[(math $at - 1)] $said[$at]
        else if string match -qr -- '^--(at|settings|token-file)=' $said[$at]
            set -a asked $said[$at]
        end
    end
    command {name} complete $argv $asked 2>/dev/null
end

function __{name}_said # the words that were said so far, one a line, without options and their values
    set -l before ""
    for each in (commandline -opc)[2..]
        if not string match -qr -- '^-' $each; and not contains -- $before {valued}
            echo $each
        end
        set before $each
    end
end

function __{name}_at # COMMAND [WORD]: whether they are what was said so far; "": no word
    set -l words (__{name}_said)
    test (count $words) -ge (count $argv); or return 1
    for at in (seq (count $argv))
        test "$words[$at]" = "$argv[$at]"; or return 1
    end
end

function __{name}_no_word # [COMMAND]: whether nothing else was said so far
    set -l words (__{name}_said)
    test "$words" = "$argv"
end
"""


def quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def option(name, row, when=""):
    condition = f" -n {quoted(when)}" if when else ""
    value = ""
    if row.value:
        value = " -r -F" if row.is_file else " -x -a '(__fish_complete_directories)'" if row.is_folder else " -x"
        value = f" -x -a '{' '.join(row.choices)}'" if row.choices else value
    return f"complete -c {name}{condition} -l {row.word.removeprefix('--')}{value} -d {quoted(row.short)}"


def word(name, row, when=""):
    condition = f" -n {quoted(when)}" if when else ""
    return f"complete -c {name}{condition} -f -a {row.word} -d {quoted(row.short)}"


def arguments(program, command, each):
    when = f"__{program.name}_at {command} {each}".rstrip()
    lists = program.lists_at(command, each)
    if program.lists_values_at(command, each):
        lists += f" (__{program.name}_said)[3]"
    if lists:
        return [f"complete -c {program.name} -n {quoted(when)} -f -a '(__{program.name}_lists {lists})'"]
    return [f"complete -c {program.name} -n {quoted(when)} -F"] if program.wants_file(command, each) else []


def of_command(program, command, about):
    name = program.name
    lines = []
    for row in about.words:
        lines.append(word(name, row, f"__{name}_no_word {command}"))
        lines += arguments(program, command, row.word)
        lines += [option(name, each, f"__{name}_at {command} {row.word}") for each in about.options_at(row.word)]
    if not about.words:
        lines += arguments(program, command, "")
        lines += [option(name, each, f"__{name}_at {command}") for each in about.options]
    else:
        lines += [option(name, each, f"__{name}_no_word {command}") for each in about.options_at("")]
    return lines


def completion(program):
    name = program.name
    lines = [f"# fish's completion of {name}, from its tables of words and options.", f"complete -c {name} -f"]
    if not program.commands:
        lines += [option(name, row) for row in program.help.options] + [word(name, row) for row in program.help.words]
        return "\n".join(lines) + "\n"
    rows = [row for about in [program.help, *program.commands.values()] for row in about.options]
    lines.append(LISTS.format(name=name, valued=" ".join(dict.fromkeys(row.word for row in rows if row.value))))
    lines += [word(name, row, f"__{name}_no_word") for row in program.help.words]
    lines += [option(name, row, f"__{name}_no_word") for row in program.help.options]
    for command, about in program.commands.items():
        lines += of_command(program, command, about)
    lines.append(f"complete -c {name} -n '__{name}_no_word help' -f -a '{' '.join(program.commands)}'")
    return "\n".join(lines) + "\n"
