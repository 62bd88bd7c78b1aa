"""Alarms of a queue of maps that is full: for a minute after the last map that was refused."""


from alarming import WithAlarms


class Full(WithAlarms):
    def test_the_queue_is_full(self):
        stage = self.stage(queues__map_bytes=1 << 20)
        stage.post.will(mapping=["429,for=600"])  # so that nothing leaves, however long it is looked at
        for seed in range(1, 100):  # so small that without the two that are in flight it is nearly full still
            if self.send_map(stage, f"r{seed}", seed, 3000).status_code == 429:
                break
        self.sees(stage, "queue_full", "bad", "network", "The queue is full", "cloud")
        self.sees(stage, "queue_nearly_full", "bad", "network", "The map queue is nearly full", "1 MB wait at most")
        stage.post.control("DELETE /faults")
        self.goes(stage, "queue_nearly_full", 120)
        self.goes(stage, "queue_full", 120)
