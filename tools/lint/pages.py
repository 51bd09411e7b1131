#!/usr/bin/env python3
"""Checks that documents lead somewhere and are led to.

Every relative link and picture in a *.md has to be a file of the checkout, and its anchor a heading of that
file (as GitHub makes anchors). Every page below docs/ has to be reached by links from docs/README.md, and every
file in docs/pictures/ has to be shown by a page. Prints each line that offends; exit status 1 when there is one.
"""

import posixpath
import re
import subprocess
import sys
from urllib.parse import unquote

from checkout import parse_root, report

START = "docs/README.md"
PICTURES = "docs/pictures/"
FENCE = re.compile(r"^( {0,3})(```+|~~~+).*?^ {0,3}\2[`~]*[ \t]*$", re.DOTALL | re.MULTILINE)
QUOTED = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|<(?:img|source)\s[^>]*?src(?:set)?=\"([^\"]+)\"")
OUTSIDE = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$", re.MULTILINE)


def blank(match):
    """As many lines and characters, with nothing in them."""
    return re.sub(r"[^\n]", " ", match.group())


def find_links(text):
    """Line and target of each link and picture outside code."""
    prose = QUOTED.sub(blank, FENCE.sub(blank, text))
    for match in LINK.finditer(prose):
        yield prose.count("\n", 0, match.start()) + 1, match.group(1) or match.group(2)


def find_anchors(text):
    """What GitHub makes of the headings: small letters, no signs, hyphens for blanks, numbers where they repeat."""
    anchors, seen = set(), {}
    for match in HEADING.finditer(FENCE.sub(blank, text)):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", match.group(1)).lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(f"{slug}-{count}" if count else slug)
    return anchors


def list_files(root):
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, check=True, capture_output=True, text=True, cwd=root).stdout.splitlines()
    return {name for name in names if (root / name).is_file()}


def check(root):
    files = list_files(root)
    folders = {posixpath.dirname(name) for name in files}
    folders |= {"/".join(folder.split("/")[:n]) for folder in list(folders) for n in range(folder.count("/") + 1)}
    pages = {name: (root / name).read_text(errors="replace") for name in sorted(files) if name.endswith(".md")}
    anchors = {name: find_anchors(text) for name, text in pages.items()}
    leads_to = {name: set() for name in pages}
    for name, text in pages.items():
        for line, link in find_links(text):
            if OUTSIDE.match(link):
                continue
            path, _, anchor = unquote(link).partition("#")
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
            if target in folders and posixpath.join(target, "README.md") in files:
                target = posixpath.join(target, "README.md")
            if target in files:
                leads_to[name].add(target)
                if anchor and target in pages and anchor not in anchors[target]:
                    yield f"{name}:{line}: {target} has no heading #{anchor}"
            elif target not in folders:
                yield f"{name}:{line}: {target} is not there"
    if START not in pages:
        yield f"{START} is not there, from which all pages are to be reached"
        return
    reached, waiting = {START}, [START]
    while waiting:
        fresh = {target for target in leads_to[waiting.pop()] if target in pages} - reached
        reached |= fresh
        waiting += fresh
    for name in pages:
        if name.startswith("docs/") and name not in reached:
            yield f"{name}: no way leads here from {START}"
    shown = set().union(*leads_to.values())
    for name in sorted(files):
        if name.startswith(PICTURES) and name not in shown and not name.endswith(".md"):
            yield f"{name}: no page shows it"


def main():
    root = parse_root(__doc__)
    count = sum(name.endswith(".md") for name in list_files(root))
    return report(list(check(root)), f"pages: {count} documents, all links lead somewhere, all of docs/ is reached")


if __name__ == "__main__":
    sys.exit(main())
