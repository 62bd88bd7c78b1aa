"""Alarms of reports and of the count of them."""


import hosts
import programs
from alarming import WithAlarms
from programs import wait_until
from reporting import another, left_unanswered, submit


class Reports(WithAlarms):
    def test_a_report_is_held(self):
        stage = self.stage(reports__review="all")
        left_unanswered(stage)
        alarm = self.sees(stage, "report_held:1", "ask", "box", "Report 1 is held")
        self.assertEqual(alarm["action"], {"word": "Decide", "link": "/#report=1"})
        self.assertEqual(stage.box.judge(1, "send")[0], 200)
        self.goes(stage, "report_held:1")

    def test_a_report_is_in_doubt(self):
        stage = self.stage()
        stage.post.will("other-sender,record-then-drop")
        left_unanswered(stage)
        self.sees(stage, "report_in_doubt:1", "ask", "command_post", "Report 1 is in doubt", light=None)
        self.assertEqual(stage.box.judge(1, "done")[0], 200)
        self.goes(stage, "report_in_doubt:1")

    def test_few_reports_are_left_and_then_none(self):
        stage = self.stage(post_options=("--rate", "0", "--reports", "6"))
        self.assertEqual(submit(stage).status_code, 201)
        self.sees(stage, "reports_left", "wait", "command_post", "5 reports are left")
        for number in range(5):
            submit(stage, another(number))
        wait_until(lambda: self.alarm(stage, "reports_left")["severity"] == "bad", "none to be left")
        self.sees(stage, "reports_left", "bad", "command_post", "No reports are left")
        stage.post.control("POST /new-run", {"run": "2"})
        self.goes(stage, "reports_left")

    def test_reports_wait_for_another_command_post(self):
        stage = self.stage()
        stage.post.will("429=100")
        left_unanswered(stage)
        self.name_scoring(stage, 8009)
        name = f"reports_elsewhere:{hosts.SCORING}:{programs.PORT}"
        self.sees(stage, name, "ask", "box", "1 report is for another post", "which the settings do not name now")
        stage.post.control("DELETE /faults")
        self.name_scoring(stage, programs.PORT)
        self.goes(stage, name)

    @staticmethod
    def name_scoring(stage, port):
        stage.box.save(lambda settings: settings["command_post"]["scoring"].update(port=port))

    def test_the_count_of_reports_is_not_certain(self):
        stage = self.stage()
        wait_until(lambda: self.view(stage)["run"]["run_clock"] > 0, "the run to begin")
        stage.post.control("POST /other-sender")
        self.sees(stage, "run_unreliable", "ask", "command_post", "The reports' count is not certain",
                  "somebody else reports with this token")
        self.assertEqual(stage.box.ask("POST /adit/runs", body={})[0], 200)
        self.goes(stage, "run_unreliable")
