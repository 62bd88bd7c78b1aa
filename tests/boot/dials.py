"""Helpers of stories about the box's time of day."""

import time


class Dials:
    """Mixin of stage.Story. `ahead`: seconds ahead of this machine's clock."""

    def clock(self):
        return self.box.ask("GET /adit/clock")[1]

    def source_is(self, source, within=240):
        """Waits. An emulated adit-clock needs ten seconds of its processor."""
        told = []

        def is_so():
            told[:] = [self.clock()]
            return told[0]["source"] == source

        try:
            self.box.wait_until(is_so, f"the clock to be set by {source}", within)
        except AssertionError as error:
            raise AssertionError(f"{told}: {error}") from None

    def system_now(self):
        return float(self.box.console.ask("busybox date +%s"))

    def assert_close(self, seconds, ahead, told=""):
        """Checks that the time is this machine's plus `ahead` seconds."""
        self.assertAlmostEqual(seconds, time.time() + ahead, delta=30, msg=told)

    def operator_sets_it(self, ahead):
        """Sets the clock, and the chip if the box has one."""
        self.assertEqual(self.box.ask("POST /adit/clock", body={"time": time.time() + ahead})[0], 200)
        self.box.wait_until(lambda: abs(self.clock()["now"] - time.time() - ahead) < 30, "it to be set", 240)
        self.source_is("operator")
        self.assert_close(self.system_now(), ahead)
        chip = float(self.box.console.ask("cat /sys/class/rtc/rtc0/since_epoch"))
        self.assert_close(chip, ahead, "the chip is set, too")
