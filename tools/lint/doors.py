#!/usr/bin/env python3
"""Checks that what strangers have made is read through the functions that limit it.

Some calls of libraries do harm where a file, message or field of a stranger is their input. Each of them stands in one place, which
checks the input first; the same call elsewhere is printed, and the exit status is 1.
"""

import re
import sys
from typing import NamedTuple

from checkout import parse_root, report


class Door(NamedTuple):
    call: re.Pattern
    places: tuple  # Files that may have the call.
    instead: str


DOORS = (
    Door(re.compile(r"\b(?:ordered_)?json::parse\(|\bJson::parse\("),
         ("src/base/parse_json.h",  # Checks the depth.
          "src/mates/located_json.cc",  # Scans lines and depth first.
          "src/studio/json_fields.cc"),  # Counts fields, after the check of the depth.
         "ParseJson (base/parse_json.h): copying JSON that is nested deeply overflows the stack"),
)


def find_calls(root):
    for path in sorted((root / "src").rglob("*")):
        name = str(path.relative_to(root))
        if path.suffix not in (".cc", ".h") or "/test/" in name:
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            for door in DOORS:
                if door.call.search(line) and name not in door.places:
                    yield f"{name}:{number}: call {door.instead}"


def main():
    root = parse_root(__doc__)
    return report(list(find_calls(root)), f"doors: {len(DOORS)} calls are where their input is checked")


if __name__ == "__main__":
    sys.exit(main())
