"""Verdict, robots, alarms, `adit status` and metrics agree in each state of the robots and of the Command Post, with and without a merged
map. Prints the results as the table below."""

import concurrent.futures
import multiprocessing
import os
import re
import signal
import subprocess
import threading
import time
import unittest

import requests

import maps
import messages
import programs
from messages import Style
from programs import Stage, wait_until

CBOR = Style("cbor")
ROBOTS = ("r1", "r2", "r3")
MERGED = ""
AGE = r"\d+ (?:s|min)"
CLOCK = r"\d+:\d\d"
SHORT = {"well": "good up to date/arriving", "kept": "quiet not arriving"}
# A robot's cell is its standing, the merged map's its row; below is the verdict. AGE is an age in words, [] encloses words that come and
# go, / separates words that take turns.
TABLE = """
state               | merged | r1              | r2         | r3         | merged map   | alarms                  | exit
nothing posted      | no     |                 |            |            |              |                         | 0
    quiet No map yet: no robot has sent one since the box started
nothing posted      | yes    |                 |            |            | well         |                         | 0
    good The merged map arrives: up to date
all fresh           | no     | well            | well       | well       |              |                         | 0
    good Every map arrives: 3 robots, up to date
all fresh           | yes    | well            | well       | well       | well         |                         | 0
    good Every map arrives: 3 robots and the merged map, up to date
one late            | no     | wait AGE behind | well       | well       |              | wait map_behind:r1      | 0
    wait Maps are late: r1, AGE behind
one late            | yes    | wait AGE behind | well       | well       | wait waiting | wait map_behind:r1      | 0
    wait Maps are late: r1, AGE behind; no map yet from the merged map
one silent          | no     | bad silent      | well       | well       |              | bad robot_silent:r1     | 1
    wait 2 of 3 arrive: r1 silent[; oldest other AGE]
one silent          | yes    | bad silent      | well       | well       | well         | bad robot_silent:r1     | 1
    wait 2 of 3 arrive: r1 silent[; oldest other AGE]
all silent          | no     | bad silent      | bad silent | bad silent |              | bad robots_silent       | 1
    bad No map arrives: r1, r2, r3 silent
all silent          | yes    | bad silent      | bad silent | bad silent | well         | bad robots_silent       | 1
    wait Only the merged map arrives: r1, r2, r3 silent[; the other AGE]
quiet maps          | no     | well            | well       | well       |              |                         | 0
    quiet Every map arrived: no new map for AGE
quiet maps          | yes    | well            | well       | well       | well         |                         | 0
    good Every map arrives: the merged map, up to date; r1, r2, r3 quiet
one without a map   | no     | well            | well       | well       |              |                         | 0
    good 2 of 3 arrive: up to date; no map from r3
one without a map   | yes    | well            | well       | well       | well         |                         | 0
    good 2 of 3 arrive: up to date; no map from r3
after a restart     | no     | well            | well       | well       |              |                         | 0
    good Every map arrives: 3 robots, oldest AGE
after a restart     | yes    | well            | well       | well       | well         |                         | 0
    good Every map arrives: 3 robots and the merged map, oldest AGE
Command Post silent | no     | kept            | kept       | kept       |              | bad command_post_silent | 1
    bad No map arrives: for CLOCK; the box keeps all maps
Command Post silent | yes    | kept            | kept       | kept       | kept         | bad command_post_silent | 1
    bad No map arrives: for CLOCK; the box keeps all maps
"""
HEAD, *LINES = TABLE.strip("\n").split("\n")


