#!/usr/bin/env python3
"""Checks that the walk-throughs (docs/add_a_*.md) name only what there is.

Each name in CamelCase in code of such a page has to occur in src/, to be defined by the page, or to contain the name of the page's
example, which the page introduces by "The example is". Each file that it names in the checkout has to be there, or to have the
example's name. Prints each line that offends; exit status 1 when there is one.
"""

import re
import sys

from checkout import parse_root, report

EXAMPLE = re.compile(r"[Tt]he example is [`*](\w+)[`*]")
BLOCK = re.compile(r"^( *)```cpp\n(.*?)^ *```$", re.DOTALL | re.MULTILINE)
QUOTED = re.compile(r"`([^`\n]+)`")
TEXT = re.compile(r'R?"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/|\bTEST\w*\([^)]*\)', re.DOTALL)
NAME = re.compile(r"\b[A-Z][a-z0-9]+(?:[A-Z][a-z0-9]*)*\b")
DEFINITION = re.compile(r"^\s*(?!return\b)(?:[\w:<>,&*\[\]]+ )+[&*]?(\w+)[({]|\b(?:class|struct|enum|using) (\w+)", re.MULTILINE)
FILE = re.compile(r"(?:src|data|tools|web|docs|products|examples)/[\w./*-]+")
SOURCES = (".h", ".cc", ".inc")


def blank(match):
    """As many lines, with nothing in them."""
    return re.sub(r"[^\n]", " ", match.group())


def collect_words(root):
    """All identifiers of the sources and tests."""
    words = set()
    for path in (root / "src").rglob("*"):
        if path.suffix in SOURCES:
            words.update(re.findall(r"\w+", path.read_text(errors="replace")))
    return words


def find_code(text):
    """Line and text of each block of C++, without its texts, comments and names of tests, and of each quoted word
    outside of blocks."""
    for match in BLOCK.finditer(text):
        yield text.count("\n", 0, match.start(2)) + 1, TEXT.sub(blank, match.group(2))
    outside = re.sub(r"^( *)```.*?^ *```$", blank, text, flags=re.DOTALL | re.MULTILINE)
    for match in QUOTED.finditer(outside):
        if not re.search(r"[\s\"']", match.group(1)):
            yield text.count("\n", 0, match.start()) + 1, match.group(1)


def check_page(root, name, text, words):
    introduced = EXAMPLE.search(text)
    if not introduced:
        yield f"{name}: the page does not say what its example is"
        return
    example = introduced.group(1).replace("_", "").lower()
    defined = {word for block in BLOCK.finditer(text) for pair in DEFINITION.findall(block.group(2)) for word in pair}
    known = words | defined
    for line, code in find_code(text):
        for word in NAME.finditer(code):
            if word.group() not in known and example not in word.group().lower():
                yield f"{name}:{line + code.count(chr(10), 0, word.start())}: {word.group()} is not in src/"
        for path in FILE.findall(code if code.count("\n") == 0 else ""):
            if not list(root.glob(path)) and introduced.group(1) not in path:
                yield f"{name}:{line}: {path} is not there"


def check(root):
    words = collect_words(root)
    for page in sorted((root / "docs").glob("add_a_*.md")):
        yield from check_page(root, f"docs/{page.name}", page.read_text(), words)


def main():
    root = parse_root(__doc__)
    return report(list(check(root)), "walkthroughs: all names and files are there")


if __name__ == "__main__":
    sys.exit(main())
