"""Shared by the stories of a box in a container: set-up, requests, checks."""

import shlex

import container
import programs
import stage

PASSWORD = "correct horse battery"


class Contained(stage.Story):
    session = {}

    @classmethod
    def setUpClass(cls):
        cls.tell(container.Stage())

    def asked(self, request, body=None, status=200):
        headers = {**self.session, "Content-Type": "application/json"}
        got, said = self.box.insist(request, headers, body, token=None)
        self.assertEqual(got, status, said)
        return said

    def confirmed(self):
        """Confirms the change of the addresses, which is made within seconds. Returns whether that worked."""
        session = {**self.session, "Content-Type": "application/json"}
        status, said = self.box.ask("POST /adit/network/confirm", session, None, token=None)
        self.assertIn(status, (200, 409), said)
        return status == 200

    def set_up(self):
        """Sets the box up by its API, as the page does, until it knows the run."""
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

    def shell(self, script):
        done = self.box.run("sh", "-euc", script)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def lit(self):
        """The lights that are on; the panel is simulated."""
        said = self.box.run("cat", "/run/adit-panel/lights").stdout
        return {line.split()[0] for line in said.splitlines() if line.endswith(" on")}

    def wait_for_lights(self):
        programs.wait_until(lambda: {"health", "scoring", "mapping"} <= self.lit(), "the lights to say that all is well", 60)

    def drop_in(self, unit, *lines):
        folder = f"/run/systemd/system/{unit}.d"
        self.shell(f"mkdir -p {folder}; printf '%s\\n' {shlex.join(lines)} >{folder}/container.conf")
