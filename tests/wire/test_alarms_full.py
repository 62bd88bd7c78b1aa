"""Alarms of a queue of maps that is full: for a minute after the last map that was refused."""

import unittest

from alarming import WithAlarms
from programs import wait_until


class Full(WithAlarms):
    def fill(self, stage, name, most):
        """Maps of one robot after the other, until that alarm is there."""
        for seed in range(1, most):
            if self.alarm(stage, name):
                return
            self.send_map(stage, f"r{seed}", seed, 12000)
        wait_until(lambda: self.alarm(stage, name), name)

    def test_the_queue_is_nearly_full_and_then_full(self):
        stage = self.stage(queues__map_bytes=1 << 20, command_post__budget_mbit=0.1)
        self.fill(stage, "queue_nearly_full", 8)
        self.sees(stage, "queue_nearly_full", "bad", "network", "The map queue is nearly full", "1 MB wait at most")
        self.fill(stage, "queue_full", 100)
        self.sees(stage, "queue_full", "bad", "network", "The queue is full", "cloud")
        stage.box.save(lambda settings: settings["command_post"].update(budget_mbit=100))
        self.goes(stage, "queue_nearly_full", 120)
        self.goes(stage, "queue_full", 120)


if __name__ == "__main__":
    unittest.main()
