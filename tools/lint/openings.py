#!/usr/bin/env python3
"""Checks that documentation comments begin as sentences or names do, not in the middle of one.

A comment of a header that opens with a preposition or with "The same" makes its reader look for the
subject elsewhere. Prints each line that offends; the exit status is 1 when there is one.
"""

import re
import sys

from checkout import parse_root, report

OPENING = re.compile(
    r"(?:/\*\*|///<) (?:Of|To|With|By|For|In|After|From|At|As|On|Until|And|Or|Else|Without|Before|Behind|Between|Through"
    r"|Over|Under|Like|The same)\b"
)
FOLDERS = ("src", "fuzz", "python", "include", "bench", "products")


def find_openings(folder):
    for path in sorted(folder.rglob("*.h")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := OPENING.search(line):
                yield path, number, line[match.start():].strip()


def main():
    root = parse_root(__doc__)
    problems = [
        f"{path.relative_to(root)}:{line}: begins in the middle: {text}"
        for folder in FOLDERS
        for path, line, text in find_openings(root / folder)
    ]
    return report(problems, f"openings: none in the headers of {', '.join(FOLDERS)}")


if __name__ == "__main__":
    sys.exit(main())
