"""zsh's completion of a program."""

FLAT = """#compdef {name}
# zsh's completion of {name}, from its table of options.
_arguments \\
{specs}
"""

NESTED = """#compdef {name}
# zsh's completion of {name}, from its table of commands and options.
_{name}_lists() {{ # WORD...: what `{name} complete` lists, of the {name} that the line asks
  local -a said asked found
  local each before="" line tab=$'\\t'
  said=(${{(z)BUFFER}})
  for each in $said; do
    [[ $before == (--at|--settings|--token-file) ]] && asked+=($before $each)
    [[ $each == (--at|--settings|--token-file)=* ]] && asked+=($each)
    before=$each
  done
  for line in "${{(@f)$(command {name} complete "$@" ${{(Q)asked}} 2>/dev/null)}}"; do
    [[ -n $line ]] && found+=("${{line%%$tab*}}:${{line#*$tab}}")
  done
  _describe -t words word found
}}

_{name}() {{
  local curcontext=$curcontext state line
  typeset -A opt_args
  _arguments -C \\
{specs} \\
    '1:command:(({commands}))' '*:: :->behind'
  [[ $state == behind ]] || return
  case $words[1] in
{cases}
  esac
}}

_{name} "$@"
"""

CASE = """    {command})
      _arguments -C \\
{specs} \\
        '1:word:(({words}))' '*:: :->behind'
      [[ $state == behind ]] || return
      case $words[1] in
{cases}
      esac
      ;;"""


def escaped(text, marks):
    for mark in "\\" + marks:
        text = text.replace(mark, "\\" + mark)
    return text.replace("'", "'\\''")


def action(row):
    if row.choices:
        return "(" + " ".join(row.choices) + ")"
    return "_files" if row.is_file else "_files -/" if row.is_folder else " "


def spec(row):
    """An option of _arguments, which may come once more only where it has a value."""
    told = f"[{escaped(row.short, '[]')}]"
    if not row.value:
        return f"'{row.word}{told}'"
    return f"'*{row.word}{told}:{escaped(row.value, ':')}:{action(row)}'"


def described(rows):
    """As _arguments evaluates it, once more."""
    return " ".join(f"""{escaped(row.word, ':')}\\:"{escaped(row.short, '"`$')}\"""" for row in rows)


def specs(rows, indent):
    return continued([spec(row) for row in rows], indent)


def continued(words, indent):
    """On lines of their own, as one command goes on."""
    return " \\\n".join(" " * indent + word for word in words if word)


def argument(program, command, word):
    lists = program.lists_at(command, word)
    if program.lists_values_at(command, word):
        return f"""'1:word: _{program.name}_lists {lists}' '2:value: _{program.name}_lists {lists} $words[2]'"""
    if lists:
        return f"""'*:word: _{program.name}_lists {lists}'"""
    return "'*:file:_files'" if program.wants_file(command, word) else ""


def arguments(program, command, word, options, indent):
    """A branch for a word, with its options and the words that may follow it."""
    taken = [*map(spec, options), argument(program, command, word)]
    return "\n".join([f"{' ' * indent}{word or command})", f"{' ' * (indent + 2)}_arguments \\", continued(taken, indent + 4),
                      f"{' ' * (indent + 2)};;"])


def case(program, command, about):
    if not about.words:
        return arguments(program, command, "", about.options, 4)
    cases = [arguments(program, command, row.word, about.options_at(row.word), 8) for row in about.words]
    return CASE.format(command=command, specs=specs(about.options_at(""), 8), words=described(about.words), cases="\n".join(cases))


def completion(program):
    if not program.commands:
        rows = program.help.options
        words = program.help.words
        last = f"'*:word:(({described(words)}))'" if words else ""
        return FLAT.format(name=program.name, specs=continued([*map(spec, rows), last], 2))
    cases = [case(program, command, about) for command, about in program.commands.items()]
    cases.append(f"    help)\n      _arguments '*:command:({' '.join(program.commands)})'\n      ;;")
    return NESTED.format(name=program.name, specs=specs(program.help.options, 4), commands=described(program.help.words), cases="\n".join(cases))
