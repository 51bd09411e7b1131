#!/usr/bin/env python3
"""Runs clang-tidy-14 over the sources of a build folder: tidy.py BUILD_FOLDER [-j N] [--tests | FILE...]

Tests, which take as long as all else, are left out unless --tests asks for them alone. A source that has passed is not looked at again until it, a header of ours that it includes, its
command line or .clang-tidy changes. FILEs select sources by the end of their path.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def read_dependencies(build):
    """Headers of ours by object file, from what ninja knows of the last build."""
    headers, current = {}, None
    text = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True).stdout
    for line in text.splitlines():
        if line and not line[0].isspace():
            current = headers.setdefault(line.split(":")[0], [])
        elif line.strip():
            path = (build / line.strip()).resolve()
            if ROOT in path.parents:
                current.append(path)
    return headers


def object_of(entry):
    words = entry["command"].split()
    return words[words.index("-o") + 1]


def fingerprint(entry, headers):
    """Of everything of ours that decides what clang-tidy says; None when not known yet."""
    if not headers:
        return None
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes() + entry["command"].encode())
    for path in sorted({pathlib.Path(entry["file"]), *headers}):
        if not path.exists():
            return None
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("-j", type=int, default=1, metavar="N")
    parser.add_argument("--tests", action="store_true")
    parser.add_argument("files", nargs="*")
    args = parser.parse_intermixed_args()
    entries = json.loads((args.build / "compile_commands.json").read_text())
    if args.files:
        entries = [e for e in entries if e["file"].endswith(tuple(args.files))]
    else:
        entries = [e for e in entries if ("/test/" in e["file"]) == args.tests]
    headers = read_dependencies(args.build)
    passed_folder = args.build / "tidy"
    passed_folder.mkdir(exist_ok=True)

    def check(entry):
        mark = fingerprint(entry, headers.get(object_of(entry), []))
        if mark and (passed_folder / mark).exists():
            return entry, None, 0.0, ""
        start = time.monotonic()
        done = subprocess.run(
            ["clang-tidy-14", "--quiet", "-p", args.build, entry["file"]], capture_output=True, text=True
        )
        if done.returncode == 0 and mark:
            (passed_folder / mark).touch()
        noise = done.stderr if done.returncode and not done.stdout.strip() else ""
        return entry, done.returncode == 0, time.monotonic() - start, done.stdout + noise

    looked, bad = 0, 0
    # Slowest first is unknown; largest first is near enough, so that no core idles at the end.
    entries.sort(key=lambda e: -pathlib.Path(e["file"]).stat().st_size)
    with concurrent.futures.ThreadPoolExecutor(args.j) as pool:
        for entry, is_clean, seconds, text in pool.map(check, entries):
            looked += is_clean is not None
            if is_clean is False:
                bad += 1
                print(f"{pathlib.Path(entry['file']).relative_to(ROOT)} ({seconds:.0f} s):\n{text}", flush=True)
    print(f"tidy: {looked} of {len(entries)} sources looked at, {len(entries) - looked} unchanged, {bad} with findings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
