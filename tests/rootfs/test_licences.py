"""What Debian's packages say of their licences becomes an SPDX expression, or none at all."""
import sys
import unittest

from recipe import TOP

sys.path.insert(0, str(TOP / "rootfs"))
from licences import Licences, identifier  # noqa: E402

HEAD = "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\n"


class Expressions(unittest.TestCase):
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
        self.assertEqual(Licences().expression(text), "MIT AND GPL-2.0-or-later")

    def test_choice_stays_a_choice(self):
        self.assertEqual(Licences().expression(HEAD + "Files: *\nLicense: GPL-2 or Expat\n"), "(GPL-2.0-only OR MIT)")

    def test_an_unknown_licence_comes_with_its_text(self):
        licences = Licences()
        text = HEAD + "Files: *\nLicense: Beer ware\n\nLicense: Beer ware\n Buy me one.\n"
        self.assertEqual(licences.expression(text), "LicenseRef-debian-Beer-ware")
        self.assertIn("Buy me one.", licences.extracted["LicenseRef-debian-Beer-ware"]["extractedText"])

    def test_prose_is_not_interpreted(self):
        self.assertEqual(Licences().expression("This is free software; see the GPL.\n"), "NOASSERTION")
        self.assertEqual(Licences().expression(""), "NOASSERTION")
