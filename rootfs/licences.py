"""Reads what a Debian package says of its licences (DEP-5) as an SPDX expression."""
import re

SPDX = {"expat": "MIT", "mit": "MIT", "isc": "ISC", "zlib": "Zlib", "apache-2.0": "Apache-2.0", "bsd-2-clause": "BSD-2-Clause",
        "bsd-3-clause": "BSD-3-Clause", "bsd-4-clause": "BSD-4-Clause", "cc0": "CC0-1.0", "cc0-1.0": "CC0-1.0", "mpl-2.0": "MPL-2.0",
        "openssl": "OpenSSL", "boehm-gc": "Boehm-GC", "unlicense": "Unlicense", "curl": "curl"}


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
                fields[name] += "\n" + line.strip()
            elif match := re.match(r"([A-Za-z-]+):\s*(.*)", line):
                name = match[1].lower()
                fields[name] = match[2]
        yield fields


class Licences:
    """The expressions of many packages, and the texts of the licences in them that SPDX does not know."""

    def __init__(self) -> None:
        self.extracted: dict[str, dict[str, str]] = {}

    def reference(self, name: str, text: str) -> str:
        ref = "LicenseRef-debian-" + re.sub(r"[^A-Za-z0-9.-]+", "-", name.strip()).strip("-")
        known = self.extracted.setdefault(ref, {"licenseId": ref, "name": name.strip(), "extractedText": ""})
        known["extractedText"] = known["extractedText"] or text.strip()
        return ref

    def expression(self, copyright_text: str) -> str:
        """NOASSERTION for a file that is prose."""
        if not re.match(r"\s*Format(-Specification)?:", copyright_text):
            return "NOASSERTION"
        parts = list(stanzas(copyright_text))
        texts = {p["license"].split("\n")[0].strip(): p["license"] for p in parts if "license" in p and "files" not in p}
        names = sorted({p["license"].split("\n")[0].strip().rstrip(",") for p in parts if "license" in p and "files" in p} - {""})
        return " AND ".join(dict.fromkeys(self.term(name, texts) for name in names)) or "NOASSERTION"

    def term(self, name: str, texts: dict[str, str]) -> str:
        choices = re.split(r"\s*,?\s+(?:or|\|)\s+", name)
        terms = []
        for choice in choices:
            ands = [self.one(each, texts) for each in re.split(r"\s*,?\s+and\s+", choice)]
            terms.append(" AND ".join(ands) if len(ands) == 1 or len(choices) == 1 else f"({' AND '.join(ands)})")
        return terms[0] if len(terms) == 1 else f"({' OR '.join(terms)})"

    def one(self, name: str, texts: dict[str, str]) -> str:
        return identifier(name) or self.reference(name, texts.get(name, name))
