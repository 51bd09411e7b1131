"""Environments to learn in: a part in the hand that has to go to its place, with the forces that a hand would feel.

The interface is Gymnasium's. Where Gymnasium is installed, the classes are its own and the environments are registered
("hvas/PegInHole-v0" and so on); where it is not, small stand-ins with the same methods take their place.

    from hvas import gym
    env = gym.make("PegInHole", clearance=0.1e-3)
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

import json
import math
import os
import pathlib
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import hvas
from hvas._hvas import check_integer, check_number

try:
    import gymnasium
    from gymnasium.spaces import Box, Dict
    Base = gymnasium.Env
except ImportError:
    gymnasium = None

    class Box:
        """Arrays between two bounds; the part of gymnasium.spaces.Box that the environments need."""

        def __init__(self, low, high, shape, dtype=np.float32):
            self.low = np.broadcast_to(np.asarray(low, dtype), shape)
            self.high = np.broadcast_to(np.asarray(high, dtype), shape)
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self._random = np.random.default_rng()

        def seed(self, seed=None):
            self._random = np.random.default_rng(seed)
            return [seed]

        def sample(self):
            finite = np.isfinite(self.low) & np.isfinite(self.high)
            uniform = self._random.uniform(np.where(finite, self.low, 0), np.where(finite, self.high, 1))
            return np.where(finite, uniform, self._random.normal(size=self.shape)).astype(self.dtype)

        def contains(self, x):
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

        __contains__ = contains

        def __repr__(self):
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    class Dict:
        """Several spaces by their names; the part of gymnasium.spaces.Dict that the environments need."""

        def __init__(self, spaces):
            self.spaces = dict(spaces)

        def __getitem__(self, name):
            return self.spaces[name]

        def values(self):
            return self.spaces.values()

        def sample(self):
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, x):
            return x.keys() == self.spaces.keys() and all(space.contains(x[name]) for name, space in self.spaces.items())

        __contains__ = contains

    class Base:
        """What gymnasium.Env gives its environments."""

        spec = None
        _np_random = None

        @property
        def np_random(self):
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        def reset(self, *, seed=None, options=None):
            if seed is not None:
                self._np_random = np.random.default_rng(seed)

        @property
        def unwrapped(self):
            return self

        def close(self):
            pass


OBSERVATION = (
    "position of the part less its place, in the frame of its place [m] (3)",
    "rotation vector from its place, the shorter way round [rad] (3)",
    "force on the hand [N] (3) and torque [N m] (3), in the frame of its place",
    "depth of insertion [m]",
    "contacts that press",
)
"""What the numbers of an observation are."""

# Bounds of them: a part 10 m away, half a turn, ten times what any device gives, 128 contacts.
_MOST = np.array([10.0] * 3 + [math.pi + 1e-9] * 3 + [1000.0] * 3 + [100.0] * 3 + [10.0, 128.0])


# Limits of what an environment may be made with: a product of 10 m, ten times the force of any device, half an hour of ticks
# in one step, a session of an hour, a friction as a side file may state it, a picture of 4096 pixels. Choices.
_MOST_LENGTH, _MOST_FORCE, _MOST_TICKS, _MOST_TIME, _MOST_FRICTION, _MOST_PIXELS = 10.0, 1000.0, 1_000_000, 3600.0, 2.0, 4096


def _products():
    """The folder of the example products: $HVAS_PRODUCTS, that of the sources, or of an installation."""
    here = pathlib.Path(__file__).resolve()
    places = [pathlib.Path(os.environ.get("HVAS_PRODUCTS", "-")), here.parents[2] / "products",
              *(parent / "share/hvas/products" for parent in here.parents)]
    for place in places:
        if (place / "peg_hole.step").exists():
            return place
    raise hvas.Error("not-found", "the example products are missing", str(places[1]), "set HVAS_PRODUCTS to their folder")


def _rotation(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def _multiply(a, b):
    w, x, y, z = a
    v, u = np.array([x, y, z]), np.asarray(b[1:])
    return np.array([w * b[0] - v @ u, *(w * u + b[0] * v + np.cross(v, u))])


def _quaternion(turn):
    angle = np.linalg.norm(turn)
    return np.array([math.cos(angle / 2), *(np.sinc(angle / (2 * math.pi)) / 2 * np.asarray(turn))])


_CONJUGATE = np.array([1, -1, -1, -1])


def _turn(q):
    """Rotation vector of a quaternion, the shorter way round."""
    q = np.asarray(q) if q[0] >= 0 else -np.asarray(q)
    sine = np.linalg.norm(q[1:])
    return q[1:] * (2 * math.atan2(sine, q[0]) / sine if sine > 0 else 2.0)


class Insertion(Base):
    """One part that has to go to its place, from a start a little before where it engages.

    An action moves what the hand is led to, by shares of `reach` and `turn`: six numbers of -1 to 1, in the frame of the
    place. The arm is a spring of 400 N/m and 6 N m/rad to there, and it goes no further than `lead` [m] and `most_turn`
    [rad] ahead of the hand, which is how hard it presses on what does not give way. With mode="wrench" the first three
    numbers are shares of `force`. Either comes on top of the force that holds the part up.

    Threaded parts go in by turning where threads_turn says so, and are in their place once they are tight.

    Reward: what the part came nearer to its place, in shares of its way; less 1e-3 for each newton beyond its load;
    10 when it is in its place. An episode is terminated then, and truncated after `limit_s`.

    Args:
        model: As hvas.prepare gives it.
        step: Index of the step that puts the part in.
        seeds_fits: Each episode draws other sizes within the fits.
        offset: The start is beside the way by up to so much [m].
        tilt: The start is turned by up to so much [rad].
        contact_in_holes: A shaft with play touches its hole: it can tilt, jam and wedge.
        friction: Coulomb coefficient of all contacts, or two between which each episode draws one; None: the materials'.
        spin: The start is turned about the way by up to so much [rad].
        clear: How far before the place where it engages the part begins [m].
        ticks: Haptic ticks in a step of the environment.
        picture: Width and height of a picture drawn without a screen; then an observation is a dictionary of the
            "numbers" and the "picture" (height x width x 3).
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, model, step=1, *, mode="pose", condition="hybrid", contact_in_holes=True, seeds_fits=True, friction=None,
                 threads_turn=False, offset=1e-3, tilt=0.01, spin=0.0, clear=5e-3, reach=1e-3, turn=0.01, lead=15e-3, most_turn=0.1,
                 force=20.0, ticks=20, limit_s=20.0, picture=None, render_mode=None):
        if mode not in ("pose", "wrench"):
            raise ValueError("mode is 'pose' or 'wrench'")
        for name, value, least, most in (
                ("offset", offset, 0, _MOST_LENGTH), ("tilt", tilt, 0, math.pi), ("spin", spin, 0, math.pi),
                ("clear", clear, 0, _MOST_LENGTH), ("reach", reach, 0, _MOST_LENGTH), ("turn", turn, 0, math.pi),
                ("lead", lead, 0, _MOST_LENGTH), ("most_turn", most_turn, 0, math.pi), ("force", force, 0, _MOST_FORCE),
                ("limit_s", limit_s, 0, _MOST_TIME)):
            check_number(name, value, least, most)
        check_integer("ticks", ticks, 1, _MOST_TICKS)
        if friction is not None:
            coefficients = (friction,) if np.ndim(friction) == 0 else tuple(friction)
            if len(coefficients) not in (1, 2):
                raise ValueError(f"friction has to be a coefficient, or the least and the largest, not {friction!r}")
            for coefficient in coefficients:
                check_number("friction", coefficient, 0, _MOST_FRICTION)
        if picture is not None:
            if np.shape(picture) != (2,):
                raise ValueError(f"picture has to be a width and a height, not {picture!r}")
            for pixels in picture:
                check_integer("picture", pixels, 1, _MOST_PIXELS)
        self.model, self.mode, self.condition = model, mode, condition
        self.contact_in_holes, self.seeds_fits = contact_in_holes, seeds_fits
        self.friction, self.threads_turn = friction, threads_turn
        self.offset, self.tilt, self.spin, self.clear = offset, tilt, spin, clear
        self.reach, self.turn, self.lead, self.most_turn, self.force = reach, turn, lead, most_turn, force
        self.ticks, self.limit_s = ticks, limit_s
        steps = model.steps
        self.part = steps[check_integer("step", step, 0, len(steps) - 1)]
        goal = np.array(self.part.goal)
        self._p, self._q, self._R = goal[:3], goal[3:], _rotation(goal[3:])
        self._out = self._R.T @ np.array(self.part.extraction)  # The way out in the frame of the place.
        self._way = self.part.engage_distance + clear
        self.picture, self.render_mode = picture, render_mode
        self.observation_space = Box(-_MOST, _MOST, _MOST.shape, np.float64)
        if picture:
            pixels = Box(0, 255, (picture[1], picture[0], 3), np.uint8)
            self.observation_space = Dict({"numbers": self.observation_space, "picture": pixels})
        self.action_space = Box(-1.0, 1.0, (6,), np.float32)
        self.run = None

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        model = self.model
        if self.seeds_fits:
            model = model.with_seed(int(self.np_random.integers(1, 2**31)))
        if self.friction is not None:
            model = model.with_friction(float(self.np_random.uniform(*np.broadcast_to(self.friction, 2))))
        beside = self.np_random.uniform(-1, 1, 3)
        beside -= (beside @ self._out) * self._out
        position = self._way * self._out + self.offset * beside / max(1.0, np.linalg.norm(beside))
        tilted = _quaternion(self.tilt * self.np_random.uniform(-1, 1, 3) / math.sqrt(3))
        spun = self.spin * self.np_random.uniform(-1, 1) if self.spin else 0.0
        start_turn = _multiply(tilted, _quaternion(spun * self._out))
        start = self._pose(position, start_turn)
        self.run = hvas.Run(model, self.part.index, start=start, condition=self.condition,
                            contact_in_holes=self.contact_in_holes, threads_turn=self.threads_turn)
        self.run.step(pose=start, ticks=500)
        self._load = -self.run.force[:3]  # What the arm has to hold up.
        self.run.step(pose=start, force=self._load, ticks=500)
        self._led_p, self._led_q = position, start_turn
        self._begin = self.run.t
        self._distance = self._way
        return self._with_picture(self._observe()), self._info()

    def step(self, action):
        action = np.asarray(action)
        if action.dtype.kind not in "fiu":
            raise hvas.ArgumentTypeError(f"action has to be six numbers, not an array of {action.dtype}")
        if action.shape != (6,) or not np.all(np.isfinite(action)):
            raise ValueError(f"action has to be six finite numbers, not {action!r}")
        action = np.clip(action.astype(np.float64), -1, 1)
        position, q = self._in_place(np.array(self.run.led))
        if self.mode == "wrench":
            self._led_p, force = position, self._load + self._R @ (self.force * action[:3])
        else:
            self._led_p, force = self._led_p + self.reach * action[:3], self._load
            ahead = self._led_p - position
            self._led_p = position + ahead * min(1.0, self.lead / max(np.linalg.norm(ahead), 1e-12))
        wanted = _multiply(_quaternion(self.turn * action[3:]), self._led_q)
        ahead = np.clip(_turn(_multiply(wanted, q * _CONJUGATE)), -self.most_turn, self.most_turn)
        self._led_q = _multiply(_quaternion(ahead), q)
        self.run.step(pose=self._pose(self._led_p, self._led_q), force=force, ticks=self.ticks)
        observation = self._observe()
        distance = float(np.linalg.norm(observation[:3]))
        excess = float(np.linalg.norm(self.run.force[:3] + self._load))
        seated = bool(self.run.seated)
        reward = (self._distance - distance) / self._way - 1e-3 * excess + (10.0 if seated else 0.0)
        self._distance = distance
        truncated = not seated and self.run.t - self._begin >= self.limit_s
        return self._with_picture(observation), reward, seated, truncated, self._info()

    def render(self):
        """A picture of 640 by 480 pixels where render_mode is "rgb_array"."""
        return self._draw(640, 480) if self.render_mode == "rgb_array" else None

    def _draw(self, width, height):
        picture = self.run.picture(width, height).astype(np.float32)
        opacity = picture[:, :, 3:] / 255
        return (picture[:, :, :3] * opacity + 255 * (1 - opacity)).astype(np.uint8)  # Before white.

    def _with_picture(self, numbers):
        return {"numbers": numbers, "picture": self._draw(*self.picture)} if self.picture else numbers

    def _pose(self, position, turned):
        """Seven numbers in the world of a pose in the frame of the place."""
        q = _multiply(self._q, turned)
        return (*(self._p + self._R @ position), *(q / np.linalg.norm(q)))

    def _in_place(self, pose):
        """Position and quaternion in the frame of the place of a pose in the world."""
        return self._R.T @ (pose[:3] - self._p), _multiply(self._q * _CONJUGATE, pose[3:])

    def _observe(self):
        wrench, row = self.run.force, self.run.rows[-1]
        position, q = self._in_place(self.run.pose)
        return np.concatenate([position, _turn(q), self._R.T @ wrench[:3], self._R.T @ wrench[3:],
                               [row["insertion"], row["contacts"]]])

    def _info(self):
        return {"t": self.run.t - self._begin, "state": hvas.STATES[self.run.rows[-1]["state"]]}


