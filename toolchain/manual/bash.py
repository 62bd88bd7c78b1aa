"""bash's completion of a program."""

FLAT = """# bash's completion of {name}, from its table of options.
{function}() {{
  local current=$2 previous=$3
  [[ $previous == "=" ]] && previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  case $previous in
{values}
  esac
  mapfile -t COMPREPLY < <(compgen -W "{words}" -- "$current")
}}
complete -F {function} {name}
"""

# The earlier words are read from the line, because readline cuts words at colons and at `=`.
NESTED = """# bash's completion of {name}, from its table of commands and options.
{function}_lists() {{ # WORD...: what `{name} complete` lists, of the {name} that the line asks
  local each before=""
  local -a asked=()
  for each in "${{said[@]}}"; do
    [[ $before == --at || $before == --settings || $before == --token-file ]] && asked+=("$before" "$each")
    [[ $each == --at=* || $each == --settings=* || $each == --token-file=* ]] && asked+=("$each")
    before=$each
  done
  command {name} complete "$@" "${{asked[@]}}" 2>/dev/null | cut -f 1
}}

{function}() {{
  local current=$2 previous=$3 command="" word="" key="" each before="" words=""
  local -a said=()
  read -ra said <<<"${{COMP_LINE:0:COMP_POINT}}"
  [[ ${{COMP_LINE:0:COMP_POINT}} == *[[:blank:]] ]] || unset "said[-1]"
  [[ $previous == "=" ]] && previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  for each in "${{said[@]:1}}"; do
    if [[ $each != -* && ! $before =~ ^({valued})$ ]]; then
      if [[ -z $command ]]; then command=$each; elif [[ -z $word ]]; then word=$each; else key=$each; fi
    fi
    before=$each
  done
  case $previous in
{values}
  esac
  case "$command $word" in
{places}
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -F {function} {name}
"""

FILE = 'compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$current")'
FOLDER = 'compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$current")'


def value_of(row):
    if row.is_file or row.is_folder:
        return f"{row.word}) {FILE if row.is_file else FOLDER}; return ;;"
    if row.choices:
        return f"""{row.word}) mapfile -t COMPREPLY < <(compgen -W "{' '.join(row.choices)}" -- "$current"); return ;;"""
    return f"{row.word}) return ;;"


def values(options):
    unique = {row.word: row for row in options if row.value}
    return "\n".join("    " + value_of(row) for row in unique.values())


def place(program, command, word, options):
    """The words that may follow a command and its word."""
    listed = " ".join(row.word for row in options)
    lists = program.lists_at(command, word)
    if lists:
        quoted = " ".join(f'"{each}"' for each in lists.split()) + (' ${key:+"$key"}' if program.lists_values_at(command, word) else "")
        return f'words="{listed}"; [[ $current == -* ]] || words=$(_{program.name}_lists {quoted})'
    if program.wants_file(command, word):
        return f'words="{listed}"; [[ $current == -* ]] || {{ {FILE}; return; }}'
    return f'words="{listed}"'


def places(program):
    lines = []
    for command, about in program.commands.items():
        for row in about.words:
            lines.append(f'"{command} {row.word}") {place(program, command, row.word, about.options_at(row.word))} ;;')
        if about.words:
            words = [*about.words, *about.options_at("")] if usual(about) else about.words
            lines.append(f"""\"{command} ") words="{' '.join(row.word for row in words)}" ;;""")
        else:
            lines.append(f'"{command} "*) {place(program, command, "", about.options)} ;;')
    lines.append(f"""\"help "*) words="{' '.join(program.commands)}" ;;""")
    lines.append(f"""\" ") words="{' '.join(row.word for row in program.help.rows)}" ;;""")
    return "\n".join("    " + line for line in lines)


def usual(about):
    """Whether a command means something without one of its words."""
    return " [" in about.usage.removesuffix(" [OPTION]...")


def completion(program):
    function = "_" + program.name.replace("-", "_")
    if not program.commands:
        words = " ".join(row.word for row in program.help.rows)
        return FLAT.format(name=program.name, function=function, words=words, values=values(program.help.options))
    options = [row for about in [program.help, *program.commands.values()] for row in about.options]
    valued = "|".join(dict.fromkeys(row.word for row in options if row.value))
    return NESTED.format(name=program.name, function=function, valued=valued, values=values(options), places=places(program))
