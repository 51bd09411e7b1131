#!/usr/bin/env python3
"""Runs the commands of the README and the tutorials, and compares what they print with what the pages show.

    tutorials.py HVAS [PAGE...]       PAGE: as docs/tutorials/headless.md; without, README.md and all of docs/tutorials/
    tutorials.py HVAS --update [...]  writes what the commands print into the pages; parts that "..." stands for stay out

A block that begins with ```console is run: lines that begin with "$ " are commands (also over several lines, with a
backslash at the end), the others are what they print. "..." stands for anything. The blocks of a page are one
session in an empty folder, in which `products` and `data` are those of the checkout and `hvas` is the program. A
block ```console until-shown ends its last command when it has printed what is shown, as Ctrl+C does. A block
```yaml file=NAME, or of another language, is written to that file first. Blocks of other kinds are not looked at.

Words have to be the same, and numbers within a twentieth of each other: another compiler rounds otherwise. What
changes with every run or machine is not compared: times that the computation took, addresses, digests, deviations of
rounding (numbers written with an exponent).
"""

import argparse
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
# What is not the same on another machine, or in the next run.
CHANGING = [
    (re.compile(r"prepared in[^)]*?\(contact.*?processor\s+time, [\d.]+ x\)", re.DOTALL), "prepared in some time"),
    (re.compile(r"tick compute:.*?\)", re.DOTALL), "tick compute: some time"),
    (re.compile(r"slowest tick:.*?\scontacts", re.DOTALL), "slowest tick: some time"),
    (re.compile(r"run again in [\d.]+ s, [\d.]+ times as\s+fast"), "run again in some time"),
    (re.compile(r"^In [\d.]+ s\.", re.MULTILINE), "In some time."),
    (re.compile(r"http://127\.0\.0\.1:\d+/#t=[\w-]+"), "http://127.0.0.1/"),
    (re.compile(r"\b[0-9a-f]{32}\b"), "some-digest"),
    (re.compile(r"\d(?:\.\d+)?e[-+]\d+"), "about-nothing"),
]
TOKEN = re.compile(r"\.\.\.(?=\s|$)|[-+]?\d+(?:\.\d+)?|[^\W\d]+|\S")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?$")
PATIENCE_S = 300
TOLERANCE = 0.05  # of a number
GAP = "..."


def tokens_of(text):
    for pattern, stand_in in CHANGING:
        text = pattern.sub(stand_in, text)
    return TOKEN.findall(text)


def is_same(shown, printed, tolerance):
    if tolerance > 0 and NUMBER.match(shown) and NUMBER.match(printed):
        a, b = float(shown), float(printed)
        # A last digit more or less is no difference, either.
        last = 10.0 ** -len(shown.partition(".")[2]) if "." in shown else 0.0
        return abs(a - b) <= max(tolerance * max(abs(a), abs(b)), 1.5 * last)
    return shown == printed


def find_run(run, tokens, start, tolerance=TOLERANCE):
    """The first place from `start` on at which these tokens follow each other; None when there is none."""
    for at in range(start, len(tokens) - len(run) + 1):
        if all(is_same(a, b, tolerance) for a, b in zip(run, tokens[at:at + len(run)])):
            return at
    return None


def split_at_gaps(tokens):
    runs = [[]]
    for token in tokens:
        if token == GAP:
            runs.append([])
        else:
            runs[-1].append(token)
    return runs


def find_difference(shown, printed, tolerance=TOLERANCE):
    """In words, what is shown and was not printed; None where all of it was."""
    expected, tokens = split_at_gaps(tokens_of(shown)), tokens_of(printed)
    at = 0
    for index, run in enumerate(expected):
        is_last = index == len(expected) - 1
        if index == 0:
            found = 0 if find_run(run, tokens[:len(run)], 0, tolerance) == 0 or not run else None
        elif is_last and run:
            found = find_run(run, tokens, max(at, len(tokens) - len(run)), tolerance)
        else:
            found = find_run(run, tokens, at, tolerance)
        if found is None:
            return "not printed: " + " ".join(run)
        at = found + len(run)
    if len(expected) == 1 and at != len(tokens):
        return "printed, but not shown: " + " ".join(tokens[at:])
    return None


def update(shown, printed):
    """What was printed, with the same cuts as before: between them, as many lines as there were."""
    lines, old = printed.splitlines(), shown.splitlines()
    cuts = [index for index, line in enumerate(old) if line.strip() == GAP]
    if not cuts:
        return printed if printed.endswith("\n") or not printed else printed + "\n"
    head, tail = cuts[0], len(old) - cuts[-1] - 1
    kept = lines[:head] + [GAP]
    at = head
    for first, last in zip(cuts, cuts[1:]):
        middle = old[first + 1:last]
        words = tokens_of(middle[0])
        at = next((k for k in range(at, len(lines)) if find_run(words, tokens_of(lines[k]), 0) == 0), None)
        if at is None:
            raise ValueError(f"not printed any more, mend it by hand: {middle[0]}")
        kept += lines[at:at + len(middle)] + [GAP]
        at += len(middle)
    return "\n".join(kept + (lines[-tail:] if tail else [])) + "\n"


