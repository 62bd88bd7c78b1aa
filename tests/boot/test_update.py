"""Updates: one from a stick that stays, one that is uploaded, cannot start and is abandoned. Settings and reports are kept.
Rejections: update/test_update.py."""

import pathlib
import re
import tempfile

import boards
from bundles import bundle, stick
from reporting import REPORT
from stage import Stage, Story, load_tests, note, setUpModule  # unittest looks for them here
from updating import Updating

RUNS = re.search(r"-([0-9].*)\.img$", boards.QEMU_VIRT.image().name).group(1) if not boards.QEMU_VIRT.missing() else ""
NEWER, EVEN_NEWER, BROKEN = "7.0.0", "7.0.1", "7.1.0"


class Updates(Updating, Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage())
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="adit-bundles-")))

    def install(self, ask, version):
        """`ask`: the request for it."""
        began = self.box.moment()
        ask()
        self.box.wait_until(lambda: self.last() in (("installed", version), ("failed", version)), "the end of it", 480)
        self.assertEqual(self.last(), ("installed", version), self.stands()["refusal"])
        return self.box.took(began)

    def offered(self):
        return (self.stands()["stick"] or {}).get("version")

    def test_it_runs_in_the_first_slot(self):
        self.stage.start().began()
        self.box.wait_until(lambda: self.stands()["managed"], "adit-update to have told what runs")
        self.assertEqual((self.stands()["managed"], self.stands()["version"], self.stands()["slot"]), (True, RUNS, "A"))
        status, said = self.box.ask("POST /api/artifact_reports", body=REPORT, timeout=60)
        self.assertEqual(status, 201, said)

    def test_newer_version_on_a_stick_is_offered_but_not_installed(self):
        newer = bundle(self.folder, NEWER)
        self.box.plug_stick(stick(self.folder, newer))
        self.box.wait_until(lambda: self.stands()["stick"], "what is on the stick to be offered")
        self.assertEqual(self.stands()["stick"], {"name": newer.name, "version": NEWER})
        self.assertEqual((self.stands()["doing"], self.stands()["last"]), (None, None))

    def test_second_stick_is_read_beside_it(self):
        folder = self.folder / "second"
        folder.mkdir()
        self.box.plug_stick(stick(folder, bundle(folder, EVEN_NEWER)), "second")
        self.box.wait_until(lambda: self.offered() == EVEN_NEWER, "what is on the second stick to be offered")
        mounted = "ls /run/adit-stick; grep -c /run/adit-stick/ /proc/mounts"
        self.box.wait_until(
            lambda: self.box.console.ask(mounted).split() == ["sda1", "sda2", "sdb1", "sdb2", "4"], "all to be mounted"
        )
        self.box.pull_stick("second")
        self.box.wait_until(lambda: self.offered() == NEWER, "what is on the first one to be offered again")

    def test_healthy_update_in_the_other_slot_stays(self):
        self.install(lambda: self.assertEqual(self.box.ask("POST /adit/update/stick", body={})[0], 200), NEWER)
        self.box.pull_stick()
        self.box.wait_until(lambda: not self.stands()["stick"], "the stick to be gone")
        self.restart()
        self.settled("good", NEWER, within=600)
        self.assertEqual((self.stands()["version"], self.stands()["slot"]), (NEWER, "B"))

    def test_settings_tokens_and_reports_are_kept(self):
        self.assertEqual([each["state"] for each in self.box.reports()], ["answered"])
        self.stage.began()

    def test_update_that_does_not_start_is_left_after_three_tries(self):
        broken = bundle(self.folder, BROKEN, without="usr/lib/systemd/systemd")
        took = self.install(lambda: self.send(broken), BROKEN)
        note(f"update of {broken.stat().st_size / 1e6:.0f} MB sent and installed", took)
        self.restart()
        self.settled("left", BROKEN, within=600)
        self.assertEqual((self.stands()["version"], self.stands()["slot"]), (NEWER, "B"))
        self.assertEqual(self.box.console.said().count("Adit: slot a"), 1 + 3)
        self.box.console.wait_for_shell()
        order = self.box.console.ask("fw_printenv -n BOOT_ORDER")
        self.assertEqual(order.split(), ["B"], "it is never started again")

    def test_reports_are_unchanged_after_it(self):
        self.assertEqual([each["state"] for each in self.box.reports()], ["answered"])
        self.stage.began()
