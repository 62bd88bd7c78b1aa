"""Reads the copyright file of a Debian package (DEP-5, or prose) as an SPDX expression."""
import itertools
import re

SPDX = {"expat": "MIT", "mit": "MIT", "isc": "ISC", "zlib": "Zlib", "apache-2.0": "Apache-2.0", "bsd-2-clause": "BSD-2-Clause",
        "bsd-3-clause": "BSD-3-Clause", "bsd-4-clause": "BSD-4-Clause", "cc0": "CC0-1.0", "cc0-1.0": "CC0-1.0", "mpl-2.0": "MPL-2.0",
        "openssl": "OpenSSL", "artistic": "Artistic-1.0-Perl", "boehm-gc": "Boehm-GC", "unlicense": "Unlicense", "curl": "curl"}

LEAST_TEXT = 50  # characters; a shorter one is a name or a pointer: "Public domain.", "See the note above."


def identifier(name: str) -> str | None:
    """The SPDX name of one of Debian's short names, if SPDX has it: GPL-2+ is GPL-2.0-or-later."""
    name = name.strip().lower().removesuffix(" license")
    if match := re.fullmatch(r"(gpl|lgpl|agpl|gfdl)-?v?([0-9.]+)(\+|-only|-or-later)?", name):
        family, number, more = match.groups()
        number = number if "." in number else number + ".0"
        if family == "gfdl":
            number = {"1.2.0": "1.2", "1.3.0": "1.3"}.get(number, number)
        return f"{family.upper()}-{number}-{'or-later' if more in ('+', '-or-later') else 'only'}"
    return SPDX.get(name)


def stanzas(text: str):
    for block in re.split(r"\n\s*\n", text):
        fields: dict[str, str] = {}
        name = None
        for line in block.splitlines():
            if line[:1] in " \t" and name:
                fields[name] += "\n" + line.strip().removeprefix(".")
            elif match := re.match(r"([A-Za-z-]+):\s*(.*)", line):
                name = match[1].lower()
                fields[name] = match[2]
        yield fields


class Licences:
    """The expressions of many packages, and the texts of the licences in them that SPDX does not know."""

    def __init__(self) -> None:
        self.extracted: dict[str, dict[str, str]] = {}
        self.terms: set[str] = set()  # of all expressions

    def reference(self, name: str, text: str) -> str:
        """Another text of the same name has a reference of its own."""
        base = "LicenseRef-debian-" + re.sub(r"[^A-Za-z0-9.-]+", "-", name).strip("-")
        for ref in itertools.chain([base], (f"{base}-text-{number}" for number in itertools.count(2))):
            licence = {"licenseId": ref, "name": name, "extractedText": text}
            if self.extracted.setdefault(ref, licence) == licence:
                return ref

    def expression(self, package: str, copyright_text: str) -> str:
        """Of a package's copyright file. If the file is prose, the whole file is the text of one licence."""
        whole = copyright_text.strip()
        if not whole:
            raise ValueError(f"{package}: no copyright file")
        parts = list(stanzas(whole)) if re.match(r"Format(-Specification)?:", whole) else []
        texts: dict[str, dict[str, None]] = {}  # by name, without repetition
        for part in parts:
            name, _, text = part.get("license", "").partition("\n")
            texts.setdefault(self.key(name), {})[text.strip()] = None
        names = sorted({part["license"].split("\n")[0].strip().rstrip(",") for part in parts if "license" in part and "files" in part} - {""})

        def text_of(*names: str) -> str:
            """The first text that says more than a name does, or the whole file."""
            found = ("\n\n".join(texts.get(self.key(name), ())).strip() for name in names)
            return next((text for text in found if len(text) >= LEAST_TEXT), whole)

        terms = [term for name in names for term in self.terms_of(name, text_of)] or [self.reference(package, whole)]
        self.terms.update(terms)
        return " AND ".join(dict.fromkeys(terms))

    def terms_of(self, name: str, text_of) -> list[str]:
        """Of one name of a copyright file, such as "GPL-2+ or Expat". All of the terms hold."""
        choices = [[identifier(one) or self.reference(one.strip(), text_of(one, name)) for one in re.split(r"\s*,?\s+and\s+", choice)]
                   for choice in re.split(r"\s*,?\s+(?:or|\|)\s+", name)]
        if len(choices) == 1:
            return choices[0]
        return ["(" + " OR ".join(ands[0] if len(ands) == 1 else "(" + " AND ".join(ands) + ")" for ands in choices) + ")"]

    @staticmethod
    def key(name: str) -> str:
        """Of a licence's name, however it is spelt."""
        return " ".join(name.lower().replace("_", "-").rstrip(", ").split())
