"""Recognises light patterns, named as in firmware/doors/panel/README.md, from the levels of the GPIO lines."""

import math

# Flashes per second. Patterns with the same rate differ in their share of lit time.
RATES = {"flash": 0.5, "wink": 0.5, "slow": 1, "twice": 2, "fast": 4, "rush": 10}
LONGEST = 4.2  # seconds of looking: two of the slowest pattern


def pattern(samples):
    """`samples` of one light: (seconds, lit). Rates are counted from the first flash to the last."""
    lit = [is_lit for _, is_lit in samples]
    rises = [after[0] for before, after in zip(samples, samples[1:]) if after[1] and not before[1]]
    if len(set(lit)) == 1:
        return "on" if lit[0] else "off"
    rate = len(rises) / (samples[-1][0] - samples[0][0])
    share = sum(lit) / len(lit)
    near = [name for name in RATES if abs(math.log2(max(rate, 0.01) / RATES[name])) < 0.5]
    if len(near) == 2:
        return "wink" if share > 0.5 else "flash"
    return near[0] if near else f"{rate:.1f} flashes a second"


def patterns(seen):
    """The patterns of all lights from Machine.watch_lights(): {"health": "on", ...}."""
    return {name: pattern([(at, lights[name]) for at, lights in seen]) for name in seen[0][1]}


def wait_for(machine, within=120.0, **wanted):
    """Waits until the lights show these patterns: wait_for(machine, health="on", scoring="fast")."""
    shown = {}

    def as_wanted():
        shown.update(patterns(machine.watch_lights(LONGEST)))
        return all(shown[name] == each for name, each in wanted.items())

    try:
        machine.wait_until(as_wanted, f"the lights to show {wanted}", within)
    except AssertionError as error:
        raise AssertionError(f"the lights show {shown}: {error}") from None
