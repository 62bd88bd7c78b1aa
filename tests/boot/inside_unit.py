"""Tries the privileges of adit.service from inside: a copy of the unit, with its whole sandbox and its own directories, runs
inside_unit.sh."""

import base64
import pathlib
import re

SCRIPT = pathlib.Path(__file__).with_suffix(".sh")
ALLOWED = {"write /var/lib/adit-try", "write /run/adit-try", "write /tmp", "read its credentials", "read /dev/urandom",
           "connect to 127.0.0.1"}
# The unit under another name. It is not restarted, and the script does not wait for it.
COPY = r"""sed -e 's|^ExecStart=.*|ExecStart=/bin/sh /run/systemd/adit-try.sh\nStandardOutput=file:/run/adit-tried|' -e 's/^Type=.*/Type=oneshot/' \
-e 's/^\(State\|Runtime\)Directory=adit$/\1Directory=adit-try/' \
-e '/^\(ExecStopPost\|Restart\|RestartSec\|WatchdogSec\|OnFailure\|Wants\|FileDescriptorStoreMax\|TimeoutStartSec\)=/d' \
/usr/lib/systemd/system/adit.service >/run/systemd/system/adit-try.service"""
PIECE = 700  # characters: a console takes less than 1024 in a line


def tried(ask):
    """`ask` runs a command in the machine as root and returns its output. Returns the script's own properties ("CapEff: ..."), and
    two dictionaries with reasons: allowed and denied attempts."""
    script = base64.b64encode(SCRIPT.read_bytes()).decode()
    ask("rm -f /run/adit-try.64")
    for at in range(0, len(script), PIECE):
        ask(f"echo {script[at:at + PIECE]} >>/run/adit-try.64")
    ask("busybox base64 -d /run/adit-try.64 >/run/systemd/adit-try.sh")
    # A new unit needs no daemon-reload, which would keep PID 1 from feeding the hardware watchdog meanwhile.
    for line in (COPY.replace("\\\n", ""), "ip address add 203.0.113.1/32 dev lo", "systemctl start adit-try.service",
                 "ip address del 203.0.113.1/32 dev lo"):
        ask(line)
    said = ask("cat /run/adit-tried")
    ask("rm /run/systemd/system/adit-try.service")
    return (re.search(r"^is (.*)$", said, re.M)[1].strip(), dict(found(said, "allowed")), dict(found(said, "refused")))


def found(said, outcome):
    return re.findall(rf"^{outcome} ([^:\n]+)(?:: (.*))?$", said, re.M)


def check(test, ask, but=()):
    """`but`: attempts that this machine cannot deny."""
    what_it_is, allowed, refused = tried(ask)
    test.assertEqual(what_it_is, "CapEff: 0000000000000000 CapBnd: 0000000000000000 NoNewPrivs: 1 Seccomp: 2")
    test.assertEqual(set(allowed) - set(but), ALLOWED, refused)
    test.assertIn("stop a unit", refused, "the last that is tried")
    return len(refused)
