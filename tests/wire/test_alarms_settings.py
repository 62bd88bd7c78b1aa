"""Alarms of settings and tokens."""


import programs
from alarming import WithAlarms
from programs import wait_until
from reporting import began

PASSWORD = "a password of the team's"


class Settings(WithAlarms):
    def test_no_token_is_set(self):
        stage = self.stage()
        (stage.folder / "secrets/mapping.token").unlink()
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": None})
        self.sees(stage, "no_token:mapping", "bad", "box", "No mapping token is set", "wait until one is")
        stage.box.apply("POST /adit/tokens", {"name": "mapping", "token": programs.MAPPING_TOKEN})
        self.goes(stage, "no_token:mapping")

    def test_no_token_is_set_at_all(self):
        stage = self.stage()
        operator = self.operator(stage)
        for token in (stage.folder / "secrets").glob("*.token"):
            token.unlink()
        for name in ("mapping", "scoring", "team"):
            status, said = stage.box.insist("POST /adit/tokens", operator, {"name": name, "token": None}, token=None)
            self.assertEqual(status, 200, said)

        def found():
            return next((each for each in stage.box.ask("GET /adit/run", operator, token=None)[1]["alarms"]
                         if each["id"] == "no_token:team"), None)

        alarm = wait_until(found, "no_token:team")
        self.assertEqual((alarm["severity"], alarm["side"], alarm["what"]), ("bad", "box", "No token is set at all"))
        self.blinks(stage, "attention")
        said = stage.box.insist("POST /adit/tokens", operator, {"name": "team", "token": programs.TEAM_TOKEN}, token=None)
        self.assertEqual(said[0], 200, said)
        wait_until(lambda: stage.box.ask("GET /adit/run")[0] == 200, "the token to be in use")
        self.goes(stage, "no_token:team")

    def operator(self, stage):
        """The headers of somebody who is logged in; he needs no token."""
        (stage.folder / "secrets/label.code").write_text("12345678\n")
        (stage.folder / "secrets/label.code").chmod(0o600)
        stage.box.stop()
        stage.restart_box()
        body = {"role": "operator", "code": "12345678", "password": PASSWORD}
        status, said = began(stage).box.ask("POST /adit/password", body=body, token=None)
        self.assertEqual(status, 200, said)
        return programs.log_in(stage.box, PASSWORD)

    def test_the_settings_were_taken_back(self):
        stage = self.stage()
        held = stage.box.ask("GET /adit/settings")[1]
        held["settings"]["team"]["listen"].append({"address": "192.168.99.99", "port": 1234})
        stage.box.apply("POST /adit/settings", {"settings": held["settings"], "base": held["tag"]})
        self.sees(stage, "settings_not_changed", "bad", "box", "The last change was taken back")
        stage.box.save(lambda settings: settings["reports"].update(near_metres=7))
        self.goes(stage, "settings_not_changed")

    def test_saved_settings_are_not_used(self):
        stage = self.stage()
        stage.box.save(lambda settings: settings["reports"].update(near_metres=7))
        self.assertEqual(stage.box.stop(), 0)
        (stage.box.state / "settings.json").write_text("{")
        stage.restart_box()
        self.sees(began(stage), "settings_not_used", "bad", "box", "The saved settings are not used", "are set aside")
        stage.box.save(lambda settings: settings["reports"].update(near_metres=8))
        self.goes(stage, "settings_not_used")
