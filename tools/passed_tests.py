#!/usr/bin/env python3
"""Remembers which tests passed: passed_tests.py BUILD_FOLDER list | add NAME...

`list` prints the names of tests that passed before with the same program, and the same of all else
that they read: the libraries that they load and DATA; those of label `e2e` or `web` also the programs
hvas and hvas-cad; those of label `web` also the folder web/. `add` notes that tests have passed. What
has passed is forgotten with the build folder.
"""

import functools
import hashlib
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
# What tests read of this folder, as git's pathspecs; sources are in their programs.
DATA = ("data", "products", "fuzz/seeds", "docs/studies.md", "src", *(f":!src/*{end}" for end in (".cc", ".h", "CMakeLists.txt")))


@functools.lru_cache(maxsize=None)
def digest_file(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@functools.lru_cache(maxsize=None)
def digest_folders(*folders):
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *folders]
    names = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    paths = sorted(ROOT / name for name in names.split("\0") if name)
    return digest_files(path for path in paths if path.is_file())


def digest_files(paths):
    digest = hashlib.sha256()
    for path in paths:
        digest.update(f"{path.relative_to(ROOT)} {digest_file(path)}\n".encode())
    return digest.hexdigest()


def read_tests(build):
    """Mark of each test by its name: what decides how it ends."""
    command = ["ctest", "--test-dir", build, "--show-only=json-v1"]
    tests = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["tests"]
    libraries = digest_files(sorted(build.glob("src/**/*.so")))
    programs = [path for path in (build / "src/app/hvas", build / "src/cad/hvas-cad") if path.is_file()]
    marks = {}
    for test in tests:
        labels = next((p["value"] for p in test["properties"] if p["name"] == "LABELS"), [])
        own = [pathlib.Path(word) for word in test.get("command", []) if word.startswith(str(ROOT))]
        parts = [test["name"], *test.get("command", []), libraries, digest_folders(*DATA)]
        parts += [digest_file(path) for path in own if path.is_file()]
        if "e2e" in labels or "web" in labels:
            parts += [digest_file(path) for path in programs]
        if "web" in labels:
            parts.append(digest_folders("web"))
        marks[test["name"]] = hashlib.sha256("\n".join(parts).encode()).hexdigest()
    return marks


def main():
    if len(sys.argv) < 3 or sys.argv[2] not in ("list", "add"):
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    build = pathlib.Path(sys.argv[1]).resolve()
    marks, folder = read_tests(build), build / "passed"
    folder.mkdir(exist_ok=True)
    if sys.argv[2] == "add":
        for name in sys.argv[3:]:
            (folder / marks[name]).touch()
    else:
        print("\n".join(name for name, mark in marks.items() if (folder / mark).exists()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
