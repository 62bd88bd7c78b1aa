"""Every day's variant: the real root and units in a container, set up, reporting, restarted and killed, in under a
minute."""

import pathlib
import tempfile
import time
import unittest

import requests

import container
import hosts
import inside_unit
import maps
import messages
import programs
import stage
from reporting import REPORT, another, submit
from stage import Story, load_tests, note  # unittest looks for them here

PASSWORD = "correct horse battery"
STATE = "/var/lib/private/adit"
JSON = messages.Style()
POSE = {"name": "r1", "position": {"x": 4.0, "y": 0.0, "z": 0.0}, "orientation": maps.IDENTITY}


def setUpModule():
    hosts.needs_namespaces()
    if container.missing():
        raise unittest.SkipTest(container.missing())


class Contained:
    """The stage: container and Command Post."""

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="adit-container-")
        self.folder = pathlib.Path(self.temporary.name)
        self.network = container.Cables()
        self.post = self.box = None
        self.network.__enter__()
        try:
            programs.secrets_folder(self.folder / "secrets")
            self.post = programs.CommandPost(self.network, self.folder, "--rate", "0")
            self.box = container.Container(self.network, self.folder)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.box is not None:
            self.box.close()
        if self.post is not None:
            self.post.stop()
        self.network.__exit__()
        self.temporary.cleanup()


