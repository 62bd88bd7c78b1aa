"""The copyright files of Debian's packages become SPDX expressions, with the texts of licences that SPDX does not know."""
import sys
import unittest

from recipe import TOP

sys.path.insert(0, str(TOP / "rootfs"))
from licences import Licences, identifier  # noqa: E402

HEAD = "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\n"
TEXT = "Permission is granted to use this file for each purpose."


class Expressions(unittest.TestCase):
    def setUp(self):
        self.licences = Licences()

    def texts(self):
        return {ref: licence["extractedText"] for ref, licence in self.licences.extracted.items()}

    def test_short_names_of_debian_become_those_of_spdx(self):
        for debian, spdx in {"GPL-2+": "GPL-2.0-or-later", "GPL-2": "GPL-2.0-only", "LGPL-2.1+": "LGPL-2.1-or-later", "GPL-3.0+": "GPL-3.0-or-later",
                             "Expat": "MIT", "BSD-3-clause": "BSD-3-Clause", "Zlib": "Zlib", "Apache-2.0": "Apache-2.0"}.items():
            with self.subTest(debian):
                self.assertEqual(identifier(debian), spdx)

    def test_unknown_names_are_not_spdx_names(self):
        for name in "GPL", "public-domain", "GPL-2+ with OpenSSL exception", "":
            with self.subTest(name):
                self.assertIsNone(identifier(name))

    def test_licences_of_a_package_are_joined_once_each(self):
        text = HEAD + "Files: *\nLicense: GPL-2+\n\nFiles: lib/*\nLicense: Expat\n\nFiles: doc/*\nLicense: MIT\n"
        self.assertEqual(self.licences.expression("x", text), "MIT AND GPL-2.0-or-later")
        self.licences.expression("y", HEAD + "Files: *\nLicense: ISC and Expat\n")
        self.assertEqual(self.licences.terms, {"ISC", "MIT", "GPL-2.0-or-later"})

    def test_a_choice_is_a_choice(self):
        self.assertEqual(self.licences.expression("x", HEAD + "Files: *\nLicense: GPL-2 or Expat\n"), "(GPL-2.0-only OR MIT)")
        self.assertEqual(self.licences.expression("x", HEAD + "Files: *\nLicense: GPL-2 or Expat and Zlib\n"), "(GPL-2.0-only OR (MIT AND Zlib))")

    def test_the_text_of_an_unknown_licence_is_found_wherever_the_file_has_it(self):
        whole = HEAD + f"Comment: {TEXT}\n\nFiles: *\nLicense: Free"
        for name, text, found in (("in a stanza of its own", HEAD + f"Files: *\nLicense: Free\n\nLicense: Free\n {TEXT}\n", TEXT),
                                  ("in that of the files", HEAD + f"Files: *\nLicense: Free\n {TEXT}\n", TEXT),
                                  ("in two of the files", HEAD + f"Files: *\nLicense: Free\n {TEXT}\n\nFiles: x\nLicense: Free\n .\n A{TEXT}\n", f"{TEXT}\n\nA{TEXT}"),
                                  ("in the first paragraph", HEAD.strip() + f"\nLicense: Free\n {TEXT}\n\nFiles: *\nLicense: Free\n", TEXT),
                                  ("under another spelling", HEAD + f"Files: *\nLicense: Free\n\nLicense: free,\n {TEXT}\n", TEXT),
                                  ("under the name of a choice", HEAD + f"Files: *\nLicense: GPL-2 or Free\n {TEXT}\n", TEXT),
                                  ("nowhere but in prose", whole, whole), ("as a name", whole + "\n Free.", whole + "\n Free.")):
            with self.subTest(name):
                self.setUp()
                self.assertIn("LicenseRef-debian-Free", self.licences.expression("x", text))
                self.assertEqual(self.texts(), {"LicenseRef-debian-Free": found})

    def test_other_texts_of_one_name_are_other_licences(self):
        text = HEAD + "Files: *\nLicense: Free\n {}\n"
        expressions = [self.licences.expression(package, text.format(words)) for package, words in (("x", TEXT), ("y", TEXT * 2), ("z", TEXT))]
        self.assertEqual(expressions, ["LicenseRef-debian-Free", "LicenseRef-debian-Free-text-2", "LicenseRef-debian-Free"])
        self.assertEqual(self.texts(), {"LicenseRef-debian-Free": TEXT, "LicenseRef-debian-Free-text-2": TEXT * 2})

    def test_a_file_that_is_prose_is_a_licence_as_a_whole(self):
        for text in ("This is free software; see the GPL.", "Most files are Expat's.\n\nFiles: x\nLicense: GPL-2",
                     HEAD.strip() + "\n\nLicense: GPL-2\n None of the files."):
            self.setUp()
            self.assertEqual(self.licences.expression("libx1", text + "\n"), "LicenseRef-debian-libx1")
            self.assertEqual(self.texts(), {"LicenseRef-debian-libx1": text})

    def test_a_package_without_a_copyright_file_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "libx1: no copyright file"):
            self.licences.expression("libx1", "\n")
