#!/usr/bin/env python3
"""Writes THIRD-PARTY.md: whose work is in the program and in the studio's page, and under which terms.

    tools/third_party.py           writes it, from the packages that are installed
    tools/third_party.py --check   tells what it lacks of packages.txt and web/package-lock.json, or has too much;
                                   needs no package
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Package of packages.txt: name, licence, and the licence's name in the package's own notes where that differs. The
# packages of OpenCASCADE are one library.
LIBRARIES = {
    "libocct-data-exchange-dev": ("OpenCASCADE Technology", "LGPL-2.1 with exception", None),
    "libassimp-dev": ("assimp", "BSD-3-Clause", None),
    "zlib1g-dev": ("zlib", "Zlib", None),
    "libeigen3-dev": ("Eigen", "MPL-2.0", None),
    "libbullet-dev": ("Bullet", "Zlib", None),
    "coinor-libclp-dev": ("CLP", "EPL-1.0", None),
    "coinor-libcoinutils-dev": ("CoinUtils", "EPL-1.0", None),
    "libsqlite3-dev": ("SQLite", "public domain", None),
    "libfmt-dev": ("fmt", "MIT with exception", None),
    "libexpected-dev": ("expected", "CC0-1.0", None),
    "libxxhash-dev": ("xxHash", "BSD-2-Clause", None),
    "libhdf5-dev": ("HDF5", "BSD-3-Clause", None),
    "libyaml-cpp-dev": ("yaml-cpp", "MIT", None),
    "libzstd-dev": ("Zstandard", "BSD-3-Clause", "BSD-3-clause"),
    "nlohmann-json3-dev": ("JSON for Modern C++", "MIT", None),
    "libboost-dev": ("Boost", "BSL-1.0", "BSL-1.0"),
    "libssl-dev": ("OpenSSL", "Apache-2.0", None),
    "libcli11-dev": ("CLI11", "BSD-3-Clause", None),
    "libcsv-dev": ("libcsv", "LGPL-2.1-or-later", None),
    "pybind11-dev": ("pybind11", "BSD-3-Clause", None),
}
# Of a package that stands for another: where its notes are, and who has the rights.
NOTES = {"libboost-dev": ("libboost1.74-dev", "the Boost authors, as each of its headers names them")}
PARTS = {
    package: "libocct-data-exchange-dev"
    for package in (
        "libocct-foundation-dev",
        "libocct-modeling-algorithms-dev",
        "libocct-modeling-data-dev",
        "libocct-ocaf-dev",
        "libocct-visualization-dev",
    )
}
# Of packages_test.txt, but in the Python package.
IN_PYTHON = {"pybind11-dev"}
# Whole texts that several of the notes refer to.
COMMON = {"Apache-2.0": "Apache License 2.0", "LGPL-2.1": "GNU Lesser General Public License 2.1",
          "CC0-1.0": "Creative Commons CC0 1.0"}

HEAD = """# Third-party software

HVAS itself is under the Apache License 2.0 (LICENSE). In its program and in the studio's page is the work of others,
under the terms below. Libraries marked "linked" stand beside the program as shared libraries and can be exchanged for
others of the same interface; of the rest, parts are compiled into it. This file is written by tools/third_party.py.
"""


def packages():
    """The development packages of packages.txt that end up in the program, OpenCASCADE's as one."""
    lines = (ROOT / "packages.txt").read_text().split("\n")
    names = {line for line in lines if re.fullmatch(r"(lib[^ ]*|coinor-[^ ]*|[^ ]*json[^ ]*|zlib1g)-dev", line)}
    return {PARTS.get(name, name) for name in names | IN_PYTHON}


def bundled(lock):
    """Names and versions of what may be bundled into the page: what package-lock.json has not for development only."""
    found = {}
    for path, entry in json.loads(lock)["packages"].items():
        if path and not entry.get("dev"):
            found[path.rpartition("node_modules/")[2]] = entry["version"]
    return found


def titles(text):
    """Headings of entries: {name: version}."""
    return dict(re.findall(r"^### (.+) (\S+)$", text, re.M))


def check(text, lock):
    """@returns what is wrong with a THIRD-PARTY.md, a line each."""
    wrong = []
    listed = titles(text)
    for name, version in bundled(lock).items():
        if name not in listed:
            wrong.append(f"{name} {version} is bundled into the page and has no entry")
        elif listed[name] != version:
            wrong.append(f"{name} {version} is bundled into the page; the entry is of {listed[name]}")
    names = {LIBRARIES[package][0] for package in packages() if package in LIBRARIES}
    wrong += [f"{package} has no row in tools/third_party.py" for package in packages() - LIBRARIES.keys()]
    wrong += [f"{name} is in the program and has no entry" for name in names - listed.keys()]
    wrong += [f"{name} has an entry, and is neither in the program nor in the page"
              for name in listed.keys() - names - bundled(lock).keys()]
    for title, body in re.findall(r"^### (.+?)\n(.*?)(?=^##|\Z)", text, re.M | re.S):
        if not re.search(r"```text\n.{40,}?\n```", body, re.S):
            wrong.append(f"the entry {title} has no text")
    wrong += [f"a path of a machine: {path}" for path in re.findall(r"(?:/usr/|/home/|/tmp/|file://)\S*", text)]
    return wrong


