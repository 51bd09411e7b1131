import unittest

import numpy as np

import hvas
from hvas import gym


def straight_in(environment, observation):
    """Down, towards the axis, and upright: what goes into a bore with play."""
    position, turn = observation[:3], observation[3:6]
    down = [0, 0, -0.5 * environment.reach]
    towards = np.array([*(-0.1 * position[:2]), 0.0])
    return np.clip([*((towards + down) / environment.reach), *(-0.1 * turn / environment.turn)], -1, 1)


def play(environment, seed):
    observation, info = environment.reset(seed=seed)
    total = 0.0
    while True:
        observation, reward, terminated, truncated, info = environment.step(straight_in(environment, observation))
        total += reward
        if terminated or truncated:
            return terminated, total, info, observation


class PegInHole(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.environment = gym.make("PegInHole", clearance=0.1e-3)

    def test_a_policy_of_five_lines_puts_it_in_99_times_of_100(self):
        seated = sum(play(self.environment, seed)[0] for seed in range(100))
        self.assertGreaterEqual(seated, 99)

    def test_the_same_seed_is_the_same_episode(self):
        first, second = play(self.environment, 7), play(self.environment, 7)
        np.testing.assert_array_equal(first[3], second[3])
        self.assertEqual(first[1], second[1])

    def test_spaces_have_what_it_gives_and_takes(self):
        observation, info = self.environment.reset(seed=1)
        self.assertTrue(self.environment.observation_space.contains(observation))
        self.environment.action_space.seed(1)
        for _ in range(20):
            action = self.environment.action_space.sample()
            self.assertTrue(self.environment.action_space.contains(action))
            observation, reward, terminated, truncated, info = self.environment.step(action)
            self.assertTrue(self.environment.observation_space.contains(observation))
            self.assertTrue(np.isfinite(reward))
        with self.assertRaises(ValueError):
            self.environment.step([np.nan] * 6)
        with self.assertRaises(ValueError):
            self.environment.step([0, 0])

    def test_the_arm_holds_the_part_up_while_nothing_is_asked_of_it(self):
        observation, _ = self.environment.reset(seed=2)
        height = observation[2]
        for _ in range(50):
            observation, *_ = self.environment.step(np.zeros(6))
        self.assertAlmostEqual(observation[2], height, delta=1e-3)

    def test_a_wrench_presses_as_hard_as_it_says(self):
        environment = gym.Insertion(self.environment.model, mode="wrench", seeds_fits=False, offset=0, tilt=0, force=5.0)
        environment.reset(seed=1)
        for _ in range(500):
            observation, _, terminated, truncated, _ = environment.step([0, 0, -0.4, 0, 0, 0])
            if terminated:
                break
        self.assertTrue(terminated)

    def test_friction_is_felt_along_a_bore(self):
        def drag(friction):
            environment = gym.Insertion(self.environment.model, seeds_fits=False, friction=friction, offset=0, tilt=0)
            observation, _ = environment.reset(seed=1)
            felt = []
            for step in range(100):  # Into the bore, then pressed against its wall on the way.
                action = [0.5 if 30 < step < 45 else 0, 0, -0.4, 0, 0, 0]
                observation, *_ = environment.step(action)
                if step > 60:
                    felt.append(observation[8] - (-environment._load[2]))
            return np.mean(felt)  # Of the force along the axis, beyond the load.

        low, high = drag(0.05), drag(0.4)
        self.assertGreater(high, low + 0.2)
        with self.assertRaises(ValueError):
            self.environment.model.with_friction(-1)

    def test_pictures_show_the_part_come_nearer(self):
        environment = gym.Insertion(self.environment.model, seeds_fits=False, picture=(64, 48), render_mode="rgb_array")
        observation, _ = environment.reset(seed=1)
        self.assertTrue(environment.observation_space.contains(observation))
        first = observation["picture"]
        for _ in range(60):
            observation, *_ = environment.step(straight_in(environment, observation["numbers"]))
        drawn = [np.any(picture < 250, axis=2) for picture in (first, observation["picture"])]
        tops = [np.nonzero(picture.any(axis=1))[0][0] for picture in drawn]
        self.assertGreater(tops[1], tops[0])  # The peg's upper end is lower.
        self.assertEqual(environment.render().shape, (480, 640, 3))

    def test_conforms_to_gymnasium(self):
        try:
            from gymnasium.utils.env_checker import check_env
        except ImportError:
            self.skipTest("Gymnasium is not installed")
        check_env(self.environment, skip_render_check=True)


class Others(unittest.TestCase):
    def test_gear_and_press_fit_begin_and_end(self):
        for name in ("GearOnShaft", "PressFit"):
            environment = gym.make(name, limit_s=0.2)
            self.assertTrue(np.all(np.isfinite(environment.reset(seed=1)[0])))
            *_, terminated, truncated, info = environment.step(np.zeros(6))
            self.assertFalse(terminated)
            while not truncated:
                *_, terminated, truncated, info = environment.step(np.zeros(6))
            self.assertGreaterEqual(info["t"], 0.2)
        with self.assertRaisesRegex(ValueError, "PegInHole"):
            gym.make("Nothing")

    def test_does_what_gymnasiums_check_looks_for(self):
        """The assertions and warnings of check_env of Gymnasium 0.29, with the stand-ins."""
        for options in ({}, {"picture": (32, 24), "render_mode": "rgb_array"}):
            environment = gym.make("PegInHole", **options)
            self.assertIs(environment.unwrapped, environment)
            self.assertTrue(np.all(environment.action_space.low == -1) and np.all(environment.action_space.high == 1))
            space = environment.observation_space
            for box in space.values() if options else [space]:
                self.assertTrue(np.all(np.isfinite(box.low)) and np.all(np.isfinite(box.high)) and np.all(box.low < box.high))
            self.assertFalse(hasattr(environment, "seed"))

            def reset(**arguments):
                observation, info = environment.reset(**arguments)
                self.assertIn(observation, space)
                self.assertIsInstance(info, dict)
                return observation, environment.unwrapped._np_random.bit_generator.state

            first, state = reset(seed=123)
            again, same = reset(seed=123)
            numbers = (first["numbers"], again["numbers"]) if options else (first, again)
            np.testing.assert_array_equal(*numbers)
            self.assertEqual(state, same)
            self.assertNotEqual(reset(seed=456)[1], state)
            reset(options={})
            observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())
            self.assertIn(observation, space)
            self.assertTrue(np.isscalar(reward) and np.isfinite(reward))
            self.assertIsInstance(terminated, (bool, np.bool_))
            self.assertIsInstance(truncated, (bool, np.bool_))
            self.assertIsInstance(info, dict)
            if options:
                self.assertIn(environment.render_mode, environment.metadata["render_modes"])
                picture = environment.render()
                self.assertEqual((picture.dtype, picture.ndim, picture.shape[2]), (np.uint8, 3, 3))
            environment.close()
            environment.close()

    def test_a_nut_is_turned_onto_its_bolt_from_any_angle_and_tightened(self):
        environment = gym.make("NutOnBolt")
        bolt = 24.5  # Torque of an M8 of property class 8.8 with friction 0.12 (VDI 2230-1) [N m].
        for seed in range(5):
            observation, _ = environment.reset(seed=seed)
            torque = 0.0
            while True:
                across, turn = observation[:2], observation[3:5]
                action = [*(-0.1 * across / environment.reach), -0.3, *(-0.1 * turn / environment.turn), -1.0]
                observation, reward, terminated, truncated, info = environment.step(np.clip(action, -1, 1))
                torque = max(torque, environment.run.rows["tightening"].max())
                if terminated or truncated:
                    break
            self.assertTrue(terminated, (seed, observation))
            self.assertGreater(torque, 0.9 * bolt)
            self.assertLess(torque, 1.1 * bolt)

    def test_a_vector_of_environments_is_what_each_gives(self):
        model = gym.make("PegInHole").model
        vector = gym.Vector(lambda: gym.Insertion(model, seeds_fits=False), 4)
        single = gym.Insertion(model, seeds_fits=False)
        observations, _ = vector.reset(seed=5)
        np.testing.assert_array_equal(observations[2], single.reset(seed=7)[0])
        actions = np.full((4, 6), 0.1)
        observations, rewards, terminated, truncated, infos = vector.step(actions)
        np.testing.assert_array_equal(observations[2], single.step(actions[2])[0])
        self.assertEqual((rewards.shape, len(infos)), ((4,), 4))
        vector.close()

    def test_a_part_that_no_step_puts_in_is_an_error(self):
        with self.assertRaises(hvas.Error):
            gym.make("PartOf", file=gym._products() / "peg_hole.step", path="no such part")


if __name__ == "__main__":
    unittest.main()