def split_steps(block):
    """Pairs of a command and what is shown of its output."""
    steps, lines = [], block.splitlines()
    while lines:
        line = lines.pop(0)
        if not line.startswith("$ "):
            if not steps:
                raise ValueError(f"no command before: {line}")
            steps[-1][1].append(line)
            continue
        while line.endswith("\\") and lines:
            line += "\n" + lines.pop(0)
        steps.append((line, []))
    return [(command, "".join(line + "\n" for line in shown)) for command, shown in steps]


class Session:
    """Commands one after the other, each in a shell of its own that begins where the one before has ended."""

    def __init__(self, hvas, folder):
        self.folder = self.place = folder
        tools = folder / ".tools"
        tools.mkdir()
        # A script and no link: the program looks beside itself for what it starts.
        (tools / "hvas").write_text(f'#!/bin/sh\nexec {shlex.quote(str(hvas))} "$@"\n')
        (tools / "hvas").chmod(0o755)
        for name in ("products", "data"):
            (folder / name).symlink_to(ROOT / name)
        private = {f"XDG_{kind}_HOME": str(folder / f".{kind.lower()}") for kind in ("CACHE", "DATA", "STATE")}
        path = f"{tools}{os.pathsep}{os.environ['PATH']}"
        self.environment = {**os.environ, **private, "PATH": path, "NO_COLOR": "1", "COLUMNS": "80", "LC_ALL": "C.UTF-8"}

    def run(self, command, shown, ends_when_shown):
        """What it prints, both streams together, as on a terminal."""
        words = command.removeprefix("$ ")
        marked = f"{words}\nstatus=$?; pwd >&9; exit $status"
        place = self.folder / ".place"
        with open(place, "w") as file, subprocess.Popen(
            ["bash", "-c", f"exec 9>{shlex.quote(file.name)}\n" + (f"exec {words}" if ends_when_shown else marked)],
            cwd=self.place, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, start_new_session=True) as process:
            try:
                text = self.read(process, shown, ends_when_shown)
            finally:
                try:
                    os.killpg(process.pid, signal.SIGTERM if ends_when_shown else signal.SIGKILL)
                except ProcessLookupError:
                    pass
        if process.returncode != 0 and not ends_when_shown:
            text += f"[exit status {process.returncode}]\n"
        self.place = place.read_text().strip() or self.place
        return text

    @staticmethod
    def read(process, shown, ends_when_shown):
        os.set_blocking(process.stdout.fileno(), False)
        data, end = b"", time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            has_ended = process.poll() is not None
            data += process.stdout.read() or b""
            text = data.decode(errors="replace")
            if has_ended or (ends_when_shown and find_difference(shown, text) is None):
                return text
            time.sleep(0.02)
        return text + f"[not done after {PATIENCE_S} s]\n"


def run_page(page, hvas, is_update):
    """Faults of a page, each with its line."""
    text = page.read_text()
    parts, at, faults = [], 0, []
    with tempfile.TemporaryDirectory(prefix="hvas-tutorial-") as name:
        session = Session(hvas, pathlib.Path(name))
        for match in BLOCK.finditer(text):
            language, *words = match.group(1).split() or [""]
            for word in words:
                if word.startswith("file="):
                    (pathlib.Path(session.place) / word.removeprefix("file=")).write_text(match.group(2))
            if language != "console":
                continue
            steps, written = split_steps(match.group(2)), ""
            for index, (command, shown) in enumerate(steps):
                ends = "until-shown" in words and index == len(steps) - 1
                printed = session.run(command, shown, ends)
                fault = find_difference(shown, printed, 0 if is_update else TOLERANCE)
                if is_update and fault is not None:
                    print(f"{page.name}: {command}", file=sys.stderr)
                    shown = update(shown, printed)
                elif fault is not None:
                    line = text.count("\n", 0, match.start()) + 1
                    faults.append(f"{page}:{line}: {command}\n  {fault}\n" + re.sub(r"^", "  | ", printed, flags=re.MULTILINE))
                written += command + "\n" + shown
            parts += [text[at:match.start(2)], written]
            at = match.end(2)
    if is_update:
        page.write_text("".join(parts) + text[at:])
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hvas", type=pathlib.Path)
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    given = parser.parse_intermixed_args()
    pages = given.pages or [ROOT / "README.md", *sorted((ROOT / "docs/tutorials").glob("*.md"))]
    faults = []
    for page in pages:
        began = time.monotonic()
        found = run_page(page, given.hvas.resolve(), given.update)
        print(f"{page.name}: {len(found)} faults, {time.monotonic() - began:.1f} s")
        faults += found
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
