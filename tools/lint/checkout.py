"""What the lints of sources share: which checkout they look at, and how they tell what they found."""

import argparse
import pathlib
import sys


def parse_root(description):
    """The folder that --root names; the checkout of this file without it."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    return parser.parse_args().root


def list_sources(root):
    """Headers and sources below src/, without those of tests."""
    paths = sorted((root / "src").rglob("*"))
    return [path for path in paths if path.suffix in (".h", ".cc", ".inc") and "test" not in path.parts]


def report(problems, summary):
    """Prints each problem, or the summary where there is none. Returns the exit status."""
    for problem in problems:
        print(problem, file=sys.stderr)
    if not problems:
        print(summary)
    return 1 if problems else 0
