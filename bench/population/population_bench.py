#!/usr/bin/env python3
"""Populations of assemblies: ours against vectorised numpy in the same run.

    population_bench.py PROGRAM [COUNT]

PROGRAM is build/release/bench/population_bench. Both draw COUNT pairs of a 40 H7/k6 (normal sizes,
N = 20 stations, Rz 6.3 um), integrate the force over the depth and take its mean and five quantiles
at every station. Times are processor time, the least of a few passes.
"""
import json
import subprocess
import sys
import time

import numpy

SHARES = [0.001, 0.05, 0.5, 0.95, 0.999]


def draw_batch(count, seed, dtype):
    """Forces of a batch [N] at the 20 stations: mean and quantiles, as fits/population.h has them."""
    rng = numpy.random.default_rng(seed)
    # Radial clearance in micrometres: hole 0..25, shaft 2..18, sigma a sixth of the zone.
    hole = rng.normal(12.5, 25 / 6, count)
    shaft = rng.normal(10.0, 16 / 6, count)
    s = rng.random((21, count), dtype=dtype)
    s *= dtype(6.3)
    s += (0.5 * (hole - shaft) - 3.15).astype(dtype)
    # Integral of max(0, -s) over a step: (na + nb)^2 / (2 (|a| + |b|)).
    size = numpy.abs(s)
    negative = numpy.maximum(-s, 0)
    total = negative[:-1] + negative[1:]
    total *= total
    total /= 2 * (size[:-1] + size[1:])
    force = numpy.cumsum(total, axis=0)
    force *= dtype(0.15 * numpy.pi * 210e9 * 0.75 * 0.05 / 20 * 1e-6)
    return force.mean(axis=1), numpy.quantile(force, SHARES, axis=1)


def measure(count, dtype, passes):
    best = None
    for i in range(passes):
        start = time.process_time()
        mean, quantiles = draw_batch(count, i, dtype)
        best = min(best or 1e9, time.process_time() - start)
    return best, mean[-1], quantiles[1, -1], quantiles[3, -1]


def main():
    program = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    ours = json.loads(subprocess.run([program, str(count)], check=True, capture_output=True, text=True).stdout)
    rows = [("ours", ours["time_s"], ours["mean_n"], ours["q05_n"], ours["q95_n"])]
    for dtype in (numpy.float64, numpy.float32):
        rows.append((f"numpy {dtype.__name__}", *measure(count, dtype, 2)))
    print(f"{count} assemblies of 40 H7/k6, N = 20")
    print(f"{'':14s} {'time_s':>8s} {'per_s':>12s} {'ratio':>7s} {'mean_n':>9s} {'5%_n':>9s} {'95%_n':>9s}")
    for name, t, mean, low, high in rows:
        print(f"{name:14s} {t:8.3f} {count / t:12.0f} {t / rows[0][1]:7.1f} {mean:9.1f} {low:9.1f} {high:9.1f}")


if __name__ == "__main__":
    main()
