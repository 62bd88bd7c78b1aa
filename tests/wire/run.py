"""Runs a module of tests: run.py [DIRECTORY/]MODULE[.CLASS] [ARGUMENTS]. Prints the reason of each skipped test ("... skipped
'reason'"). Exits with 77 if all tests were skipped, which ctest expects, and with 1 if there are none."""

import os
import pathlib
import signal
import sys
import unittest

if __name__ == "__main__":
    module = pathlib.Path(sys.argv[1]).absolute()
    if module.parent.name == "wire" and "ADIT_ALONE" not in os.environ:
        os.execv(pathlib.Path(__file__).parents[1] / "alone", ["alone", sys.executable, "-B", *sys.argv])
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that what was made is taken away
    del sys.argv[0]  # the module reads its arguments as a program does
    sys.path[:0] = [str(module.parent), str(pathlib.Path(__file__).parents[1])]
    result = unittest.TextTestRunner(verbosity=2).run(unittest.defaultTestLoader.loadTestsFromName(module.name))
    ran = result.testsRun - sum(isinstance(test, unittest.TestCase) for test, _ in result.skipped)  # a class's is in neither
    if not result.wasSuccessful() or not (ran or result.skipped):
        sys.exit(1)
    sys.exit(0 if ran else 77)