class Team(threading.Thread):
    """Posts a pose of each robot in `poses` and a small grid of each in `maps` every second."""

    def __init__(self, stage, poses=(), grids=()):
        super().__init__(daemon=True)
        self.stage, self.poses, self.maps, self.session, self.over = stage, set(poses), set(grids), requests.Session(), threading.Event()
        self.start()

    def run(self):
        tick = 0
        while not self.over.wait(1):
            tick += 1
            poses = [{"name": name, "position": {"x": float(tick), "y": 0.0, "z": 0.0}, "orientation": maps.IDENTITY} for name in sorted(self.poses)]
            try:
                for pose in poses:
                    messages.post(self.session, self.stage.box.url, "/state/update", {"poses": [pose]}, CBOR)
                for name in sorted(self.maps):
                    self.post_grid(name, 20, 20, bytes([tick % 101]) * 400)
            except requests.ConnectionError:  # the box restarts
                continue

    def post_grid(self, name, width, height, cells):
        grid = maps.Grid("made", width, height, 0.1, (0.0, 0.0, 0.0), cells)
        messages.post(self.session, self.stage.box.url, "/map/update", messages.map_update(grid, name or None, time.time(), CBOR), CBOR)


def verdict_text(view):
    verdict = view["verdict"]
    return f'{verdict["level"]} {verdict["what"]}: {verdict["why"]}'


class Observed:
    """One state of the box, read from all its faces between two equal readings of /adit/run."""

    def __init__(self, stage):
        self.view = stage.box.ask("GET /adit/run")[1]
        self.text, self.exit = self._status(stage)
        self.metrics = requests.get(stage.box.url + "/metrics", timeout=30, headers={"Authorization": f"Bearer {programs.TEAM_TOKEN}"}).text
        self.later = stage.box.ask("GET /adit/run")[1]
        self.is_stable = self._what_lasts(self.view) == self._what_lasts(self.later)

    @staticmethod
    def _status(stage):
        done = subprocess.run([programs.BIN / "adit", "status", "--at", f"{stage.network.box_address}:{programs.PORT}", "--token-file",
                               stage.folder / "secrets/team.token"], capture_output=True, text=True, check=False)
        return done.stdout, done.returncode

    @staticmethod
    def _what_lasts(view):
        return (view["alarms"], [[row[name] for name in ("kind", "robot", "behind_since", "last_accepted", "arrival")] for row in view["activities"]],
                re.sub(r"\d+", "", view["verdict"]["what"] + view["verdict"]["why"]))

    def maps(self):
        return [row for row in self.view["activities"] if row["kind"] in ("grid", "cloud")]

    def cells(self):
        """As in TABLE, and the verdict."""
        standings = {row["name"]: row for row in self.view["standings"]}
        robots = [f'{row["level"]} {row["word"]}' if (row := standings.get(name)) else "" for name in ROBOTS]
        merged = [f'{row["level"]} {row["word"]}' for row in self.maps() if row["robot"] == MERGED]
        alarms = ", ".join(f'{alarm["severity"]} {alarm["id"]}' for alarm in self.view["alarms"])
        return [*robots, *(merged or [""]), alarms, str(self.exit), verdict_text(self.view)]

    def check(self, case):
        """The faces tell the same words, and ages that differ by less than SLACK."""
        view = self.view
        check_headline(case, view, self.maps())
        check_standings(case, view)
        check_command_line(case, view, self.text, self.exit)
        check_metrics(case, view, self.metrics)


SLACK = programs.patient(2)  # seconds
SEVERITIES = {"bad": "x", "ask": "?", "wait": "!"}
LEVELS = ("quiet", "good", "wait", "bad")


def seconds_in(text):
    """The least and the most seconds that an age in words means: "9 s", "1 min"."""
    number, unit = text.split()
    size = {"s": 1, "min": 60, "h": 3600}[unit]
    return (float(number) - 0.5) * size, (float(number) + 1) * size


def same_age(case, text, age, what):
    least, most = seconds_in(text)
    case.assertTrue(age is not None and least - SLACK <= age <= most + SLACK, f"{what}: {text} and {age}")


def oldest(rows):
    return max((row["age"] or 0 for row in rows), default=0)


