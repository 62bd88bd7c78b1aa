"""An alarm that is acknowledged, over the ends of the service."""

import signal

from alarming import WithAlarms
from programs import wait_until
from reporting import another, began, left_unanswered


class Acknowledged(WithAlarms):
    def test_an_acknowledgement_outlives_the_service_and_hides_nothing_new(self):
        stage = self.stage(reports__review="all")
        left_unanswered(stage)
        self.sees(stage, "report_held:1", "ask", "box", "Report 1 is held")
        self.acknowledged(stage, "report_held:1")
        wait_until((stage.box.state / "acknowledged.json").exists, "it to be kept")
        for how in (signal.SIGTERM, signal.SIGKILL):
            stage.box.stop(how)
            stage.restart_box()
            wait_until(lambda: self.alarm(stage, "report_held:1"), "it to be found again")
            self.assertTrue(self.alarm(stage, "report_held:1")["acknowledged"])
            wait_until(lambda: self.light(stage) == "on", "the attention light to stay lit")
        left_unanswered(began(stage), another(1))
        self.sees(stage, "report_held:2", "ask", "box", "Report 2 is held")
        stage.box.stop()
        (stage.box.state / "acknowledged.json").write_text("damaged")
        stage.restart_box()
        self.sees(began(stage), "report_held:1", "ask", "box", "Report 1 is held")
        self.assertFalse(self.alarm(stage, "report_held:1")["acknowledged"])
        self.assertEqual(stage.box.said().count("which alarms were acknowledged cannot be read"), 1)
