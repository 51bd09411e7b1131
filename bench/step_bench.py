"""The part of step_bench in Python: the same peg, led in the same way; PYTHONPATH has the package."""

import sys
import time

import numpy as np

import hvas
from hvas import gym


def main():
    seconds = float(sys.argv[1])
    model = gym.make("PegInHole", clearance=0.1e-3).model
    goal = np.array(model.steps[1].goal)

    def led(t):
        pose = goal.copy()
        pose[0] += 1e-3 if t > 0.4 else 0.0
        pose[2] += max(-5e-3, 46e-3 - 25e-3 * t)
        return pose

    run = hvas.Run(model, 1, start=led(0), contact_in_holes=True)
    deepest = 0.0
    begin, start = run.t, time.process_time()
    while run.t - begin < seconds:
        rows = run.step(pose=led(run.t - begin), ticks=10)
        deepest = max(deepest, -rows["deepest"].min())
    spent = time.process_time() - start
    print(f"{'hvas, Python':24s} {seconds / spent:8.1f} x real time, deepest contact {1e6 * deepest:7.2f} um, "
          f"{1e3 * (run.pose[2] - goal[2]):6.3f} mm from its place")


if __name__ == "__main__":
    main()
