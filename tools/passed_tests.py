#!/usr/bin/env python3
"""Remembers which tests passed.

    passed_tests.py BUILD_FOLDER unchanged       tests that passed as they are
    passed_tests.py BUILD_FOLDER passed LABELS   tests of these labels that passed before some change
    passed_tests.py BUILD_FOLDER add NAME...     notes that tests have passed as they are

Each prints or takes names of tests; LABELS is a pattern of which a whole label is to match. A test is as
it was when its program is, and all else that it reads: the libraries that it loads, hvas-cad and DATA;
hvas where its program, command or environment names it; the folder web/ for labels `web` and `client`.
What has passed is forgotten with the build folder.
"""

import functools
import hashlib
import json
import pathlib
import re
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
    """The tests of a build folder, as ctest describes them."""
    command = ["ctest", "--test-dir", build, "--show-only=json-v1"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["tests"]


def list_labels(test):
    return next((p["value"] for p in test["properties"] if p["name"] == "LABELS"), [])


def starts(test, own, program):
    """Whether the path of a program is in a test's command, environment or own programs."""
    words = [word for p in test["properties"] if p["name"] == "ENVIRONMENT" for word in p["value"]]
    return any(str(program) in word for word in [*test.get("command", []), *words]) or any(
        str(program).encode() in path.read_bytes() for path in own)


def mark_tests(build, tests):
    """Mark of each test by its name: what decides how it ends."""
    libraries = digest_files(sorted(build.glob("src/**/*.so")))
    program, reader = build / "src/app/hvas", build / "src/cad/hvas-cad"
    marks = {}
    for test in tests:
        own = [pathlib.Path(word) for word in test.get("command", []) if word.startswith(str(ROOT))]
        own = [path for path in own if path.is_file()]
        parts = [test["name"], *test.get("command", []), libraries, digest_folders(*DATA)]
        parts += [digest_file(path) for path in own]
        parts += [digest_file(path) for path in (reader,) if path.is_file()]
        parts += [digest_file(path) for path in (program,) if path.is_file() and starts(test, own, path)]
        if {"web", "client"} & set(list_labels(test)):
            parts.append(digest_folders("web"))
        marks[test["name"]] = hashlib.sha256("\n".join(parts).encode()).hexdigest()
    return marks


def main():
    if len(sys.argv) < 3 or sys.argv[2] not in ("unchanged", "passed", "add"):
        print(__doc__, file=sys.stderr)
        return 2
    build, action, words = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3:]
    tests, folder = read_tests(build), build / "passed"
    folder.mkdir(exist_ok=True)
    if action == "passed":
        labels = re.compile("|".join(words))
        matching = [test["name"] for test in tests if any(map(labels.fullmatch, list_labels(test)))]
        print("\n".join(name for name in matching if (folder / name).exists()))
        return 0
    marks = mark_tests(build, tests)
    if action == "add":
        for name in words:
            (folder / name).touch()
            (folder / marks[name]).touch()
    else:
        print("\n".join(name for name, mark in marks.items() if (folder / mark).exists()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
