#!/usr/bin/env python3
"""Checks that numbers with a name say what they are for and where they come from.

Looked at in src/, but for tests: constants (kName) of an arithmetic type, of a duration or of an array of
such, and the defaults other than nothing of the members of structs that are options or limits. A comment stands
on the line, or above the line, or above the block of constants that the line belongs to; one of a constant says more
than its unit. Limits of a type
(`std::numeric_limits`) need none. Prints each line that offends; exit status 1 when there is one.
"""

import re
import sys

from checkout import list_sources, parse_root, report

NUMBER = (
    r"(?:double|float|int|unsigned(?: (?:int|long|char))?|long|(?:std::)?(?:size_t|ptrdiff_t|u?int(?:max|ptr|\d+)_t)"
    r"|std::chrono::\w+(?:<[^;={]*>)?|auto)"
)
ARRAY = rf"std::array<{NUMBER}(?:, [^<>]+)?>"
CONSTANT = re.compile(
    rf"\s*(?=[^=;{{(]*\bconst)(?:(?:inline|static|constexpr|const) )+(?:{NUMBER}|{ARRAY})(?: const)? (k[A-Z]\w*)(?:\[[^\]]*\])*\s*(=|{{|$)"
)
STRUCT = re.compile(r"\s*struct (\w*(?:Options|Limits|Gains|Skill|Settings|Profile))\b[^;]*\{")
MEMBER = re.compile(rf"\s*{NUMBER} (\w+)(?:\{{(.+?)\}}| = (.+?));")
# Zero, and what has its comment where it is named.
NOTHING = re.compile(r"-?0+\.?0*|std::numeric_limits<.*|k[A-Z]\w*")
SELF_EVIDENT = re.compile(r"(?:=|\{)\s*std::numeric_limits<[^;]*;")
COMMENT = re.compile(r"(?://|/\*)(.*)")
UNIT = re.compile(r"\[[^\]]*\]|[^\w]")


def find_bare(lines):
    """Number and text of each line that names a number without a comment."""
    is_explained, struct, within = False, None, False
    for index, line in enumerate(lines):
        stripped = line.strip()
        if within:  # A comment that goes on.
            within = "*/" not in line
            continue
        if stripped.startswith(("//", "/*")):
            is_explained, within = True, stripped.startswith("/*") and "*/" not in line
            continue
        if match := STRUCT.match(line):
            struct, is_explained = len(line) - len(line.lstrip()), False
            continue
        if struct is not None and stripped.startswith("}") and len(line) - len(line.lstrip()) <= struct:
            struct = None
        constant = CONSTANT.match(line)
        member = None if constant or struct is None else MEMBER.match(line)
        if not constant and not member:
            # The rest of a declaration that goes on, or the end of what the comment was for.
            is_explained = is_explained and not re.search(r"(?:[{}]|^)$", stripped) and is_open(lines, index)
            continue
        statement = join_statement(lines, index)
        is_evident = NOTHING.fullmatch(member.group(2) or member.group(3)) if member else SELF_EVIDENT.search(statement)
        words = "".join(UNIT.sub("", comment) for comment in COMMENT.findall(statement))
        if not is_explained and not is_evident and (not words if constant else not COMMENT.search(statement)):
            yield index + 1, (constant or member).group(1), stripped
        is_explained = is_explained and not member  # A comment above is for one member, or for a block of constants.


def is_open(lines, index):
    """Whether a line belongs to a declaration that an earlier line began."""
    return index > 0 and not lines[index - 1].split("//")[0].rstrip().endswith((";", "{", "}"))


def join_statement(lines, index):
    """The declaration that begins on a line, up to its semicolon, with comments on its lines."""
    end = index
    while end + 1 < len(lines) and ";" not in lines[end].split("//")[0]:
        end += 1
    return "\n".join(lines[index : end + 1])


def main():
    root = parse_root(__doc__)
    problems, count = [], 0
    for path in list_sources(root):
        lines = path.read_text().splitlines()
        count += sum(1 for line in lines if CONSTANT.match(line))
        problems += [f"{path.relative_to(root)}:{n}: {name} does not say where it comes from: {text}" for n, name, text in find_bare(lines)]
    return report(problems, f"constants: {count}, each with a comment")


if __name__ == "__main__":
    sys.exit(main())
