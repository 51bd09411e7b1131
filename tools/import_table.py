#!/usr/bin/env python3
"""What HVAS makes of a folder of CAD files, as the table of docs/import.md.

  tools/import_table.py HVAS FOLDER [--write docs/import.md]

Opens every file with `hvas inspect --json`, first with an empty cache, then again, and prints one row
a file: what was found, how long both took, and the most memory that a process of the first took.
--write puts the table between the two marks in that page. Exit status 1 when a file neither opens nor
says in one line why not.
"""

import argparse
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

EXTENSIONS = {".step", ".stp", ".obj", ".stl", ".gltf", ".glb", ".3mf"}
BEGIN, END = "<!-- table: begin -->", "<!-- table: end -->"
FACES = ["plane", "cylinder", "cone", "sphere", "torus", "freeform"]
HEAD = ("file | parts (different) | faces: plane, cylinder, cone, sphere, torus, freeform (recognised) | forms"
        " | axis-hole, face, cone, sphere | linked | dimensions, tolerances, fits | warnings | cold, cached s | MB")


def open_file(hvas, file, cache):
    """(answer, seconds, peak MB) of one opening; the answer is a dict, or the message of refusal."""
    environment = dict(os.environ, XDG_CACHE_HOME=cache, HVAS_CACHE="")
    del environment["HVAS_CACHE"]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        process = subprocess.Popen([hvas, "inspect", "--json", "--all", "-q", file], stdout=out, stderr=err,
                                   env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - start
        out.seek(0)
        err.seek(0)
        text = err.read().decode(errors="replace").strip()
        if status != 0:
            return text or f"ended with {status} and said nothing", seconds, usage.ru_maxrss / 1024
        return json.loads(out.read()), seconds, usage.ru_maxrss / 1024


def list_counts(counts):
    return ", ".join(f"{count} {kind.replace('_', ' ')}" for kind, count in sorted(counts.items()) if count)


def describe(name, answer, cold, cached, memory):
    summary = answer["summary"]
    faces, forms = collections.Counter(), collections.Counter()
    for part in answer["parts"]:
        faces.update(part["face_counts"])
    forms.update(form["kind"] for form in answer["forms"])
    mates, tolerances = summary["mates"], summary["tolerances"]
    return (f"{name} | {summary['occurrences']} ({summary['unique_parts']}) | "
            + ", ".join(str(faces[kind]) for kind in FACES) + f" ({faces['recognised']}) | {list_counts(forms)} | "
            + ", ".join(str(mates[kind]) for kind in ("axis_hole", "face_face", "cone_seat", "sphere_seat"))
            + f" | {summary['linked_parts']} | {tolerances['dimensions']}, {tolerances['geometric']}, {tolerances['fits']}"
            + f" | {summary['warnings']} | {cold:.2f}, {cached:.2f} | {memory:.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hvas", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--write", type=pathlib.Path)
    arguments = parser.parse_args()
    files = sorted(p for p in arguments.folder.rglob("*") if p.suffix.lower() in EXTENSIONS and p.is_file())
    rows = [HEAD, " | ".join("-" for _ in HEAD.split(" | "))]
    is_good = bool(files)
    for file in files:
        name = str(file.relative_to(arguments.folder))
        with tempfile.TemporaryDirectory() as cache:
            answer, cold, memory = open_file(arguments.hvas, file, cache)
            cached = open_file(arguments.hvas, file, cache)[1]
        if isinstance(answer, str):
            is_good = is_good and answer.startswith("hvas: ") and "\n" not in answer
            rows.append(f"{name} | {answer.removeprefix('hvas: ')}" + " |" * 8)
        else:
            rows.append(describe(name, answer, cold, cached, memory))
        print(rows[-1], file=sys.stderr)
    table = "\n".join(f"| {row} |" for row in rows)
    print(table)
    if arguments.write:
        page = arguments.write.read_text()
        before, rest = page.split(BEGIN)
        arguments.write.write_text(before + BEGIN + "\n" + table + "\n" + END + rest.split(END)[1])
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