def paragraphs(package):
    """The stanzas of a package's notes on copyright."""
    notes = Path(f"/usr/share/doc/{NOTES.get(package, (package,))[0]}/copyright").read_text()
    return re.split(r"\n[ \t]*\n", notes)


def field(stanza, name):
    """A field's first line and the lines below it."""
    match = re.search(rf"^{name}: *(.*(?:\n[ \t].*)*)", stanza, re.M)
    return match.group(1) if match else ""


def dedent(text):
    """A field's lines as they are meant, up to the next field."""
    text = re.split(r"^\S", text, maxsplit=1, flags=re.M)[0]
    lines = [line.expandtabs().rstrip() for line in text.split("\n")]
    lines = ["" if line.strip() == "." else line for line in lines]
    indent = min((len(line) - len(line.lstrip()) for line in lines if line), default=0)
    return "\n".join(line[indent:] for line in lines).strip()


def without_paths(text):
    """Without the sentences that say where Debian keeps a text: it is in this file."""
    kept = [p for p in text.split("\n\n") if not re.search(r"/usr/share/common-licenses", p)]
    return "\n\n".join(kept)


def library_text(package):
    stanzas = paragraphs(package)
    main = next(stanza for stanza in stanzas if re.search(r"^Files: \*$", stanza, re.M))
    holders = NOTES.get(package, (None, None))[1] or dedent(" " + field(main, "Copyright"))
    name, _, text = field(main, "License").partition("\n")
    name = LIBRARIES[package][2] or name.strip()
    if not text or LIBRARIES[package][2]:
        for stanza in stanzas:
            if stanza.startswith(f"License: {name}\n"):
                text = stanza.partition("\n")[2]
                break
    if not text:
        sys.exit(f"{package}: there is no text of {name}")
    return f"Copyright {dedent_list(holders)}\n\n{without_paths(dedent(text))}"


def dedent_list(text):
    return "\n          ".join(re.sub(r"  +", " ", line.strip()) for line in text.split("\n"))


def version_of(package):
    name = NOTES.get(package, (package,))[0]
    version = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", name], check=True, capture_output=True,
                             text=True).stdout
    return re.sub(r"^\d+:|[-+~].*$|\.dfsg.*$", "", version)


def entry(name, version, licence, how, text):
    return f"### {name} {version}\n\n{licence}, {how}.\n\n```text\n{text.strip()}\n```\n"


HEADERS_ONLY = {"libeigen3-dev", "libexpected-dev", "nlohmann-json3-dev", "libboost-dev", "libcli11-dev", "pybind11-dev"}


def write():
    lock = (ROOT / "web/package-lock.json").read_text()
    missing = packages() - LIBRARIES.keys()
    if missing:
        sys.exit(f"give {', '.join(sorted(missing))} a row in LIBRARIES")
    parts = [HEAD, "## In the program\n"]
    for package in sorted(packages(), key=lambda p: LIBRARIES[p][0].lower()):
        name, licence, _ = LIBRARIES[package]
        how = "compiled in" if package in HEADERS_ONLY else "linked"
        parts.append(entry(name, version_of(package), licence, how, library_text(package)))
    parts.append("## In the studio's page\n")
    for name, version in sorted(bundled(lock).items()):
        folder = ROOT / "web/node_modules" / name
        licence = json.loads((folder / "package.json").read_text())["license"]
        text = next(folder.glob("LICEN[CS]E*")).read_text()
        parts.append(entry(name, version, licence, "bundled", text))
    parts.append("## Texts that the above refer to\n")
    for name, title in COMMON.items():
        text = Path(f"/usr/share/common-licenses/{name}").read_text()
        parts.append(f"#### {title}\n\n```text\n{text.strip(chr(10))}\n```\n")
    text = "\n".join(parts)
    (ROOT / "THIRD-PARTY.md").write_text(re.sub(r"[ \t]+$", "", text, flags=re.M))


def main():
    if sys.argv[1:] == ["--check"]:
        wrong = check((ROOT / "THIRD-PARTY.md").read_text(), (ROOT / "web/package-lock.json").read_text())
        for line in wrong:
            print(f"THIRD-PARTY.md: {line}; run tools/third_party.py")
        return 1 if wrong else 0
    if sys.argv[1:]:
        print(__doc__, file=sys.stderr)
        return 2
    write()
    return 0


if __name__ == "__main__":
    sys.exit(main())