class Everyday(Story):
    session = {}

    @classmethod
    def setUpClass(cls):
        cls.tell(Contained())

    def asked(self, request, body=None, status=200):
        headers = {**self.session, "Content-Type": "application/json"}
        got, said = self.box.insist(request, headers, body, token=None)
        self.assertEqual(got, status, said)
        return said

    def confirmed(self):
        """Whether the change of the addresses could be confirmed: it is made within seconds."""
        session = {**self.session, "Content-Type": "application/json"}
        status, said = self.box.ask("POST /adit/network/confirm", session, None, token=None)
        self.assertIn(status, (200, 409), said)
        return status == 200

    def test_it_answers_at_the_factory_address(self):
        self.box.start()
        note("container, from its start to the first answer on team0", f"{time.monotonic() - self.box.began:.1f} s")
        self.assertEqual(self.asked("GET /adit/session")["first_start"], True)

    def test_no_unit_has_failed(self):
        self.assertEqual(self.box.run("systemctl", "--failed", "--plain", "--no-legend", "--no-pager").stdout, "")

    def test_it_is_set_up_over_the_api(self):
        self.asked("POST /adit/password", {"role": "operator", "code": self.box.code(), "password": PASSWORD})
        type(self).session = programs.log_in(self.box, PASSWORD)
        for name, token in (
            ("scoring", programs.SCORING_TOKEN),
            ("mapping", programs.MAPPING_TOKEN),
            ("team", programs.TEAM_TOKEN),
        ):
            self.asked("POST /adit/tokens", {"name": name, "token": token})
        self.asked("POST /adit/network", stage.NUMBERS)
        programs.wait_until(self.confirmed, "darpa0 to have its address, and that to be confirmed", 60)
        programs.wait_until(self.box.knows_the_run, "the box to know the run", 60)

    def test_a_report_is_recorded(self):
        self.assertEqual(submit(self.stage).status_code, 201)
        self.assertEqual(len(self.stage.post.recorded(REPORT)), 1)

    def test_a_restart_loses_no_connection_attempt(self):
        network, before, tried = self.stage.network, self.box.pid(), 0
        self.box.run("systemctl", "restart", "--no-block", "adit.service")
        end = time.monotonic() + 60.0
        while tried <= 100 or self.box.pid() in (0, before) or not self.box.answers():
            self.assertLess(time.monotonic(), end, "it is not started again")
            for _ in range(20):
                network.connect(network.team, network.box_address, 80, 20.0).close()
                tried += 1

    def shell(self, script):
        done = self.box.run("sh", "-euc", script)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_from_inside_its_unit_it_may_do_no_more_than_it_must(self):
        # A container's systemd may load no filter of addresses into the kernel.
        refused = inside_unit.check(self, self.shell, but={"connect to 203.0.113.1"})
        note("container, refused from inside adit.service", f"{refused} attempts")

    def flows(self, uri, message):
        """What is posted is taken, and arrives."""
        before = len(self.stage.post.requests(uri))
        answer = messages.post(requests.Session(), self.box.url, uri, message, JSON)
        self.assertEqual(answer.status_code, 200, answer.text)
        programs.wait_until(lambda: len(self.stage.post.requests(uri)) > before, f"{uri} to go on", 60)

    def says(self, why):
        said = self.box.attention()
        self.assertIn("no report is taken: the ledger cannot be written: ", said)
        self.assertIn(why, said)

    def takes_no(self, report):
        """And all else flows."""
        refused = submit(self.stage, report)
        self.assertEqual(refused.status_code, 503, refused.text)
        self.assertIn("could not be written down and was not taken", refused.json())
        self.assertEqual(self.stage.post.recorded(report), [])
        self.assertEqual([each["state"] for each in self.box.reports()], ["answered"], "what can be read is shown")
        self.flows("/state/update", {"poses": [POSE]})
        self.flows("/map/update", messages.map_update(maps.made_grid(20, 20), "r1", time.time(), JSON))

    def test_a_state_folder_that_cannot_be_written_to(self):
        """A file system of its own, that is read-only as after an error of the disk, then full, then as it was."""
        self.shell(f"""systemctl stop adit.service; cp -a {STATE} /run/was
            mount -t tmpfs -o size=8m,mode=0700 tmpfs {STATE}; cp -aT /run/was {STATE}; mount -o remount,ro {STATE}
            systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)
        self.says("Read-only file system")
        self.takes_no(another(1))
        self.shell(f"""systemctl stop adit.service; mount -o remount,rw {STATE}
            dd if=/dev/zero of={STATE}/filler bs=4096 2>/dev/null || true; systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)
        self.takes_no(another(2))
        self.says("full")
        self.shell(f"rm {STATE}/filler")
        programs.wait_until(lambda: submit(self.stage, another(3)).status_code == 201, "it to recover by itself", 60)
        self.assertNotIn("the ledger", self.box.attention())
        self.shell(f"""systemctl stop adit.service; umount {STATE}; systemctl start adit.service""")
        programs.wait_until(self.box.knows_the_run, "it to start", 60)

    def test_it_is_started_again_after_a_kill(self):
        before = programs.wait_until(self.box.pid, "it to run", 60)
        self.box.run("kill", "-9", str(before))
        programs.wait_until(
            lambda: self.box.pid() not in (0, before) and self.box.answers(), "another aditd to answer", 60
        )

    def lit(self):
        """The lights that are lit; the panel is a simulated one."""
        said = self.box.run("cat", "/run/adit-panel/lights").stdout
        return {line.split()[0] for line in said.splitlines() if line.endswith(" on")}

    def wait_for_lights(self):
        programs.wait_until(lambda: {"health", "scoring", "mapping"} <= self.lit(), "the lights to say that all is well", 60)

    def test_the_lights_show_a_hang_before_systemd_ends_it(self):
        before = programs.wait_until(self.box.pid, "it to run", 60)
        self.wait_for_lights()
        self.box.run("kill", "-STOP", str(before))
        began = time.monotonic()
        programs.wait_until(lambda: self.lit() <= {"health"}, "the lights not to pretend any more", 60)
        note("container, from SIGSTOP of aditd to the fault on the lights", f"{time.monotonic() - began:.1f} s")
        self.assertEqual(self.box.pid(), before, "nobody has ended it yet")
        programs.wait_until(lambda: self.box.pid() not in (0, before) and self.box.answers(), "another aditd to answer", 60)
        self.wait_for_lights()

    def test_a_panel_that_is_killed_or_hangs_comes_back(self):
        for how in "KILL", "STOP":
            before = self.shell("systemctl show -p MainPID --value adit-panel.service").strip()
            self.shell(f"kill -{how} {before}; rm -f /run/adit-panel/lights")
            programs.wait_until(lambda: self.lit() >= {"health", "scoring", "mapping"}, "another adit-panel to show the lights", 60)
            self.assertTrue(self.box.answers())

    def test_settings_reports_and_journal_are_kept_over_a_start(self):
        self.box.stop()
        self.stage.network.cable_the_box()
        self.box.start()
        self.assertEqual([each["state"] for each in self.box.reports()], ["answered"])
        programs.wait_until(self.box.knows_the_run, "the Command Post to be heard again by the confirmed address", 60)
        boots = self.box.run("journalctl", "--list-boots", "-q", "--no-pager").stdout
        self.assertEqual(len(boots.splitlines()), 2, boots)


if __name__ == "__main__":
    unittest.main()
