import gc
import hashlib
import pathlib
import tempfile
import threading
import unittest

import numpy as np

import hvas
from support import PRODUCTS

BUSHING_DIGEST = "843a85d5bc4c76e4176ead5c0adc7136"  # That of `hvas assemble products/bushing.step`.


class Assembly(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = hvas.prepare(hvas.open(PRODUCTS / "bushing.step"))

    def test_has_the_digest_of_the_program(self):
        parts = []
        outcome = self.model.assemble(on_part=parts.append)
        self.assertTrue(outcome.complete)
        self.assertEqual(outcome.digest, BUSHING_DIGEST)
        self.assertEqual([part.path for part in parts if part.seated], ["bushing rig/bushing", "bushing rig/shaft"])

    def test_on_part_may_end_the_run(self):
        def stop(part):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            self.model.assemble(on_part=stop)

    def test_plans_orders_with_weights(self):
        orders = self.model.plan(orders=2, weights={"turn": 8})
        self.assertEqual(orders[0].parts, ["bushing rig/bushing", "bushing rig/shaft"])
        with self.assertRaisesRegex(ValueError, "there are .*turn"):
            self.model.plan(weights={"speed": 1})
        with self.assertRaises(hvas.Error):
            self.model.plan(before=[("nothing", "shaft")])

    def test_a_record_has_arrays_events_and_replays_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "session.hvasrec"
            outcome = self.model.assemble(record=file)
            record = hvas.Record(file)
            self.assertTrue(record.complete)
            self.assertEqual(record.verify(), outcome.digest)
            ticks = record.ticks()
            self.assertTrue(all(len(column) == record.tick_count == outcome.ticks for column in ticks.values()))
            self.assertEqual(len(record.ticks(every=10)["time_s"]), -(-outcome.ticks // 10))
            events = record.events()
            self.assertEqual([event.occurrence for event in events if event.kind == "taken"], [1, 2])
            self.assertTrue(all(isinstance(event.details, dict) for event in events))
            report = record.replay()
            self.assertTrue(report.exact)
            self.assertEqual(report.ticks, outcome.ticks)
            file.write_bytes(file.read_bytes()[:4096] + b"\0" * 4096)
            with self.assertRaises(hvas.Error):
                hvas.Record(file).verify()

    def test_other_sizes_are_drawn_without_preparing_again(self):
        other = self.model.with_seed(2)
        self.assertEqual((self.model.seed, other.seed), (1, 2))
        self.assertEqual(other.assemble().digest, hvas.prepare(hvas.open(PRODUCTS / "bushing.step"), seed=2).assemble().digest)


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = hvas.prepare(hvas.open(PRODUCTS / "peg_hole.step"))
        cls.goal = np.array(cls.model.steps[1].goal)

    def start(self, above, **options):
        pose = self.goal.copy()
        pose[2] += above
        return hvas.Run(self.model, 1, start=pose, **options)

    def lead_in(self, run):
        pose = self.goal.copy()
        for i in range(200):
            pose[2] = self.goal[2] + max(-0.01, 0.06 - 0.5e-3 * i)
            run.step(pose=pose, ticks=10)
        return run

    def test_a_peg_that_is_led_in_is_seated(self):
        run = self.lead_in(self.start(0.06))
        self.assertTrue(run.seated)
        np.testing.assert_allclose(run.pose[:3], self.goal[:3], atol=1e-6)

    def test_the_hand_feels_the_weight(self):
        run = self.start(0.1)
        run.step(ticks=3000)
        row = run.rows[-1]
        self.assertAlmostEqual(row["F_true_W"][2], -9.81 * run.mass, 6)
        # Felt by the map of forces, which is monotone; the arm's spring of 400 N/m holds that up.
        self.assertTrue(-9.81 * run.mass < run.force[2] < -0.5 * 9.81 * run.mass)
        sag = self.goal[2] + 0.1 - run.led[2]
        self.assertAlmostEqual(400 * sag, -run.force[2], 4)

    def test_rows_are_views_that_keep_the_run_alive(self):
        run = self.start(0.1)
        rows = run.step(ticks=7)
        self.assertEqual((len(rows), rows["X_WH"].shape), (7, (7, 7)))
        self.assertFalse(rows.flags.owndata)
        np.testing.assert_allclose(np.diff(rows["t_s"]), 1e-3, atol=1e-12)
        del run
        gc.collect()
        self.assertTrue(np.all(np.isfinite(rows["F_felt_W"])))

    def test_contacts_are_all_that_press_and_carry_the_part(self):
        pose = self.goal + np.array([5e-3, 0, 0.05, 0, 0, 0, 0])  # Over the rim of the bore.
        run = hvas.Run(self.model, 1, start=pose, condition="collision")
        pose[2] -= 0.02
        run.step(pose=pose, ticks=3000)
        contacts, row = run.contacts, run.rows[-1]
        self.assertFalse(contacts.flags.owndata)
        self.assertGreater(len(contacts), 0)
        self.assertEqual(len(contacts), row["contacts"])
        hardest = contacts[np.argmax(np.linalg.norm(contacts["f_C_W"], axis=1))]
        np.testing.assert_array_equal(hardest["p_WC"], row["p_WC"])
        np.testing.assert_array_equal(hardest["f_C_W"], row["f_C_W"])
        self.assertTrue(np.all(contacts["other"] == 0))
        self.assertTrue(np.all(contacts["distance"] > -100e-6))
        held = contacts["f_C_W"].sum(axis=0)[2]
        self.assertGreater(held, 5)
        self.assertAlmostEqual(row["F_true_W"][2], held - 9.81 * run.mass, delta=0.1)

    def test_a_hundred_runs_of_one_seed_have_the_same_digest(self):
        digests = set()
        for _ in range(100):
            run = self.start(0.045)
            digest = hashlib.sha256()
            for _ in range(20):
                digest.update(run.step(pose=self.goal, ticks=10).tobytes())
            digests.add(digest.hexdigest())
        self.assertEqual(len(digests), 1)

    def test_the_lock_of_the_interpreter_is_free_while_ticks_run(self):
        run = self.start(0.1)
        counted = []
        done = threading.Event()

        def count():
            while not done.is_set():
                counted.append(1)

        counter = threading.Thread(target=count)
        counter.start()
        run.step(ticks=5000)
        done.set()
        counter.join()
        self.assertGreater(len(counted), 1000)

    def test_refuses_what_is_no_pose_step_or_number_of_ticks(self):
        run = self.start(0.1)
        for bad in [dict(pose=[0, 0, 0]), dict(pose=[0, 0, 0, 2, 0, 0, 0]), dict(pose=[0, 0, float("nan"), 1, 0, 0, 0]),
                    dict(ticks=0), dict(force=[0, 0, float("inf")])]:
            with self.subTest(bad), self.assertRaises(ValueError):
                run.step(**bad)
        with self.assertRaises(hvas.Error):
            hvas.Run(self.model, 0)
        with self.assertRaises(ValueError):
            hvas.Run(self.model, 1, condition="none")


if __name__ == "__main__":
    unittest.main()
