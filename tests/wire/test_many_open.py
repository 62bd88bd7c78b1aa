"""More open reports than the page lists: alarms, lights, counts and lists have all of them."""

import concurrent.futures

from alarming import WithAlarms
from programs import wait_until
from reporting import another, submit

LISTED = 200  # rows in the view
ALONE = 10  # reports with an alarm of their own
OPEN = LISTED + 30
CLIENTS = 6  # at once; an address may have eight connections


class ManyOpen(WithAlarms):
    def hold(self, numbers):
        """Posts reports, which are held. Their numbers are in the order of arrival."""
        with concurrent.futures.ThreadPoolExecutor(CLIENTS) as pool:
            answers = list(pool.map(lambda number: submit(self.stage_, another(number)).status_code, numbers))
        self.assertEqual(set(answers), {503})

    def listed(self):
        return [row["number"] for row in self.view(self.stage_)["reports"]]

    def calling(self):
        return {alarm["id"]: alarm["what"] for alarm in self.view(self.stage_)["alarms"]}

    def calls_for(self, first, held):
        """Each of the oldest reports has an alarm; the others share one. `first`: the oldest number."""
        alone = {f"report_held:{number}": f"Report {number} is held" for number in range(first, first + ALONE)}
        self.assertEqual(self.calling(), {**alone, "report_held:more": f"{held - ALONE} more reports are held"})
        self.assertIn(f'adit_reports{{state="held"}} {held}\n', self.metrics(self.stage_))
        wait_until(lambda: self.light(self.stage_) == "fast", "the attention light")

    def withdraw(self, *numbers):
        for number in numbers:
            self.assertEqual(self.stage_.box.judge(number, "withdraw")[0], 200)

    def test_all_call_and_count(self):
        self.stage_ = self.stage(reports__review="all", reports__answer_within_ms=100)
        self.hold(range(OPEN))
        self.calls_for(1, OPEN)
        self.assertEqual(self.listed(), list(range(OPEN, OPEN - LISTED, -1)))
        self.assertEqual([row["state"] for row in self.stage_.box.reports()], ["held"] * OPEN)
        text, status = self.status(self.stage_)
        self.assertEqual(status, 1)
        self.assertIn(f"{LISTED} held (of the last {LISTED})", text)

        self.withdraw(1, OPEN)  # one that is not listed, one that is
        self.calls_for(2, OPEN - 2)
        self.assertEqual(self.listed(), list(range(OPEN - 1, OPEN - LISTED - 1, -1)))

        self.withdraw(*range(2, OPEN - 1))
        self.assertEqual(self.calling(), {f"report_held:{OPEN - 1}": f"Report {OPEN - 1} is held"})
        self.assertEqual(self.listed(), list(range(OPEN, OPEN - LISTED, -1)), "the newest others")
