"""Runs one module of tests, alone (../alone); exit status 77 where all of it was skipped, as ctest is told."""

import os
import pathlib
import signal
import sys
import unittest

if __name__ == "__main__":
    if "ADIT_ALONE" not in os.environ:
        os.execv(pathlib.Path(__file__).parents[1] / "alone", ["alone", sys.executable, "-B", *sys.argv])
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that what was made is taken away
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromName(sys.argv[1]))
    skipped_all = result.testsRun > 0 and len(result.skipped) >= result.testsRun
    nothing_ran = result.testsRun == 0 and bool(result.skipped)
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if skipped_all or nothing_ran else 0)
