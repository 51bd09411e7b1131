#!/usr/bin/env python3
"""Runs clang-tidy-14 over sources: tidy.py BUILD_FOLDER [-j N] [--changed] [--most N] [FILE...]

BUILD_FOLDER is of a preset that compiles each source by itself (`clang`), so that what a source does
not include is found, too. FILEs select sources by the end of their path; --changed selects what
tools/changed names, a header by the source of the same name, or by any one that includes it. A source
that has passed is not looked at again until it, a header of ours that it includes, its command line
or .clang-tidy changes. Where more than --most sources would have to be looked at, none is, and it
says so.
"""

import argparse
import concurrent.futures
import functools
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


@functools.lru_cache(maxsize=None)
def read_includes(path):
    """Headers of ours that a file includes itself."""
    found = (base / name for name in INCLUDE.findall(path.read_text()) for base in (ROOT / "src", ROOT, path.parent))
    return frozenset(header.resolve() for header in found if header.is_file())


@functools.lru_cache(maxsize=None)
def find_headers(path):
    """Headers of ours that a file includes, itself or by others."""
    seen, queue = set(), [path]
    while queue:
        for header in read_includes(queue.pop()):
            if header not in seen:
                seen.add(header)
                queue.append(header)
    return frozenset(seen)


def fingerprint(entry):
    """Of everything of ours that decides what clang-tidy says."""
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes() + entry["command"].encode())
    for path in sorted({entry["path"], *find_headers(entry["path"])}):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def mark_of(passed_folder, entry):
    """The file that is there once this source has passed as it is now."""
    return passed_folder / fingerprint(entry)


def list_files(*command):
    text = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    return {ROOT / line for line in text.splitlines()}


def choose_changed(entries):
    changed = list_files(ROOT / "tools/changed", "*.cc", "*.h")
    chosen = [e for e in entries if e["path"] in changed]
    for header in sorted(path for path in changed if path.suffix == ".h"):
        if not any(header in find_headers(e["path"]) for e in chosen):
            users = [e for e in entries if header in find_headers(e["path"])]
            users.sort(key=lambda e: (e["path"].stem != header.stem, len(find_headers(e["path"]))))
            chosen.extend(users[:1])
    return chosen


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("-j", type=int, default=1, metavar="N")
    parser.add_argument("--changed", action="store_true")
    parser.add_argument("--most", type=int, metavar="N")
    parser.add_argument("files", nargs="*")
    args = parser.parse_intermixed_args()
    sources = list_files("git", "ls-files", "--cached", "--others", "--exclude-standard", "*.cc")
    entries = {}
    for entry in json.loads((args.build / "compile_commands.json").read_text()):
        entry["path"] = pathlib.Path(entry["file"])
        if entry["path"] in sources and entry["file"].endswith(tuple(args.files) or ""):
            entries.setdefault(entry["path"], entry)
    entries = choose_changed(list(entries.values())) if args.changed else list(entries.values())
    chosen = len(entries)
    passed_folder = args.build / "tidy"
    passed_folder.mkdir(exist_ok=True)
    entries = [e for e in entries if not mark_of(passed_folder, e).exists()]
    if args.most is not None and len(entries) > args.most:
        print(f"tidy: {len(entries)} sources would have to be looked at, more than {args.most}; left to ./test all")
        return 0

    def check(entry):
        start = time.monotonic()
        done = subprocess.run(
            ["clang-tidy-14", "--quiet", "-p", args.build, entry["file"]], capture_output=True, text=True
        )
        if done.returncode == 0:
            mark_of(passed_folder, entry).touch()
        noise = done.stderr if done.returncode and not done.stdout.strip() else ""
        return entry, done.returncode == 0, time.monotonic() - start, done.stdout + noise

    bad = 0
    # Slowest first is unknown; largest first is near enough, so that no core idles at the end.
    entries.sort(key=lambda e: -e["path"].stat().st_size)
    with concurrent.futures.ThreadPoolExecutor(args.j) as pool:
        for entry, is_clean, seconds, text in pool.map(check, entries):
            if not is_clean:
                bad += 1
                print(f"{entry['path'].relative_to(ROOT)} ({seconds:.0f} s):\n{text}", flush=True)
    print(f"tidy: {len(entries)} of {chosen} sources looked at, the others unchanged; {bad} with findings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
