"""The power is cut again and again while reports are sent, on a disk that loses unflushed writes: no report is lost or sent twice."""

import os
import time

import boards
import hosts
import stage
from disk import dice
from insisting import Client, Operator, end, judge
from reporting import QUICK
from stage import Stage, Story, load_tests, note  # unittest looks for them here

BOARD = boards.PC if os.environ.get("ADIT_BOARD") == boards.PC.name else boards.QEMU_VIRT
CUTS = int(os.environ.get("ADIT_CUTS", "4"))
SEED = 20210924
FAULTS = {"reports:record-then-drop": 0.05, "reports:drop": 0.05, "reports:answer-after=0.3": 0.4, "status:drop": 0.02}
LIFE = (0.3, 4.0)  # seconds from a start to its cut
PATIENCES = (0.5, 1.0, 5.0)  # seconds after which each client hangs up and tries again


def setUpModule():
    hosts.needs_root()
    stage.skip_without(BOARD)


class PowerCuts(Story):
    @classmethod
    def setUpClass(cls):
        options = ["--rate", "0", "--reports", "100000", "--seed", str(SEED)]
        for fault, rate in FAULTS.items():
            options += ["--fault-rate", f"{fault}={rate}"]
        cls.tell(
            Stage(
                board=BOARD,
                post_options=options,
                **{**QUICK, "command_post__timeouts__scoring_answer_ms": 1500, "reports__doubt_for_ms": 1000},
            )
        )
        cls.chance = dice(SEED)

    def test_box_starts_after_a_cut_in_the_first_start(self):
        lost = 0
        for after in (4.0, 8.0):
            self.box.power_on()
            time.sleep(after)
            lost += self.box.cut_power(self.chance)
        note("writes lost by cuts in the first start", lost)
        self.stage.start().began()

    def test_no_report_is_lost_or_doubled_by_cuts(self):
        operator, lost, starts = Operator(self.stage), 0, []
        clients = [
            Client(self.stage, number, patience, pause=0.1, life=lambda: self.box.cuts)
            for number, patience in enumerate(PATIENCES, 1)
        ]
        for client in clients:
            client.start()
        for number in range(1, CUTS + 1):
            time.sleep(self.chance.uniform(*LIFE))
            lost += self.box.cut_power(self.chance)
            self.stage.start()
            starts.append(self.box.cpu_seconds())
            if number % 4 == 0:
                self.stage.began()
                self.box.wait_until(lambda: operator.looks() or True, "the operator to be answered")
        self.stage.began()
        self.box.wait_until(lambda: len(self.stage.post.recorded()) > CUTS, "reports to be recorded", 300)
        end(clients)
        self.stage.post.control("DELETE /faults")
        self.box.wait_until(operator.sees_all_at_rest, "all to come to rest", 180)
        self.assertEqual([client.odd for client in clients], [[]] * len(clients), "what no client should be told")
        posted = [each for client in clients for each in client.posted]
        recorded, waiting = judge(self, self.stage, operator, posted, cuts=True)
        note(
            f"{BOARD.name}, {CUTS} power cuts",
            f"{lost} writes lost, {len(posted)} reports posted, {recorded.total()} recorded, 0 doubled, "
            f"{waiting} wait for the operator, {len(operator.judged)} judged by him; "
            f"starts of {min(starts):.1f} to {max(starts):.1f} s of the host's processors",
        )

    def test_critical_journal_records_survive_a_cut(self):
        """Critical records are on the disk at once, others after some seconds (journald.conf.d), here after an hour. journalctl shows
        a record before it is on the disk, so the test checks the disk's writes."""
        count, mark = "journalctl --list-boots -q --no-pager | wc -l", "Here it was"
        console = self.journal_on_disk()
        kept = int(console.ask(count))
        console.ask("mkdir /run/systemd/journald.conf.d; printf '[Journal]\\nSyncIntervalSec=1h\\n' >/run/systemd/journald.conf.d/test.conf; "
                    "echo 0 >/proc/sys/vm/dirty_writeback_centisecs; systemctl restart systemd-journald.service")

        def is_flushed():
            """One after the other: journald skips the sync if a record of another level follows before the sync has begun."""
            console.ask(f"echo {mark} {time.monotonic()} | systemd-cat -p crit")
            return self.box.disk.has_flushed(mark.encode())

        self.box.wait_until(is_flushed, "a critical record to be on the disk")
        self.box.cut_power(self.chance)
        self.stage.start()
        console = self.journal_on_disk()
        console.ask(f"journalctl -q --no-pager | grep '{mark}'")
        self.assertGreaterEqual(int(console.ask(count)), kept)

    def journal_on_disk(self):
        """The console, once journald writes to the state partition instead of memory. It first renames files that it finds there."""
        console = self.box.console
        console.wait_for_shell()
        is_flushed = "systemctl is-active systemd-journal-flush.service"
        self.box.wait_until(lambda: console.run(is_flushed)[0] == 0, "the journal to be on the disk")
        return console
