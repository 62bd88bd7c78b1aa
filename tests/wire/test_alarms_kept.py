"""Alarms of what cannot be kept on the disk."""

import os
import pathlib
import subprocess
import tempfile

from unittest import mock

from alarming import WithAlarms
from filling import Filler
from programs import wait_until
from reporting import another, began, submit


class Kept(WithAlarms):
    def test_the_ledger_was_damaged(self):
        stage = self.stage()
        self.assertEqual(submit(stage).status_code, 201)
        self.assertEqual(stage.box.stop(), 0)
        ledger = stage.box.state / "ledger.sqlite"
        ledger.write_bytes(ledger.read_bytes()[:4096] + os.urandom(ledger.stat().st_size - 4096))
        for log in stage.box.state.glob("ledger.sqlite-*"):
            log.unlink()
        stage.restart_box()
        self.sees(began(stage), "ledger_damaged", "ask", "box", "The ledger was damaged")
        lost = next(each["id"] for each in self.view(stage)["alarms"] if each["id"].startswith("report_lost:"))
        self.sees(stage, lost, "ask", "box", "The ledger is not whole", "may be lost")
        self.assertEqual(stage.box.judge(int(lost.partition(":")[2]), "done")[0], 200)
        self.goes(stage, lost)
        self.gone_after_a_restart(stage, "ledger_damaged")

    def runtime(self, size="8m"):
        """A runtime folder that is a file system of its own, as with systemd."""
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="adit-runtime-")))
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "adit-wire", folder], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", folder], check=False)
        self.enterContext(mock.patch.dict(os.environ, RUNTIME_DIRECTORY=str(folder)))
        return folder

    def test_the_ledger_cannot_be_written(self):
        self.runtime()
        stage = self.stage(disk="12m")
        self.assertEqual(submit(stage).status_code, 201)
        filler = Filler(stage.box.state)
        for number in range(1, 500):  # what the ledger has of its own has room for some
            if submit(stage, another(number)).status_code != 201:
                break
        self.sees(stage, "ledger_unwritable", "bad", "box", "No report is taken", "the ledger cannot be written", light="health")
        filler.make_room()
        wait_until(lambda: submit(stage, another(number)).status_code == 201, "room to be found")
        self.goes(stage, "ledger_unwritable")

    def test_the_run_is_not_kept(self):
        stage = self.stage(disk="12m")
        filler = Filler(stage.box.state, leaves=2 << 20)
        self.sees(stage, "run_not_kept", "bad", "box", "The run's map is not kept", "will not outlive a restart")
        filler.make_room()
        self.goes(stage, "run_not_kept")

    def test_maps_and_states_cannot_be_kept(self):
        runtime = self.runtime("4m")
        stage = self.stage()
        filler = Filler(runtime)
        self.assertEqual(self.send_map(stage, "r1", 1, 100000).status_code, 503)
        self.sees(stage, "map_not_kept", "bad", "box", "The last map was not taken", panel=False)
        robot = self.robot(stage, "r1")
        self.sees(stage, "state_not_kept", "bad", "box", "States and markers are not taken", "they cannot be kept", panel=False)
        robot.quiet()
        filler.make_room()
        self.robot(stage, "r1")
        self.goes(stage, "state_not_kept")
        wait_until(lambda: self.send_map(stage, "r1", 1).status_code == 200, "a map to be taken")
        self.goes(stage, "map_not_kept")
