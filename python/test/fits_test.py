import math
import unittest

import numpy as np

import hvas


class Limits(unittest.TestCase):
    def test_h7_g6_of_40_mm_is_that_of_the_standard(self):
        limits = hvas.fits.limits("H7/g6", 40e-3)
        self.assertEqual(limits.kind, "clearance")
        for value, um in [(limits.hole[0], 0), (limits.hole[1], 25), (limits.shaft[0], -25), (limits.shaft[1], -9),
                          (limits.min_clearance, 9), (limits.max_clearance, 50)]:
            self.assertAlmostEqual(1e6 * value, um, 9)

    def test_refuses_what_is_no_class(self):
        with self.assertRaises(hvas.Error) as caught:
            hvas.fits.limits("Q9/zz", 20e-3)
        self.assertEqual(caught.exception.code, "invalid")
        self.assertIn("H7", caught.exception.remedy)


class Press(unittest.TestCase):
    def test_a_solid_shaft_in_a_hub_twice_as_wide_has_lames_pressure(self):
        # Lame, equal materials, Q_A = 1/2, solid shaft: p = E U / D (1 - Q_A^2) / 2.
        diameter, length, interference, friction = 40e-3, 50e-3, 50e-6, 0.15
        fit = hvas.fits.press(diameter, length, interference, friction=friction)
        pressure = 210e9 * interference / diameter * (1 - 0.25) / 2
        self.assertAlmostEqual(fit.pressure / pressure, 1, 9)
        self.assertAlmostEqual(fit.press_in_force / (friction * math.pi * diameter * length * pressure), 1, 9)
        self.assertAlmostEqual(fit.hub_expansion + fit.shaft_contraction, interference, 12)


class Population(unittest.TestCase):
    def test_a_batch_is_within_its_limits_and_the_same_each_time(self):
        batch = hvas.fits.population("H7/p6", 40e-3, 50e-3, count=20_000, seed=3)
        again = hvas.fits.population("H7/p6", 40e-3, 50e-3, count=20_000, seed=3, threads=2)
        limits = hvas.fits.limits("H7/p6", 40e-3)
        self.assertAlmostEqual(batch.mean_clearance, (limits.min_clearance + limits.max_clearance) / 2, 6)
        self.assertEqual(batch.force_quantiles.shape, (len(batch.depth), len(batch.shares)))
        self.assertTrue(np.all(np.diff(batch.mean_force) > 0))
        self.assertTrue(np.all(np.diff(batch.force_quantiles, axis=1) >= 0))
        np.testing.assert_array_equal(batch.force_quantiles, again.force_quantiles)


if __name__ == "__main__":
    unittest.main()