def _insertion(file, path, fits=(), **options):
    model = hvas.prepare(hvas.open(file, fits=fits))
    for step in model.steps:
        if step.kind == "insert" and step.path.endswith(path):
            return Insertion(model, step.index, **options)
    raise hvas.Error("not-found", f"no step puts {path} in", str(file), "choose one of Model.steps")


def peg_in_hole(clearance=0.1e-3, **options):
    """A peg of 20 mm in a blind bore with this clearance in the diameter [m]."""
    check_number("clearance", clearance, 0, 20e-3)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "peg_hole.step"
        shutil.copy(_products() / file.name, file)
        measured = {"hole": "block", "shaft": "peg", "hole_diameter_mm": 20 + 1e3 * clearance, "shaft_diameter_mm": 20}
        side = {"format": "hvas-assignments-1", "fits": [measured]}
        (file.parent / "peg_hole.hvas.json").write_text(json.dumps(side))
        return _insertion(file, "peg", **{"seeds_fits": False, **options})


def press_fit(**options):
    """A bushing that is pressed into the housing of the gear pump, H7/p6: kilonewtons, of which the hand feels five."""
    return _insertion(_products() / "gear_pump.step", "bushing 1", **options)


def gear_on_shaft(**options):
    """The driven gear of the gear pump, whose teeth have to mesh."""
    return _insertion(_products() / "gear_pump.step", "driven gear shaft", **options)


