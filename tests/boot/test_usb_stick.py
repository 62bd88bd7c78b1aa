"""A PC and its spare are one PC here: its export goes to a real USB stick of FAT, as sticks are bought, is pulled out at the moment of
the answer and in the midst of the writing, and is offered again. What another box does with it: wire/test_stick.py."""

import pathlib
import subprocess
import tempfile
import time

import boards
import hosts
import stage
from bundles import bundle_of_nothing
from reporting import REPORT
from stage import Stage, Story, load_tests  # unittest looks for them here


def setUpModule():
    hosts.needs_root()
    stage.skip_without(boards.PC)


def fat(folder, name, *files, size=64):
    """A stick's bytes: one partition with a FAT file system, of so many MiB."""
    image = folder / f"{name}.img"
    with open(image, "wb") as made:
        made.truncate((size + 2) << 20)
    subprocess.run(["sfdisk", "--quiet", image], input=f"size={size}MiB, type=c\n".encode(), check=True)
    subprocess.run(["mformat", "-i", f"{image}@@1M", "-T", str((size << 20) // 512), "::"], check=True)
    if files:
        subprocess.run(["mcopy", "-i", f"{image}@@1M", *files, "::"], check=True)
    return image


def names_on(image):
    said = subprocess.run(["mdir", "-b", "-i", f"{image}@@1M", "::"], check=True, capture_output=True, text=True).stdout
    return {line.removeprefix("::/") for line in said.split("\n") if line}


def read(image, name, to):
    subprocess.run(["mcopy", "-n", "-i", f"{image}@@1M", f"::{name}", to], check=True)
    return to.read_bytes()


class Sticks(Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage(board=boards.PC))
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="adit-sticks-")))

    def spare(self):
        return self.box.ask("GET /adit/spare")[1]

    def stick(self):
        return self.spare()["stick"]

    def post(self, path, body=None, status=200):
        got, said = self.box.ask(f"POST /adit/spare/{path}", body=body or {})
        self.assertEqual(got, status, said)
        return said

    def wait_for(self, condition, what):
        self.box.wait_until(lambda: condition(self.stick()), what, 180)
        return self.stick()

    def outcome(self):
        return self.wait_for(lambda said: not said["doing"] and (said["written"] or said["refusal"]), "the end of it")

    def test_it_reports_and_rests(self):
        self.stage.start().began()
        status, said = self.box.ask("POST /api/artifact_reports", body=REPORT, timeout=60)
        self.assertEqual(status, 201, said)
        self.box.wait_until(self.stick, "adit-spare to have told of itself")
        self.assertTrue(self.stick()["hindrance"], "there is no stick")
        self.post("rest")
        self.box.wait_until(lambda: self.spare()["code"], "the box to rest")
        self.post("to-stick", status=409)

    def test_a_stick_that_is_write_protected_is_told_of(self):
        self.box.plug_stick(fat(self.folder, "protected"), "protected")
        self.wait_for(lambda said: said["hindrance"] == "the stick is write-protected", "the protected stick to be found")
        self.box.pull_stick("protected")
        self.wait_for(lambda said: "no stick" in said["hindrance"], "it to be gone")

    def test_an_export_is_on_a_fat_stick_that_is_pulled_out_at_the_moment_of_the_answer(self):
        newer = bundle_of_nothing(self.folder, "9.9.9", boards.PC.name)
        image = fat(self.folder, "good", newer)
        type(self).good = image
        self.box.plug_stick(image, "good", writable=True)
        self.wait_for(lambda said: not said["hindrance"], "the stick to be found")
        self.box.wait_until(lambda: self.box.ask("GET /adit/update")[1]["stick_why"] or self.box.ask("GET /adit/update")[1]["stick"],
                            "the update on it to be looked at, too")
        self.post("to-stick")
        said = self.outcome()
        self.assertEqual(said["refusal"], "")
        self.box.pull_stick("good")
        name = said["written"]
        self.assertRegex(name, r"^adit-.*\.adit-spare$")
        type(self).name = name
        self.wait_for(lambda said: "no stick" in said["hindrance"], "it to be gone")
        self.assertEqual(names_on(image), {name, newer.name}, "the update is there still")
        self.assertEqual(read(image, name, self.folder / "read")[:12], b"adit-spare\x01\x00")

    def test_a_stick_that_is_pulled_out_amid_the_writing_is_told_of_and_has_no_half_export(self):
        image = fat(self.folder, "early")
        self.box.plug_stick(image, "early", writable=True, bytes_a_second=10_000)
        self.wait_for(lambda said: not said["hindrance"], "the stick to be found")
        self.post("to-stick")
        self.wait_for(lambda said: said["doing"] == "writing", "it to be written")
        self.box.wait_until(lambda: " rw," in self.box.console.ask("grep /run/adit-stick/ /proc/mounts || true"), "it to be writable")
        self.box.pull_stick("early")
        self.assertTrue(self.outcome()["refusal"])
        self.assertNotIn(self.name, names_on(image))

    def test_what_is_on_the_stick_is_offered_and_read(self):
        self.box.plug_stick(self.good, "again", writable=True)
        self.wait_for(lambda said: [each["name"] for each in said["exports"]] == [self.name], "the export to be offered")
        self.post("from-stick", {"name": self.name})
        self.box.wait_until(lambda: self.spare()["asks_code"], "it to be read")
        self.post("open", {"code": self.spare()["code"]}, status=409)  # it made the export itself
        self.post("forget")

    def test_one_with_a_loose_plug_is_offered_again_once_it_stays(self):
        self.box.pull_stick("again")
        for turn in range(8):
            self.box.plug_stick(self.good, f"loose{turn}", writable=True)
            time.sleep(0.2 * turn)
            self.box.pull_stick(f"loose{turn}")
        self.box.plug_stick(self.good, "firm", writable=True)
        self.wait_for(lambda said: [each["name"] for each in said["exports"]] == [self.name] and not said["hindrance"],
                      "the export to be offered")