def check_headline(case, view, rows):
    """The age in the headline is that of the rows that it counts. No row is worse than the headline."""
    what, why, level = view["verdict"]["what"], view["verdict"]["why"], view["verdict"]["level"]
    arriving, late = ([row for row in rows if row["level"] == each] for each in ("good", "wait"))
    for words, counted in ((rf"(?:oldest|the merged map,|1 robot,) ({AGE})", arriving), (rf"({AGE}) behind", late),
                           (rf"(?:oldest other|the other) ({AGE})", arriving + late)):
        if found := re.search(words, why):
            same_age(case, found[1], oldest(counted), why)
    if "up to date" in why:
        case.assertLess(oldest(arriving), 1 + SLACK, why)
    if found := re.search(rf"no new map for ({AGE})", why):
        same_age(case, found[1], min(row["heard"] for row in rows), why)
    if found := re.search(rf"for ({CLOCK});", why):
        since = next(alarm["since"] for alarm in view["alarms"] if alarm["id"].startswith("command_post_silent"))
        minutes, seconds = found[1].split(":")
        case.assertAlmostEqual(60 * int(minutes) + int(seconds), view["now"] - since, delta=SLACK)
    if level == "good":
        case.assertEqual([row for row in rows if row["level"] == "bad"], [], what)


def check_standings(case, view):
    """A robot stands as the worst of its rows, without the first map of a second kind, with the age of its oldest map, or else of its pose."""
    for standing in view["standings"]:
        rows = [row for row in view["activities"] if row["robot"] == standing["name"]]
        delivered = any(row["kind"] != "state" and row["arrival"] != "waiting" for row in rows)
        worst = max((row for row in rows if not delivered or row["arrival"] != "waiting"), key=lambda row: LEVELS.index(row["level"]))
        case.assertEqual((standing["level"], standing["word"]), (worst["level"], worst["word"]), standing)
        case.assertEqual(standing["silent"], any(row["arrival"] == "silent" for row in rows), standing)
        its_maps = [row for row in rows if row["kind"] != "state"]
        case.assertEqual(standing["has_map"], bool(its_maps), standing)
        case.assertAlmostEqual(standing["age"] or 0, oldest(its_maps or rows), delta=0.01, msg=standing)


def without_ages(text):
    return re.sub(rf"{AGE}|{CLOCK}", "AGE", text)


def check_command_line(case, view, text, status):
    """`adit status`: the headline, a line for each alarm and no other, a row for each robot and kind."""
    lines = text.splitlines()
    headline = next(line for line in lines if line.startswith("Maps  "))
    case.assertEqual(without_ages(headline), without_ages(f'Maps  {view["verdict"]["what"]}: {view["verdict"]["why"]}'))
    for said, told in zip(re.findall(AGE, headline), re.findall(AGE, view["verdict"]["why"]), strict=True):
        same_age(case, said, sum(seconds_in(told)) / 2, headline)
    of_alarms = [match.groups() for match in (re.match(r"  ([x?!]) (.*?) \(\d", line) for line in lines) if match]
    case.assertEqual(of_alarms, [(SEVERITIES[alarm["severity"]], alarm["what"]) for alarm in view["alarms"]])
    case.assertEqual(status, int(any(alarm["severity"] != "wait" for alarm in view["alarms"])))
    for row in view["activities"]:
        name = row["robot"] or "(all)"
        found = next(re.split(r"  +", line.strip()) for line in lines if re.match(rf" +{re.escape(name)} +{row['kind']} ", line))
        case.assertEqual(without_ages(found[2]), without_ages(row["word"]))
        heard = next(i for i, cell in enumerate(found) if re.fullmatch(r"[\d.]+ \w+ ago|never", cell))
        age = found[heard - 1] if re.fullmatch(r"[\d.]+ \w+", found[heard - 1]) else None
        if age or (row["age"] or 0) > SLACK:
            case.assertIsNotNone(age, found)
            same_age(case, age, row["age"] or 0, found)
        same_age(case, found[heard].removesuffix(" ago"), row["heard"], found)


