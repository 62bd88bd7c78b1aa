"""Timeouts of tests. On a slow machine toolchain/ctest sets ADIT_PATIENCE, which multiplies all timeouts."""

import math
import os
import sys
import time


def factor_of(text):
    try:
        factor = float(text)
    except ValueError:
        factor = 0
    if not 1 <= factor < math.inf:
        sys.exit(f"ADIT_PATIENCE: expected a number of at least 1, not '{text}'")
    return factor


FACTOR = factor_of(os.environ.get("ADIT_PATIENCE", "1"))


def patient(time_out):
    """`time_out`, in any unit, times ADIT_PATIENCE."""
    return time_out * FACTOR


def wait_until(condition, what, within=60.0, tolerates=(), every=0.01):
    """The first true value of `condition()`. Polls each `every` seconds at first, later less often, up to ten times that interval,
    because polling uses the same processors. After `within` seconds times ADIT_PATIENCE: an AssertionError with `what`, a text or a function
    that returns one then, and the last value, or the last exception of the types in `tolerates`."""
    began = time.monotonic()
    while True:
        try:
            if seen := condition():
                return seen
        except tolerates as error:
            seen = error
        waited = time.monotonic() - began
        if waited >= patient(within):
            what = what() if callable(what) else what
            raise AssertionError(f"waited {patient(within):g} s in vain for {what}; seen last: {seen!r:.1000}")
        time.sleep(min(max(every, waited / 10), 10 * every))
