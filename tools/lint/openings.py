#!/usr/bin/env python3
"""Checks that documentation comments begin as sentences or names do, not in the middle of one.

A comment of a header that opens with a preposition or with "The same" makes its reader look for the
subject elsewhere. Rooms in PENDING have such comments still; whoever works on one clears it and takes
it off the list. Prints each line that offends; exit status 1 when there is one.
"""

import argparse
import pathlib
import re
import sys

OPENING = re.compile(
    r"(?:/\*\*|///<) (?:Of|To|With|By|For|In|After|From|At|As|On|Until|And|Or|Else|Without|Before|Behind|Between|Through"
    r"|Over|Under|Like|The same)\b"
)
PENDING = ("haptics", "simulation", "studio", "study")


def find_openings(folder):
    for path in sorted(folder.rglob("*.h")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if match := OPENING.search(line):
                yield path, number, line[match.start():].strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    root = parser.parse_args().root
    count, pending = 0, 0
    for room in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        found = list(find_openings(room))
        if room.name in PENDING:
            pending += len(found)
            if not found:
                print(f"openings: src/{room.name} is clear: take it off PENDING")
                count += 1
            continue
        for path, number, comment in found:
            print(f"{path.relative_to(root)}:{number}: the comment begins in the middle: {comment}")
            count += 1
    print(f"openings: {count} in rooms that are clear, {pending} in {len(PENDING)} others")
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
