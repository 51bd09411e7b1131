#!/usr/bin/env python3
"""Draws docs/pictures/fit_curves.svg: curves.py PROGRAM OUT. The force curves of paper W's Fig. 8, above as
`hvas fit paper` computes them, below as a simulated person gets them in the hand with the paper's force map."""

import argparse
import csv
import pathlib
import statistics
import subprocess
import tempfile

from figures import BLUE, GREEN, GREY, INK, PALE, RED, Drawing

# Experiment of the paper, fit, its largest displayed force in the figure [N].
EXPERIMENTS = (("B1", "H7/g6", "clearance", 0.4), ("B2", "H7/p6", "interference", 8.0), ("B3", "H7/k6", "transition", 6.0))
SEED = "1"
MATING = "4"   # HoldState::kMating
NOTHING = "-1"  # Occurrence of a hand that holds none.
SETTLED = 10   # The hand moves evenly from this depth on [mm].
WIDTH, HEIGHT, LEFT, TOP, GAP_X, GAP_Y = 270, 150, 64, 62, 40, 76


def run(program, *arguments):
    subprocess.run([program, *arguments], check=True, capture_output=True)


def read_rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def read_hand(program, fit, folder):
    """Depth [mm] and felt axial force [N] while the shaft goes in."""
    record, table = folder / "run.hvasrec", folder / "run.csv"
    run(program, "assemble", "products/bushing.step", "--fit", f"shaft={fit}", "--force-map", "paper", "--seed", SEED,
        "--record", str(record), "--force", "-q")
    run(program, "export", str(record), "-o", str(table), "--force")
    points, deepest = [], 0.0
    rows = read_rows(table)
    shaft = next(row["occurrence"] for row in reversed(rows) if row["occurrence"] != NOTHING)
    for row in rows:
        depth = 1e3 * float(row["insertion_m"] or 0)
        if row["occurrence"] == shaft and row["state"] == MATING and depth > deepest:
            deepest = depth
            points.append((depth, float(row["felt_fz_n"])))
    return points


def read_paper(program, folder):
    """Depth [mm] and displayed axial force [N] of each experiment."""
    table = folder / "paper.csv"
    run(program, "fit", "paper", "--curve", str(table), "--seed", SEED)
    return read_rows(table)


def draw_panel(d, column, row, curve, most, color, title):
    x0, y0 = LEFT + column * (WIDTH + GAP_X), TOP + row * (HEIGHT + GAP_Y)
    d.box(x0, y0, WIDTH, HEIGHT, "white", PALE, 0, line=1)
    d.text(x0, y0 - 8, title, 12.5, INK)
    for share in (0, 0.5, 1):
        d.text(x0 - 6, y0 + HEIGHT * (1 - share) + 4, f"{share * most:g}", 11, GREY, "end")
        d.line([(x0, y0 + HEIGHT * (1 - share)), (x0 + WIDTH, y0 + HEIGHT * (1 - share))], PALE, 0.7)
    for depth in (0, 10, 20, 30, 40, 50):
        d.text(x0 + WIDTH * depth / 50, y0 + HEIGHT + 16, str(depth), 11, GREY, "middle")
    points = [(x0 + WIDTH * min(depth, 50) / 50, y0 + HEIGHT * (1 - max(-0.05, min(force / most, 1.05)))) for depth, force in curve]
    d.line(points[:: max(1, len(points) // 600)], color, 1.6)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    d = Drawing(LEFT + 3 * (WIDTH + GAP_X), TOP + 2 * (HEIGHT + GAP_Y), "Force curves of three fits, computed and in the hand")
    d.text(LEFT, 24, "Axial force in the hand [N] over the depth of insertion [mm], with the factors of paper W", 14, GREY)
    d.text(LEFT, TOP + 2 * HEIGHT + GAP_Y + 44, "In the hand: less weight and drag of the moving hand, which the clearance fit shows alone", 12, GREY)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        paper = read_paper(options.program, folder)
        # Weight and drag of the moving hand are in all three; where there is clearance, nothing else is.
        hands = [read_hand(options.program, fit, folder) for _, fit, _, _ in EXPERIMENTS]
        drag = statistics.median(force for depth, force in hands[0] if depth > SETTLED)
        for column, (experiment, fit, kind, most) in enumerate(EXPERIMENTS):
            color = (GREEN, RED, BLUE)[column]
            curve = [(float(row["depth_mm"]), float(row["shown_n"])) for row in paper if row["experiment"] == experiment]
            draw_panel(d, column, 0, curve, most, color, f"{experiment}, {fit} ({kind}): hvas fit paper")
            draw_panel(d, column, 1, [(depth, force - drag) for depth, force in hands[column]], most, color, "in the hand: hvas assemble, seed " + SEED)
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "fit_curves.svg").write_text(str(d))


if __name__ == "__main__":
    main()
