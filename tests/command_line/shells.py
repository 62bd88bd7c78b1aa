"""The shells' own completion of the beginning of a command line."""

import contextlib
import os
import pty
import re
import select
import signal
import subprocess
import tempfile
import time

from manuals import BIN, made

PROMPT = "READY> "
IN_BASH = r"""
source "$1"
COMP_LINE=$2 COMP_POINT=${#2}
read -ra COMP_WORDS <<<"${COMP_LINE//[=:]/ & }"  # as readline cuts it
[[ $COMP_LINE == *" " ]] && COMP_WORDS+=("")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
compopt() { :; }  # which wants to be called by readline
"$3" "${COMP_WORDS[0]}" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}"
"""


def environment(home):
    return {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "HOME": str(home), "TERM": "xterm", "LC_ALL": "C.UTF-8"}


def by_bash(line):
    """The offers of the function that completes `line`."""
    name = line.split()[0]
    script = made() / "bash-completion/completions" / name
    told = subprocess.run(["bash", "--norc", "-c", IN_BASH, "bash", script, line, "_" + name.replace("-", "_")],
                          check=True, capture_output=True, text=True, env=environment("/"))
    return [each for each in told.stdout.splitlines() if each]


def by_fish(line):
    script = made() / "fish/vendor_completions.d" / (line.split()[0] + ".fish")
    with tempfile.TemporaryDirectory() as home:
        told = subprocess.run(["fish", "--no-config", "-c", "source $argv[1]; complete -C $argv[2]", script, line],
                              check=True, capture_output=True, text=True, env=environment(home))
    return [each.partition("\t")[0] for each in told.stdout.splitlines()]


class Terminal:
    """A shell at a terminal with typed input. The program that it runs appends its arguments to the file `called`."""

    def __init__(self, shell, folder):
        name = made() / "bash-completion/completions"
        self.called = folder / "called"
        self.called.touch()
        starts = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"]}
        first = {"bash": f"for each in {name}/*; do source $each; done; PS1='READ''Y> '",
                 "zsh": f"fpath=({made()}/zsh/site-functions $fpath); autoload -U compinit; compinit -u -D; PS1='READ''Y> '"}
        self.child, self.fd = pty.fork()
        if self.child == 0:
            os.execvpe(starts[shell][0], starts[shell], environment(folder))
        self.seen = ""
        self.type(first[shell] + "\n")
        self.type("called() { printf '%s|' \"$@\" >>" + str(self.called) + "; echo >>" + str(self.called) + "; }\n")

    def type(self, text):
        """Types a line, and waits for the next prompt."""
        prompts = self.seen.count(PROMPT)
        os.write(self.fd, text.encode())
        end = time.monotonic() + 60
        while self.seen.count(PROMPT) == prompts:
            if not select.select([self.fd], [], [], max(0, end - time.monotonic()))[0]:
                raise AssertionError(f"no prompt after {text!r}: {self.seen[-2000:]}")
            self.seen += os.read(self.fd, 65536).decode(errors="replace")

    def completed(self, line):
        """The result of a Tab at the end of the line, as the program's arguments."""
        name = line.split()[0]
        calls = len(self.called.read_text().splitlines())
        self.type(f"{name}() {{ called {name} \"$@\"; }}\n")
        self.type(f"{line}\t\n")
        self.type(f"unset -f {name}\n")
        said = self.called.read_text().splitlines()
        if len(said) != calls + 1:
            raise AssertionError(f"{line!r} was not run: {re.escape(self.seen[-2000:])}")
        return said[-1].removesuffix("|").split("|")

    def close(self):
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.child, signal.SIGKILL)
        os.waitpid(self.child, 0)
        os.close(self.fd)
