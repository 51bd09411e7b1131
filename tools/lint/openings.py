#!/usr/bin/env python3
"""Checks that documentation comments begin as sentences or names do, not in the middle of one.

A comment of a header that opens with a preposition or with "The same" makes its reader look for the
subject elsewhere. Rooms in PENDING have as many such comments as stated there and may not get more;
a change that removes some lowers the number. Prints each line that offends; the exit status is 1
when there is one.
"""

import re
import sys

from checkout import parse_root, report

OPENING = re.compile(
    r"(?:/\*\*|///<) (?:Of|To|With|By|For|In|After|From|At|As|On|Until|And|Or|Else|Without|Before|Behind|Between|Through"
    r"|Over|Under|Like|The same)\b"
)
PENDING = {}


def find_openings(folder):
    for path in sorted(folder.rglob("*.h")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := OPENING.search(line):
                yield path, number, line[match.start():].strip()


def main():
    root = parse_root(__doc__)
    problems = []
    for room in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        found = [f"{path.relative_to(root)}:{line}: begins in the middle: {text}" for path, line, text in find_openings(room)]
        allowed = PENDING.get(room.name, 0)
        if len(found) > allowed:
            problems += [*found, f"src/{room.name} has {len(found)} such comments and may have {allowed}"]
        elif len(found) < allowed:
            problems.append(f"src/{room.name} has {len(found)} such comments left: lower the {allowed} in PENDING")
    return report(problems, f"openings: {sum(PENDING.values())} in {len(PENDING)} rooms, none in the others")


if __name__ == "__main__":
    sys.exit(main())