def nut_on_bolt(**options):
    """A nut M8 that is turned onto its bolt, from any angle, until it clamps the plate: ten turns and 24 N m."""
    return _insertion(_products() / "nut_bolt.step", "nut",
                      **{"threads_turn": True, "spin": math.pi, "turn": 0.2, "most_turn": 0.5, "limit_s": 60.0, **options})


def part_of(file, path, **options):
    """The next part of any product: the one whose path ends so."""
    return _insertion(file, path, **options)


ENVIRONMENTS = {"PegInHole": peg_in_hole, "PressFit": press_fit, "GearOnShaft": gear_on_shaft, "NutOnBolt": nut_on_bolt,
                "PartOf": part_of}


def make(name, **options):
    """An environment by its name in ENVIRONMENTS."""
    if name not in ENVIRONMENTS:
        raise ValueError(f"no environment is called {name!r}; there are {', '.join(ENVIRONMENTS)}")
    return ENVIRONMENTS[name](**options)


def _stack(observations):
    if isinstance(observations[0], dict):
        return {name: np.stack([observation[name] for observation in observations]) for name in observations[0]}
    return np.stack(observations)


class Vector:
    """Several environments of one kind, stepped at once on threads; a finished one begins anew by itself.

    Args:
        make_one: Makes one environment; it is called `count` times.
        threads: None: one for each core.
    """

    def __init__(self, make_one, count, threads=None):
        check_integer("count", count, 1, 4096)  # A choice: each has a thread's work.
        if threads is not None:
            check_integer("threads", threads, 1, 256)
        self.environments = [make_one() for _ in range(count)]
        self.num_envs = count
        self._pool = ThreadPoolExecutor(threads or os.cpu_count())
        self.single_observation_space = self.environments[0].observation_space
        self.single_action_space = self.environments[0].action_space

    def reset(self, *, seed=None):
        seeds = [None if seed is None else seed + i for i in range(self.num_envs)]
        results = list(self._pool.map(lambda pair: pair[0].reset(seed=pair[1]), zip(self.environments, seeds)))
        return _stack([observation for observation, _ in results]), [info for _, info in results]

    def step(self, actions):
        def step_one(pair):
            environment, action = pair
            observation, reward, terminated, truncated, info = environment.step(action)
            if terminated or truncated:
                info = {**info, "final_observation": observation}
                observation, _ = environment.reset()
            return observation, reward, terminated, truncated, info

        results = list(self._pool.map(step_one, zip(self.environments, actions)))
        observations, rewards, terminated, truncated, infos = zip(*results)
        return _stack(observations), np.array(rewards), np.array(terminated), np.array(truncated), list(infos)

    def close(self):
        self._pool.shutdown()


if gymnasium is not None:
    for _name, _make in ENVIRONMENTS.items():
        gymnasium.register(id=f"hvas/{_name}-v0", entry_point=_make)