def check_metrics(case, view, text):
    def samples(name):
        found = re.findall(rf"^{name}\{{(.*)\}} (\S+)$", text, re.M)
        return [(dict(re.findall(r'(\w+)="([^"]*)"', labels)), float(value)) for labels, value in found]

    rows = {(row["kind"], row["robot"]): row for row in view["activities"]}
    for name, member in (("adit_updates_age_seconds", "age"), ("adit_updates_heard_seconds", "heard")):
        told = {(labels["kind"], labels["robot"]): value for labels, value in samples(name)}
        case.assertEqual(told.keys(), rows.keys(), name)
        for key, value in told.items():
            case.assertAlmostEqual(value, rows[key][member] or 0, delta=SLACK, msg=(name, key))
    told = {(labels["kind"], labels["robot"]): labels["arrival"] for labels, _ in samples("adit_updates_arrive")}
    case.assertEqual(told, {key: row["arrival"] for key, row in rows.items()})
    case.assertEqual([(labels["id"], labels["severity"]) for labels, _ in samples("adit_alarm")],
                     [(alarm["id"], alarm["severity"]) for alarm in view["alarms"]])


def pattern_of(cell):
    cell = SHORT.get(cell, cell)
    words = re.sub(r"\\\[(.*?)\\\]", r"(?:\1)?", re.escape(cell)).replace("AGE", AGE).replace("CLOCK", CLOCK)
    level, _, rest = words.partition(r"\ ")
    return re.compile(f"{level} (?:{rest.replace('/', '|')})" if rest else words)


def expected(state, merged):
    """The patterns of a row's cells, in the order of Observed.cells()."""
    for line, verdict in zip(LINES[::2], LINES[1::2]):
        its_state, its_merged, *cells = (cell.strip() for cell in line.split("|"))
        if (its_state, its_merged) == (state, merged):
            return [pattern_of(cell) for cell in (*cells, verdict.strip())]
    raise AssertionError(f"{state}, {merged}: no such row")


def print_table(rows):
    head = [cell.strip() for cell in HEAD.split("|")]
    widths = [max(len(cells[i]) for cells in [head, *rows]) for i in range(len(head))]
    print()
    for *cells, verdict in [[*head, ""], *rows]:
        print(" | ".join(cell.ljust(width) for cell, width in zip(cells, widths)).rstrip())
        if verdict:
            print(f"    {verdict}")


# ---- the states: each function leaves the stage in its state ----

def nothing_posted(stage):
    return Team(stage)


def all_fresh(stage):
    return Team(stage, ROBOTS, ROBOTS)


def one_late(stage):
    """The grid of r1 takes three quarters of a minute at this budget."""
    team = all_fresh(stage)
    wait_until(lambda: len(Observed(stage).maps()) == 3, "a map of each robot")
    team.maps = set()
    wait_until(lambda: all(row["age"] is None for row in Observed(stage).maps()), "their delivery")
    scale = bytes(value % 101 for value in range(256))
    team.post_grid("r1", 2000, 2700, os.urandom(2000 * 2700).translate(scale))
    return team


def one_silent(stage):
    team = all_fresh(stage)
    has_habit(stage)
    team.poses, team.maps = {"r2", "r3"}, {"r2", "r3"}
    return team


def all_silent(stage):
    team = all_fresh(stage)
    has_habit(stage)
    team.poses, team.maps = set(), set()
    return team


def quiet_maps(stage):
    team = all_fresh(stage)
    wait_until(lambda: len(Observed(stage).maps()) == 3, "a map of each robot")
    team.maps = set()
    return team


def one_without_a_map(stage):
    return Team(stage, ROBOTS, ("r1", "r2"))


