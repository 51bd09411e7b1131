#!/usr/bin/env python3
"""Checks that codes of requirements, equations and citations in sources and documents lead somewhere.

A code as X9, W12 or N4 has to be a row of docs/requirements.md; an equation as X(9) or W(7) has to be
within the numbers that docs/references.md gives for that paper; a standard (ISO 286-1) and a paper
(Whitney, J. Dyn. Syst. 104, 1982) have to stand there. Each requirement of the papers needs a test whose
name begins with its code. Prints each line that offends; exit status 1 when there is one.
"""

import re
import subprocess
import sys

from checkout import parse_root, report

CODE = re.compile(r"(?<![\w-])([XWN])([1-9]\d?)(?![\w(-])")
EQUATION = re.compile(r"\b([XW])\((\d{1,2})\)")
STANDARD = re.compile(r"\b(ISO|DIN|ANSI|IEC|RFC|VDI|EN)[ -]((?:[A-Z]{1,2}[ -])?[A-Z]?\d[\d.]*)")
# The first author, and the year behind at most a journal and its volume.
PAPER = re.compile(r"\b([A-Z][a-z\u00e9\u00e1]+)(?:, [A-Z]\w+)*(?:\sand\s+[A-Z]\w+| et al\.?)?,\s[^;:()]{0,60}?(?:[,(] ?|\s)((?:19|20)\d\d)\b(?!-)")
# Where codes are told of: comments of sources, and documents but for what they quote in backticks.
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
QUOTED = re.compile(r"`[^`]*`")
ROW = re.compile(r"^\| ([XWN]\d+) \|")
TEST_NAME = re.compile(r"^TEST(?:_F|_P)?\(\s*\w+,\s*([XW]\d+)[A-Z]", re.MULTILINE)
SPAN = re.compile(r"^\| ([XW]) \|.*\| (\d+) to (\d+) \|")


def read_rows(requirements):
    return {match.group(1) for line in requirements.read_text().splitlines() if (match := ROW.match(line))}


def read_spans(references):
    """Numbers of the equations of each paper that has a letter."""
    spans = {}
    for line in references.read_text().splitlines():
        if match := SPAN.match(line):
            spans[match.group(1)] = range(int(match.group(2)), int(match.group(3)) + 1)
    return spans


def find_strays(path, rows, spans, references):
    """Line and fault of each code and citation that leads nowhere."""
    text = path.read_text(errors="replace")
    if path.suffix == ".md":
        passages = [(0, QUOTED.sub(lambda quote: " " * len(quote.group()), text))]
    else:
        passages = [(match.start(), match.group()) for match in COMMENT.finditer(text)]
    for start, passage in passages:
        checks = (
            (CODE, "docs/requirements.md", lambda m: m.group() in rows),
            (EQUATION, "docs/references.md", lambda m: int(m.group(2)) in spans.get(m.group(1), ())),
            (STANDARD, "docs/references.md", lambda m: f"{m.group(1)} {m.group(2).rstrip('.')}" in references),
            (PAPER, "docs/references.md", lambda m: re.search(rf"{m.group(1)}\b.*{m.group(2)}", references)),
        )
        for pattern, where, leads_there in checks:
            for match in pattern.finditer(passage):
                if not leads_there(match):
                    line = text.count("\n", 0, start + match.start()) + 1
                    yield line, f"{' '.join(match.group().split())} does not stand in {where}"


def list_untested(rows, sources):
    """Codes of the papers' requirements that begin no test's name."""
    tested = {code for source in sources for code in TEST_NAME.findall(source)}
    return sorted((row for row in rows if row[0] in "XW" and row not in tested), key=lambda row: (row[0], int(row[1:])))


def main():
    root = parse_root(__doc__)
    rows, spans = read_rows(root / "docs/requirements.md"), read_spans(root / "docs/references.md")
    references = (root / "docs/references.md").read_text()
    if not rows or not spans:
        return report(["docs/requirements.md or docs/references.md has no table"], "")
    globs = ["src/*.h", "src/*.cc", "products/*.h", "products/*.cc", "bench/*.cc", "docs/*.md", "README.md"]
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *globs]
    names = subprocess.run(command, check=True, capture_output=True, text=True, cwd=root).stdout.splitlines()
    problems = [
        f"{name}:{line}: {what}"
        for name in names
        if (root / name).is_file() and name != "docs/references.md"
        for line, what in find_strays(root / name, rows, spans, references)
    ]
    sources = [(root / name).read_text(errors="replace") for name in names if name.endswith("_test.cc")]
    problems += [f"{row} of docs/requirements.md begins no test's name" for row in list_untested(rows, sources)]
    return report(problems, f"codes: {len(rows)} requirements, {sum(map(len, spans.values()))} equations, no stray")


if __name__ == "__main__":
    sys.exit(main())
