"""The project's documents, *.md, and their contents: links, headings, code."""
import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
MADE = {".git", "build", "node_modules"}  # nobody wrote what is in these
FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.S | re.M)
CODE = re.compile(r"(`+)([^\n]+?)\1")
LINK = re.compile(r"\[(?:[^][]|\[[^][]*\])*\]\(([^()\s]*(?:\([^()\s]*\))?)\)")
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$", re.M)


def documents():
    """Skips build directories, because other tests change them meanwhile."""
    found = []
    for folder, folders, files in os.walk(ROOT):
        folders[:] = set(folders) - MADE
        found += (pathlib.Path(folder, name) for name in files if name.endswith(".md"))
    return sorted(found)


def without_blocks(text):
    return FENCE.sub("", text)


def blocks(text, language=None):
    """The text of code blocks, of one language or of all."""
    return [body for named, body in FENCE.findall(text) if language is None or named == language]


def spans(text):
    """The text in backticks within lines."""
    return [span.strip() for _, span in CODE.findall(without_blocks(text))]


def links(text):
    return LINK.findall(CODE.sub("", without_blocks(text)))


def anchors(text):
    """The anchors of a document's headings, as on GitHub and Gitea."""
    names = []
    for heading in HEADING.findall(without_blocks(text)):
        shown = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
        name = re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")
        before = sum(each == name or re.fullmatch(re.escape(name) + r"-\d+", each) is not None for each in names)
        names.append(f"{name}-{before}" if before else name)
    return set(names)