def after_a_restart(stage):
    """Each map waits for its turn, at a map every five seconds. The first answer after the restart has the old ages, which aditd
    records once a second."""
    team = all_fresh(stage)

    def queued_for_long():
        view = stage.box.ask("GET /adit/run")[1]
        rows = [row for row in view["activities"] if row["kind"] == "grid"]
        are_recorded = len(rows) == 3 and all(view["now"] - (row["last_forwarded"] or view["now"]) > 1.5 for row in rows)
        return rows if are_recorded and oldest(rows) > 8 else None

    before = wait_until(queued_for_long, "a map of each robot, and one that is queued for long")
    stage.box.stop(signal.SIGKILL)
    stage.restart_box()
    view = stage.box.ask("GET /adit/run")[1]
    after = {row["robot"]: row for row in view["activities"] if row["kind"] == "grid"}
    for row in before:
        now = after[row["robot"]]
        is_the_same = row["behind_since"] and now["forwarded"] == 0 and now["last_forwarded"] - row["last_forwarded"] < SLACK
        if is_the_same and abs(now["behind_since"] - row["behind_since"]) > SLACK:
            raise AssertionError(f"{row['robot']}: since {row['behind_since']}, after the restart since {now['behind_since']}")
    if not expected("after a restart", "no")[-1].fullmatch(verdict_text(view)):
        raise AssertionError(f"after the restart: {verdict_text(view)}")
    return team


def command_post_silent(stage):
    team = all_fresh(stage)
    wait_until(lambda: len(Observed(stage).maps()) == 3, "a map of each robot")
    stage.post.process.send_signal(signal.SIGSTOP)
    return team


def has_habit(stage):
    def heard():
        rows = stage.box.ask("GET /adit/run")[1]["activities"]
        return len(rows) == 2 * len(ROBOTS) and all(row["accepted"] > 5 for row in rows)

    wait_until(heard, "each robot's habit")


STATES = {
    "nothing posted": (nothing_posted, {}),
    "all fresh": (all_fresh, {}),
    "one late": (one_late, {"command_post__budget_mbit": 0.8}),
    "one silent": (one_silent, {}),
    "all silent": (all_silent, {}),
    "quiet maps": (quiet_maps, {}),
    "one without a map": (one_without_a_map, {}),
    "after a restart": (after_a_restart, {"command_post__rates__map_hz": 0.2}),
    "Command Post silent": (command_post_silent, {}),
}


def observed_as(stage, state, merged):
    """Waits until the cells are as expected, and do not change while the faces are read."""
    patterns = expected(state, merged)
    last = None

    def fits():
        nonlocal last
        last = Observed(stage)
        return last if last.is_stable and all(pattern.fullmatch(cell) for pattern, cell in zip(patterns, last.cells(), strict=True)) else None

    return wait_until(fits, lambda: f"{state}, merged map: {merged}; {last.cells()}\n{last.text}", 90, every=0.2)


def play(state):
    """Both rows of a state, in a process of its own, because it moves into the team's namespace. Returns the observations by "no"
    and "yes"."""
    reach, overrides = STATES[state]
    seen = {}
    with Stage(alarms__silent_for_ms=5000, alarms__silent_times=2, **overrides) as stage:
        wait_until(stage.box.knows_the_run, "the run to be known")
        team = reach(stage)
        for merged in ("no", "yes"):
            if merged == "yes":
                team.maps = team.maps | {MERGED}
            seen[merged] = observed_as(stage, state, merged)
        team.over.set()
        team.join()
    return seen


class States(unittest.TestCase):
    maxDiff = None

    def test_all_faces_agree(self):
        with concurrent.futures.ProcessPoolExecutor(len(STATES), multiprocessing.get_context("fork")) as pool:
            played = {state: pool.submit(play, state) for state in STATES}
        rows = []
        for state, future in played.items():
            with self.subTest(state):
                for merged, seen in future.result().items():
                    rows.append([state, merged, *seen.cells()])
                    with self.subTest(state, merged=merged):
                        seen.check(self)
        print_table(rows)
