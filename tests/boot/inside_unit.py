"""What adit.service may do, tried from inside: a copy of the unit, with its whole sandbox, that starts inside_unit.sh and has
folders of its own."""

import base64
import pathlib
import re

SCRIPT = pathlib.Path(__file__).with_suffix(".sh")
ALLOWED = {"write /var/lib/adit-try", "write /run/adit-try", "write /tmp", "read its credentials", "read /dev/urandom",
           "connect to 127.0.0.1"}
# What the unit says, where it has another name; it is no service that is started again, or waited for.
COPY = r"""sed -e 's|^ExecStart=.*|ExecStart=/bin/sh /run/systemd/adit-try.sh\nStandardOutput=file:/run/adit-tried|' -e 's/^Type=.*/Type=oneshot/' \
-e 's/^\(State\|Runtime\)Directory=adit$/\1Directory=adit-try/' \
-e '/^\(ExecStopPost\|Restart\|RestartSec\|WatchdogSec\|OnFailure\|Wants\|FileDescriptorStoreMax\|TimeoutStartSec\)=/d' \
/usr/lib/systemd/system/adit.service >/run/systemd/system/adit-try.service"""
PIECE = 700  # characters: a console takes less than 1024 in a line


def tried(ask):
    """`ask` runs a command in the machine as root and says what it said. What the script is, by its own words ("CapEff: ..."), and
    two dictionaries: what was allowed and what was refused, each with why."""
    script = base64.b64encode(SCRIPT.read_bytes()).decode()
    ask("rm -f /run/adit-try.64")
    for at in range(0, len(script), PIECE):
        ask(f"echo {script[at:at + PIECE]} >>/run/adit-try.64")
    ask("busybox base64 -d /run/adit-try.64 >/run/systemd/adit-try.sh")
    # A new unit needs no daemon-reload, which would keep PID 1 from feeding the hardware watchdog for as long as it takes.
    for line in (COPY.replace("\\\n", ""), "ip address add 203.0.113.1/32 dev lo", "systemctl start adit-try.service",
                 "ip address del 203.0.113.1/32 dev lo"):
        ask(line)
    said = ask("cat /run/adit-tried")
    ask("rm /run/systemd/system/adit-try.service")
    return (re.search(r"^is (.*)$", said, re.M)[1].strip(), dict(found(said, "allowed")), dict(found(said, "refused")))


def found(said, outcome):
    return re.findall(rf"^{outcome} ([^:\n]+)(?:: (.*))?$", said, re.M)


def check(test, ask, but=()):
    """`but`: what this machine has nothing to refuse it with."""
    what_it_is, allowed, refused = tried(ask)
    test.assertEqual(what_it_is, "CapEff: 0000000000000000 CapBnd: 0000000000000000 NoNewPrivs: 1 Seccomp: 2")
    test.assertEqual(set(allowed) - set(but), ALLOWED, refused)
    test.assertIn("stop a unit", refused, "the last that is tried")
    return len(refused)
