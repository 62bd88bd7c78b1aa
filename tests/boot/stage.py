"""A machine with a card, between the Command Post and the team: shared by all stories."""

import functools
import json
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import boards
import cables
import disk
import eavesdropper
import hosts
import machine
import programs
from patience import patient

# The settings on the card. Others are as in programs.settings(), but with more time for an emulated machine on a busy
# host.
LISTEN = [{"address": "0.0.0.0", "port": 80}, {"address": "0.0.0.0", "port": 8000}]
SETTINGS = {
    "team__listen": LISTEN,
    "command_post__rates": {"reports_hz": 20, "status_hz": 5, "map_hz": 1, "state_hz": 2, "markers_hz": 2},
}
NUMBERS = {
    "team": {"mode": "static", "address": cables.FACTORY_ADDRESS, "prefix": 24},
    "command_post": {"addresses": [{"address": hosts.BOX_DARPA, "prefix": 24}], "gateway": ""},
}
ENDPOINTS = [(hosts.SCORING, programs.PORT), (hosts.MAPPING, programs.PORT)]
FIGURES = pathlib.Path(os.environ.get("ADIT_FIGURES", boards.SOURCE / "build" / "boot-figures.txt"))


def setUpModule():  # of each module that imports it
    hosts.needs_root()
    skip_without(boards.QEMU_VIRT)


def skip_without(board):
    if board.missing():
        raise unittest.SkipTest(board.missing())


def load_tests(_, tests, __):
    """Runs the tests of a story in the order in which they are written."""

    def each(suite):
        for test in suite:
            yield from each(test) if isinstance(test, unittest.TestSuite) else [test]

    return unittest.TestSuite(
        sorted(
            each(tests),
            key=lambda test: (type(test).__name__, getattr(type(test), test._testMethodName).__code__.co_firstlineno),
        )
    )


class Stage:
    """`set_up`: whether the card has settings, addresses and tokens, as prepared in a card reader. `post_options`: None for no
    Command Post."""

    def __init__(self, set_up=True, post_options=("--rate", "0"), board=boards.QEMU_VIRT, **overrides):
        self.temporary = tempfile.TemporaryDirectory(prefix="adit-boot-")
        self.folder = pathlib.Path(self.temporary.name)
        self.set_up, self.post_options, self.overrides = set_up, post_options, {**SETTINGS, **overrides}
        self.board, self.network = board, cables.Cables()
        self.post = self.box = self.ear = None

    def __enter__(self):
        secrets = programs.secrets_folder(self.folder / "secrets")
        self.network.__enter__()
        try:
            self.ear = eavesdropper.Eavesdropper(self.network, self.network.post)
            if self.post_options is not None:
                self.post = programs.CommandPost(self.network, self.folder, *self.post_options)
            self.disk = disk.Disk(self.folder, self.board.image())
            self.disk.put("adit/boot.env", f"adit_cmdline={self.board.words}\n")
            if self.set_up:
                self.disk.put("adit/settings.json", json.dumps(programs.settings(self.network, self.overrides)))
                self.disk.put("adit/network.json", json.dumps(NUMBERS))
                self.disk.make_folder("adit/secrets")
                for token in secrets.iterdir():
                    self.disk.put(f"adit/secrets/{token.name}", token.read_text())
            self.box = machine.Machine(self.network, self.folder, self.disk, self.board)
        except BaseException:
            self.__exit__()
            raise
        return self

    def start(self):
        """Switches the box on, and waits until it answers the team."""
        self.box.power_on()
        self.box.wait_for_answer()
        return self

    def began(self):
        """Waits until the box knows the run."""
        self.box.wait_until(self.box.knows_the_run, "the box to know the run", 180)
        return self

    def robots(self, seconds, *options):
        """Lets the simulated team explore for that time. Returns its exit status and output."""
        robots = self.network.start(
            self.network.team,
            programs.BIN / "adit-robots",
            "--post",
            self.box.url,
            "--secrets",
            self.folder / "secrets",
            "--for",
            seconds,
            "--quiet",
            *options,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        said, _ = robots.communicate(timeout=seconds + patient(180))
        return robots.returncode, said

    def __exit__(self, *_):
        if self.box is not None and self.box.process is not None:
            self.box.cut_power()
        if self.post is not None and self.post.process.poll() is None:
            self.post.process.kill()
            self.post.process.wait()
        if self.ear is not None:
            self.ear.close()
        self.network.__exit__()
        self.temporary.cleanup()


class Story(unittest.TestCase):
    """Tests that share one machine, each of which continues from the one before. If one fails, the others are skipped."""

    broken = ""

    @classmethod
    def tell(cls, stage):
        """Sets the common stage; call from setUpClass."""
        cls.stage = cls.enterClassContext(stage)
        return stage

    def run(self, result=None):
        if type(self).broken:
            self.setUp = lambda: self.skipTest("after " + type(self).broken)
        before = len(result.failures) + len(result.errors)
        super().run(result)
        if len(result.failures) + len(result.errors) > before and not type(self).broken:
            type(self).broken = self._testMethodName
            print("--- what the console said last:\n" + self.stage.box.said_last(), flush=True)
        return result

    @property
    def box(self):
        return self.stage.box


@functools.cache
def speed_of_host():
    """The speed of this machine's processor: seconds for ten million turns of a Python loop."""
    began = time.process_time()
    for _ in range(10_000_000):
        pass
    return f"{time.process_time() - began:.2f} s for ten million turns of Python"


def note(figure, value):
    """Prints a figure, and saves it for CI, with the host's speed."""
    print(f"\n  {figure}: {value}", flush=True)
    FIGURES.parent.mkdir(parents=True, exist_ok=True)
    with open(FIGURES, "a", encoding="utf-8") as file:
        file.write(f"{time.strftime('%F %T')}  {figure}: {value}  [this host: {speed_of_host()}]\n")
