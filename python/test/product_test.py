import ast
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import hvas
from support import PRODUCTS, SOURCES


class Documentation(unittest.TestCase):
    def test_the_stubs_name_what_there_is_and_all_of_it(self):
        stubs = ast.parse((SOURCES / "python/hvas/_hvas.pyi").read_text())
        for node in stubs.body:
            if isinstance(node, ast.FunctionDef):
                self.assertTrue(callable(getattr(hvas._hvas, node.name)), node.name)
            elif isinstance(node, ast.ClassDef):
                listed = {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - {"__init__"}
                there = {name for name in dir(getattr(hvas._hvas, node.name)) if not name.startswith("_")}
                self.assertEqual(listed, there, node.name)

    def test_everything_that_is_called_says_what_it_does(self):
        for name in hvas.__all__:
            if name not in ("STATES", "__version__", "fits"):
                self.assertTrue(getattr(hvas, name).__doc__, name)


class Open(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.product = hvas.open(PRODUCTS / "bushing.step")

    def test_has_parts_occurrences_and_mates(self):
        product = self.product
        self.assertEqual([item.name for item in product.occurrences], ["chuck", "bushing", "shaft"])
        self.assertAlmostEqual(product.mass, 7.078, 3)
        fits = {mate.fit.code: mate.fit.nominal for mate in product.mates if mate.fit}
        self.assertEqual(set(fits), {"H7/h6", "H7/g6"})
        self.assertAlmostEqual(fits["H7/g6"], 40e-3, 9)
        shaft = next(mate for mate in product.mates if mate.fit and mate.fit.code == "H7/g6")
        self.assertEqual(product.occurrences[shaft.a].name, "bushing")
        np.testing.assert_allclose(shaft.frame[:2], 0, atol=1e-9)

    def test_triangles_are_seen_where_they_are_and_close_the_part(self):
        for part in self.product.parts:
            triangles, vertices = self.product.triangles(part.id), self.product.vertices(part.id)
            self.assertIsNotNone(triangles.base)
            corners = vertices[triangles]
            volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
            self.assertAlmostEqual(volume / part.volume, 1, 2)

    def test_features_have_their_radii(self):
        radii = {round(1e3 * feature.radius, 3) for feature in self.product.features(1) if feature.kind == "hole"}
        self.assertIn(20.0, radii)

    def test_errors_tell_what_where_and_what_to_do(self):
        with self.assertRaises(hvas.Error) as caught:
            hvas.open("/no/such/file.step")
        self.assertEqual((caught.exception.code, caught.exception.where), ("not-found", "/no/such/file.step"))
        self.assertTrue(caught.exception.remedy)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "broken.step"
            file.write_bytes((PRODUCTS / "bushing.step").read_bytes()[:20_000])
            with self.assertRaises(hvas.Error) as caught:
                hvas.open(file)
        self.assertIn("broken.step", str(caught.exception))
        with self.assertRaises(IndexError):
            self.product.features(99)

    def test_progress_is_called_and_may_end_the_work(self):
        stages = []
        hvas.open(PRODUCTS / "peg_hole.step", cache=False, progress=lambda stage, fraction: stages.append(fraction))
        self.assertTrue(stages)
        self.assertTrue(all(0 <= fraction <= 1 for fraction in stages))

        def stop(stage, fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            hvas.open(PRODUCTS / "gear_pump.step", cache=False, progress=stop)

    def test_writes_what_simulators_read(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("rig.mjcf", "rig.urdf", "rig.usda"):
                files = hvas.export(self.product, pathlib.Path(folder) / name)
                self.assertTrue(all(file.stat().st_size > 0 for file in files))
                self.assertIn("H7/g6", (pathlib.Path(folder) / name).read_text())
            with self.assertRaisesRegex(ValueError, "extension"):
                hvas.export(self.product, "rig.txt")

    def test_python_m_hvas_shows_a_file(self):
        run = subprocess.run([sys.executable, "-m", "hvas", "info", PRODUCTS / "bushing.step"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("40 mm H7/g6", run.stdout)
        run = subprocess.run([sys.executable, "-m", "hvas", "info", "/no/such"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("there is no such file", run.stderr)


if __name__ == "__main__":
    unittest.main()
