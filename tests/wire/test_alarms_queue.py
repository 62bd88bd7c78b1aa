"""The alarm of a queue of maps that grows, which takes most of a minute; test_alarms_full.py has those of one that is full."""

import time

from alarming import WithAlarms
from programs import wait_until


class Queue(WithAlarms):
    def test_the_queue_is_growing(self):
        stage = self.stage(queues__map_bytes=8 << 20, command_post__budget_mbit=0.1)
        end, seed = time.monotonic() + 120, 0
        while not self.alarm(stage, "queue_growing"):
            seed += 1
            self.assertLess(time.monotonic(), end)
            self.send_map(stage, f"r{seed}", seed, 12000)
            wait_until(lambda at=time.monotonic(): time.monotonic() - at > 3 or self.alarm(stage, "queue_growing"), "the next one's time")
        self.sees(stage, "queue_growing", "wait", "network", "The map queue is growing", "more comes in than goes out")
        stage.box.save(lambda settings: settings["command_post"].update(budget_mbit=100))
        self.goes(stage, "queue_growing", 120)
