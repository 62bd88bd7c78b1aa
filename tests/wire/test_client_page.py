"""The pages for client authors (firmware/doors/intake/clients) are correct: the commands and the Python of README.md are run, its C++
is in the example, which test_clients.py runs, and each rejection of refusals.md is made. ADIT_WRITE=1 writes the rejections into that
page."""

import doctest
import os
import pathlib
import re
import subprocess
import sys
import unittest

import programs
import refused
from programs import Stage
from reporting import QUICK, began

SOURCE = pathlib.Path(os.environ["ADIT_SOURCE"])
SHOWN = SOURCE / "firmware/doors/intake/clients"
PAGE, REFUSALS = SHOWN / "README.md", SHOWN / "refusals.md"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)
# Parts that differ each time: time, duration, place.
VARIES = [(r"Date: [^\n]*", "Date:"), (r"Age: \d+", "Age:"), (r"Content-Length: \d+", "Content-Length:"),
          (r'"run_clock":[\d.]+', '"run_clock":'), (r'"submitted_datetime":"[^"]*"', '"submitted_datetime":')]

sys.path.insert(0, str(SHOWN))
sys.dont_write_bytecode = True


def same_each_time(text):
    for pattern, instead in VARIES:
        text = re.sub(pattern, instead, text.replace("\r", ""))
    return text.strip()


class ClientPage(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.text = PAGE.read_text()
        cls.blocks = BLOCK.findall(cls.text)

    def test_commands_and_python_lines_give_the_shown_answers(self):
        """In the page's order, on one stage, because each command continues from the ones before."""
        with Stage(**{**QUICK, "reports__answer_within_ms": 20000}) as stage:
            began(stage)
            names = {"ADIT": stage.box.url, "TOKEN": programs.TEAM_TOKEN}
            python, setting, run = dict(names), "", 0
            for (language, body), (_, answer) in zip(self.blocks, [*self.blocks[1:], ("", "")]):
                if language == "pycon":
                    self.is_said_by_python(body, python)
                elif language == "sh" and "ADIT=" in body:
                    setting = re.sub(r"^(ADIT|TOKEN)=.*\n", "", body, flags=re.M)
                elif language == "sh":
                    if "its answer is lost" in body:
                        stage.post.will("record-then-drop")
                    said = subprocess.run(["bash", "-c", setting + body], env={**os.environ, **names}, check=True,
                                          capture_output=True, text=True, timeout=60).stdout
                    self.assertEqual(same_each_time(said), same_each_time(answer), body)
                    run += 1
            self.assertGreaterEqual(run, 9)
            # The page reports it again on purpose.
            self.assertEqual(stage.post.violations(), [("/api/artifact_reports", ["the same report as report 2 of this run"])])

    def is_said_by_python(self, body, names):
        test = doctest.DocTestParser().get_doctest(body, names, "page", str(PAGE), 0)
        said = []
        result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=said.append, clear_globs=False)
        names.update(test.globs)
        self.assertEqual(result.failed, 0, "".join(said))

    def test_each_line_of_cpp_is_in_the_example(self):
        example = [line.strip() for line in (SHOWN / "example.cpp").read_text().splitlines()]
        lines = [line.strip() for language, body in self.blocks if language == "cpp" for line in body.splitlines()]
        self.assertGreater(len(lines), 10)
        self.assertEqual([line for line in lines if line not in example], [])

    def test_each_rejection_is_produced(self):
        text, tables = REFUSALS.read_text(), refused.table()
        start = text.index("\n| ") + 1  # the tables end the page
        if os.environ.get("ADIT_WRITE"):
            REFUSALS.write_text(text[:start] + tables)
        else:
            self.assertEqual(text[start:], tables)

    def test_other_rejections_are_in_the_code(self):
        code = "".join(path.read_text() for path in (SOURCE / "firmware").rglob("*.cpp"))
        code = re.sub(r'"\s*\n?\s*"', "", code)
        for _, _, sentence in refused.ELSEWHERE:
            for part in re.split("N |: |; ", sentence):  # numbers, and what the code puts together
                self.assertIn(part.strip(), code)
