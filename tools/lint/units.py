#!/usr/bin/env python3
"""Checks that what is not SI says so in its name (docs/conventions.md, "Units").

Where the comment of a declaration, on its line or directly above it, has a unit in brackets that is not SI, as
[mm], [deg C] or [us], the name has to end in its suffix: `_mm`, `_c`, `_us`, and of constants also `Mm`, `C`, `Us`. So
has a parameter whose @param has such a unit; what a function returns is told by its comment alone. Looked at in src/,
but for tests. Prints each line that offends; exit status 1 when there is one.
"""

import re
import sys

from checkout import list_sources, parse_root, report

SUFFIXES = {
    "°C": "c", "C": "c", "deg C": "c", "degC": "c", "°": "deg", "deg": "deg", "mm": "mm", "um": "um", "µm": "um",
    "mm^2": "mm2", "mm2": "mm2", "mm^3": "mm3", "mm3": "mm3", "mm^4": "mm4", "mm^5": "mm5", "mm/s": "mm_s", "in": "in",
    "MPa": "mpa", "GPa": "gpa", "N/mm^2": "mpa", "kN": "kn", "%": "percent", "ms": "ms", "us": "us", "ns": "ns",
    "min": "min", "h": "h", "rpm": "rpm", "1/min": "rpm",
}
UNIT = re.compile(r"\[(" + "|".join(sorted(map(re.escape, SUFFIXES), key=len, reverse=True)) + r")\]")
COMMENT = re.compile(r"//[/!]?<?(.*)$")
PARAM = re.compile(r"@param(?:\[\w+\])?\s+(\w+)(.*?)(?=@\w|$)", re.DOTALL)
NAMED = re.compile(r"[\w>&*\]]\s+[&*]?(\w+)\s*(?:\[[^\]]*\]\s*)*(?=[;,={(]|$)")
NOT_DECLARED = re.compile(r"\s*(?:return|using|struct|class|enum|namespace|case|if|for|while|else|template|#|\}|@|\.)")


def has_suffix(name, unit):
    """Whether a name tells a unit: a_mm, a_mm_, kA_mm, kAMm."""
    suffix = SUFFIXES[unit]
    camel = "".join(part.capitalize() for part in suffix.split("_"))
    return bool(re.search(rf"(?:_|^){suffix}_?$", name) or name.endswith(camel))


def find_names(code):
    """Names of the variables that a line declares: a and b of `int a{0}, b;`. None of a function."""
    if re.match(r"[\s\w:<>,&*\[\]]*?[\s&*]~?\w+\(", code):
        return []
    code = re.sub(r"\{[^{}]*\}|=[^,;]*", "", re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", code)))
    first, *more = code.split(";")[0].split(",")
    match = NAMED.search(first)
    found = re.findall(r"[&*\s](\w+)\s*(?:\[[^\]]*\])*\s*$", first) or ([match.group(1)] if match else [])
    return [*found, *(name.strip() for name in more if re.fullmatch(r"\s*\w+\s*", name))]


def judge(lines, index, comment):
    """What is wrong with the declaration on a line, given the comment that belongs to it."""
    for name, text in PARAM.findall(comment):
        for unit in UNIT.findall(text):
            if not has_suffix(name, unit):
                yield f"{name} is in {unit} and does not end in _{SUFFIXES[unit]}"
    units = UNIT.findall(PARAM.sub("", comment))
    code = COMMENT.sub("", lines[index])
    if not units or NOT_DECLARED.match(code) or not code.strip():
        return
    end = index
    while end + 1 < len(lines) and not re.search(r"[;{]\s*$", COMMENT.sub("", lines[end]).rstrip()):
        end += 1
    names = find_names(" ".join(COMMENT.sub("", line).strip() for line in ["", *lines[index : end + 1]]))
    for unit in dict.fromkeys(units):
        bare = [name for name in names if not has_suffix(name, unit)]
        if bare and (len(set(units)) == 1 or len(bare) == len(names)):
            yield f"{bare[0]} is in {unit} and does not end in _{SUFFIXES[unit]}"


def find_unsuffixed(lines):
    """Line and fault of each declaration whose name lacks the suffix of its unit."""
    above = ""
    within = False
    for index, line in enumerate(lines):
        stripped = line.strip()
        if within or stripped.startswith(("//", "/*")):
            above = above + " " + stripped if within or above else stripped
            within = (within or stripped.startswith("/*")) and "*/" not in stripped
            continue
        match = COMMENT.search(line)
        own = match.group(1) if match and '"' not in match.group(1) else ""
        for problem in judge(lines, index, f"{own} {above}".strip()):
            yield index + 1, problem
        above = ""


def main():
    root = parse_root(__doc__)
    problems = [
        f"{path.relative_to(root)}:{line}: {what}"
        for path in list_sources(root)
        for line, what in find_unsuffixed(path.read_text().splitlines())
    ]
    return report(problems, f"units: {len(set(SUFFIXES.values()))} suffixes, each name has that of its unit")


if __name__ == "__main__":
    sys.exit(main())
