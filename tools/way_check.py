#!/usr/bin/env python3
"""Counts planned ways that the guided hand did not follow, from what was recorded.

    tools/way_check.py build/release/src/app/hvas products/gear_pump.step [more files]

For each part with a planned way it tells how far the displayed part stayed from that way at most: each pose of the way, 0.5 mm
apart, against the recorded pose that is nearest to it. A way is followed where that is at most 0.1 mm and 0.1 degrees, contact is
nowhere deeper than 20 um, and the part is in its place. Ways on which something gives or that are pressed are listed as such, and
do not count; parts without a planned way are not listed. The exit status is 1 where a way was not followed.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

SPACING_M = 0.5e-3
MOST_ASIDE_M = 0.1e-3
MOST_TURNED_DEG = 0.1
MOST_DEEP_UM = 20


def run(*command):
    done = subprocess.run([str(item) for item in command], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 2):
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def read_poses(table):
    """Displayed poses by part: rows of x y z [m] and a quaternion, w first."""
    poses = {}
    with open(table, newline="") as file:
        rows = csv.reader(file)
        header = next(rows)
        first = header.index("shown_x_m")
        part = header.index("occurrence")
        for row in rows:
            if int(row[part]) >= 0:
                poses.setdefault(int(row[part]), []).append([float(x) for x in row[first : first + 7]])
    return {key: np.array(value) for key, value in poses.items()}


def sample_way(step, place):
    """Poses of a way, outward from its place, like those of read_poses()."""
    if step.get("way"):
        return np.array([pose["X_WB"] for pose in step["way"]])
    count = max(1, round(step["engage_distance_m"] / SPACING_M))
    way = np.repeat(place[None, :], count + 1, axis=0)
    way[:, :3] += np.outer(np.linspace(0, step["engage_distance_m"], count + 1), step["extraction_W"])
    return way


def measure(way, shown):
    """How far the recorded poses miss the way at most: distance [m], turn [deg]."""
    aside = turned = 0.0
    for pose in way:
        distance = np.linalg.norm(shown[:, :3] - pose[:3], axis=1)
        angle = 2 * np.degrees(np.arccos(np.clip(np.abs(shown[:, 3:] @ pose[3:]), 0, 1)))
        nearest = np.argmin(np.maximum(distance / MOST_ASIDE_M, angle / MOST_TURNED_DEG))
        aside = max(aside, distance[nearest])
        turned = max(turned, angle[nearest])
    return aside, turned


def check(hvas, file, every):
    """Prints the planned ways of a product; returns how many were not followed."""
    with tempfile.TemporaryDirectory() as folder:
        record = pathlib.Path(folder) / "run.hvasrec"
        table = pathlib.Path(folder) / "run.csv"
        result = json.loads(run(hvas, "assemble", file, "--json", "--quiet", "--record", record))
        plan = json.loads(run(hvas, "plan", file, "--json", "--quiet", "--orders", 1))
        run(hvas, "export", record, "-o", table, "--every", every)
        poses = read_poses(table)
    parts = {part["id"]: part for part in result["parts"]}
    planned = missed = 0
    for step in plan["followed"]["steps"]:
        part = parts.get(step["occurrence"])
        if step["kind"] != "insert" or part is None:
            continue
        planned += 1
        shown = poses.get(step["occurrence"])
        if not part["seated"] or shown is None:
            aside, turned, followed = np.inf, np.inf, False
        else:
            aside, turned = measure(sample_way(step, shown[-1]), shown)
            followed = aside <= MOST_ASIDE_M and turned <= MOST_TURNED_DEG and part["deepest_um"] <= MOST_DEEP_UM
        gives = bool(part["allowances"]) or part["needs_press"]
        missed += not followed and not gives
        word = "followed" if followed else "gives or is pressed" if gives else "NOT FOLLOWED"
        print(f"  {part['name']}: {1e3 * aside:.3f} mm, {turned:.3f} deg, {part['deepest_um']:.1f} um, {part['peak_true_n']:.1f} N: {word}")
    print(f"{pathlib.Path(file).name}: {planned} planned ways, {missed} not followed")
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hvas", type=pathlib.Path)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--every", type=int, default=2, help="ticks from one recorded pose to the next that is looked at")
    arguments = parser.parse_args()
    missed = sum(check(arguments.hvas, file, arguments.every) for file in arguments.files)
    print(f"{missed} ways not followed")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
