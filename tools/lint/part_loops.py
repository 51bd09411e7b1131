#!/usr/bin/env python3
"""Checks that no loop over the parts of a product stands in another one.

Files of strangers have tens of thousands of parts: what looks at each pair of them runs for hours, whatever limit of time
there is. Pairs are visited by spatial::ForEachPair() (src/spatial/box_pairs.h), which leaves out what is far apart and
heeds the limits. A loop here is a `for`, or an algorithm of the standard library, over a list whose name says that it has
parts, occurrences, bodies, boxes of them or the like, or a `for` up to the size of such a list, also by way of a variable.
A call inside a loop is not followed. ALLOWED has the loops that are left, each with its reason. Prints each nested loop;
the exit status is 1 when there is one, or an entry of ALLOWED that is not needed.
"""

import re
import sys

from checkout import parse_root, report

ROOMS = (
    "assembly cad campaign contact dynamics evidence exchange haptics mates orders paths person product sequence session shopfloor"
    " simulation statics studio"
).split()

# Lists that have an entry for each part of a product, as they are called.
LISTS = r"(?:occurrences|subassemblies|bodies|parts|placed|boxes|solids|joints|gaps|mates)"

ALGORITHMS = r"(?:\w+_of|find\w*|count\w*|for_each|transform|accumulate|max_element|min_element)"

# File and what the inner loop goes over: why it stays.
ALLOWED = {
    ("campaign/prepared_cell.cc", "product->parts"): "the outer list is of the plan, which the user writes",
    ("mates/joints.cc", "mates"): "mates of one joint; the loop looks at the watch",
}


def without_comments(text):
    """The text with comments and literals blanked, line by line as long as before."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.DOTALL)


def end_of(text, at, opening, closing):
    """The index behind the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] == opening) - (text[i] == closing)
        if depth == 0:
            return i + 1
    return len(text)


def end_of_statement(text, at):
    """The index behind the statement that begins at `at`."""
    while at < len(text) and text[at].isspace():
        at += 1
    if text.startswith("{", at):
        return end_of(text, at, "{", "}")
    if match := re.match(r"(?:for|while|if)\b[^(]*\(", text[at:]):
        return end_of_statement(text, end_of(text, at + match.end() - 1, "(", ")"))
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "({[") - (text[i] in ")}]")
        if text[i] == ";" and depth <= 0:
            return i + 1
    return len(text)


def counts_of(text):
    """Variables that hold the size of a list of parts."""
    return re.findall(rf"\b(\w+)\s*=\s*(?:static_cast<[\w:]+>\()?[\w.>-]*\b{LISTS}_?\.size\(\)\s*\)?;", text)


def over(head, counts):
    """The list of parts that the head of a `for` goes over; None where it is no such list."""
    colon = re.search(r"(?<!:):(?!:)", head)
    if colon and ";" not in head:
        match = re.fullmatch(rf"[\w.>\-\[\]()*:]*?\b{LISTS}_?", head[colon.end() :].strip())
        return match and match.group()
    pieces = head.split(";")
    if len(pieces) != 3:
        return None
    match = re.search(rf"\b({LISTS}_?)\.size\(\)", pieces[1])
    if match and re.search(r"[<!]", pieces[1]):
        return match.group(1)
    return next((count for count in counts if re.search(rf"[<!]=?\s*{count}\b", pieces[1])), None)


def find_loops(text):
    """Begin, begin of the body, end, list and variables of each loop over parts."""
    counts = counts_of(text)
    for match in re.finditer(r"\bfor\s*\(", text):
        head_end = end_of(text, match.end() - 1, "(", ")")
        head = text[match.end() : head_end - 1]
        if listed := over(head, counts):
            variables = re.findall(r"\w+", re.split(r"(?<!:):(?!:)", head)[0]) if ";" not in head else []
            yield match.start(), head_end, end_of_statement(text, head_end), listed, variables
    algorithm = rf"\bstd::{ALGORITHMS}\s*\(\s*([\w.>\-\[\]()]*?\b{LISTS}_?)\.c?begin\(\)"
    for match in re.finditer(algorithm, text):
        at = text.index("(", match.start())
        yield match.start(), match.end(), end_of(text, at, "(", ")"), match.group(1), []


def find_nested(text):
    """Line and list of each loop over parts that stands in another one."""
    text = without_comments(text)
    loops = list(find_loops(text))
    for begin, _, _, listed, _ in loops:
        around = [loop for loop in loops if loop[1] <= begin < loop[2]]
        # What belongs to the element of an outer loop is gone through once in all.
        is_own = any(re.match(rf"{variable}\b(?:\.|->)", listed) for *_, variables in around for variable in variables)
        if around and not is_own:
            yield text.count("\n", 0, begin) + 1, listed


def check(root, allowed):
    problems = []
    unused = set(allowed)
    for room in ROOMS:
        for path in sorted((root / "src" / room).rglob("*.cc")):
            if "test" in path.parts:
                continue
            name = str(path.relative_to(root / "src"))
            for line, listed in find_nested(path.read_text()):
                if (name, listed) in allowed:
                    unused.discard((name, listed))
                else:
                    problems.append(
                        f"src/{name}:{line}: a loop over {listed} in a loop over parts: visit the pairs by spatial::ForEachPair(), or look"
                        " them up"
                    )
    problems += [f"tools/lint/part_loops.py: {name} has no nested loop over {listed} any more" for name, listed in sorted(unused)]
    return problems


def main():
    root = parse_root(__doc__)
    return report(check(root, ALLOWED), f"loops over parts: none in another one, {len(ALLOWED)} allowed with their reasons")


if __name__ == "__main__":
    sys.exit(main())
