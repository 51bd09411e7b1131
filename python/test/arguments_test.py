"""Every number that Python passes is checked at the boundary: the functions and arguments come from the stubs and signatures."""

import ast
import inspect
import math
import pathlib
import tempfile
import unittest

import numpy as np

import hvas
from hvas import _hvas, gym
from support import PRODUCTS, SOURCES

NOT_NUMBERS = ["1", b"1", "nan", True, 1j, [1.0], (), {}, object(), np.array([1.0]), np.array(True), np.complex64(1), np.bool_(True),
               np.str_("1"), np.datetime64(1, "s"), math.sin]
OUT_OF_RANGE = [math.nan, -math.nan, math.inf, -math.inf, -1, -1.0, -1e-9, -1e308, 1e308, 10**400, -10**400, np.float32("nan"),
                np.float64("inf"), np.int8(-1), np.array(math.nan)]
NOT_INTEGERS = [1.0, 1.5, np.float32(1), "5", None]
NOT_WHOLE = [value for value in OUT_OF_RANGE if not isinstance(value, float)] + [2**64, -2**63, -2**64, np.int64(-1)]
NOT_FLAGS = [math.nan, 1, 0, "yes", None, [], np.array([True])]


def sequences(valid):
    """What is no sequence of so many numbers in range, made from one that is."""
    values = [1.0, "1234567", b"1234567", object(), {}, dict(enumerate(valid)), set(valid), [], [*valid, 0.0], valid[1:],
              [list(valid)], np.array([valid]), np.array(valid).reshape(-1, 1), np.array(valid, np.complex128), np.array(valid, bool),
              np.array(valid, str), np.array(1.0), [str(x) for x in valid], [None for _ in valid]]
    for index in range(len(valid)):
        for number in [math.nan, math.inf, -math.inf, 1e308, -1e308, 10**400, "1", None, True, 1j, [1.0]]:
            values.append([*valid[:index], number, *valid[index + 1:]])
    return values


def stubs():
    """(function, argument): annotation, of all functions of the compiled module."""
    found = {}

    def visit(prefix, body):
        for node in body:
            if isinstance(node, ast.ClassDef):
                visit(node.name + ".", node.body)
            elif isinstance(node, ast.FunctionDef) and not node.name.startswith("check_"):
                name = (prefix + node.name).removesuffix(".__init__")
                for argument in node.args.args:
                    if argument.annotation is not None:
                        found[name, argument.arg] = ast.unparse(argument.annotation)

    visit("", ast.parse((SOURCES / "python/hvas/_hvas.pyi").read_text()).body)
    return found


def hostile(annotation, valid):
    """Values that an argument of this type refuses; none where it takes no number."""
    if annotation == "bool":
        return NOT_FLAGS
    if annotation == "int":
        return NOT_NUMBERS + NOT_INTEGERS + NOT_WHOLE
    if annotation in ("float", "Optional[float]"):
        return NOT_NUMBERS + OUT_OF_RANGE + ([None] if annotation == "float" else [])
    if "float" in annotation and "Mapping" in annotation:
        return [1.0, "turn", [1.0], {"speed": 1.0}, {1: 1.0}, *({"turn": value} for value in NOT_NUMBERS + OUT_OF_RANGE + [None])]
    if "float" in annotation:
        return sequences(valid)
    return []


class Arguments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        file = pathlib.Path(cls.folder.name) / "session.hvasrec"
        cls.product = hvas.open(PRODUCTS / "bushing.step")
        cls.model = hvas.prepare(cls.product)
        cls.model.assemble(record=file)
        cls.record = hvas.Record(file)
        cls.start = list(cls.model.steps[1].goal)
        cls.run_ = hvas.Run(cls.model, start=cls.start)

    def refuse(self, call, arguments, name, value, is_named):
        """@param is_named: Whether the message has the argument's name, as that of every number."""
        with self.subTest(argument=name, value=repr(value)[:60]):
            with self.assertRaises((ValueError, TypeError, IndexError)) as caught:
                call(**{**arguments, name: value})
            if is_named:
                self.assertIn(name, str(caught.exception))
                self.assertLess(len(str(caught.exception)), 300)

    def test_of_the_compiled_module_refuse_what_is_no_number_of_their_range(self):
        start = self.start
        open_arguments = {"file": PRODUCTS / "bushing.step", "fits": [], "unit": None, "encoding": "", "apart": [], "rigid": [],
                          "cache": True, "time_limit": 60.0, "progress": None}
        calls = {
            "Product.features": (self.product.features, {"part": 0}),
            "Product.vertices": (self.product.vertices, {"part": 0}),
            "Product.triangles": (self.product.triangles, {"part": 0}),
            "Model.with_seed": (self.model.with_seed, {"seed": 1}),
            "Model.with_friction": (self.model.with_friction, {"friction": 0.1}),
            "Model.plan": (self.model.plan, {"orders": 1, "weights": {"turn": 1.0}}),
            "Model.assemble": (self.model.assemble, {"seed": 1, "limit_s": 0.1, "threads_turn": False, "realtime": False, "replace": False}),
            "Run": (hvas.Run, {"model": self.model, "step": 1, "start": start, "contact_in_holes": False, "threads_turn": False,
                               "stiffness": 400, "damping": 25.0, "turn_stiffness": 6.0, "turn_damping": 0.2, "rate_hz": 1000}),
            "Run.step": (self.run_.step, {"pose": start, "force": [0.0, 0.0, 1.0], "ticks": 1, "grip": True}),
            "Run.picture": (self.run_.picture, {"width": 8, "height": 8, "to_eye": (0.5, -0.7, 0.5)}),
            "Record.ticks": (self.record.ticks, {"every": 1000}),
            "open_product": (_hvas.open_product, open_arguments),
            "prepare": (_hvas.prepare, {"product": self.product, "seed": 1, "base": "", "first_parts": [], "cache": True, "progress": None}),
            "fit_limits": (_hvas.fit_limits, {"code": "H7/p6", "diameter": 0.04}),
            "press_fit": (_hvas.press_fit, {"diameter": 0.04, "length": 0.05, "interference": 50e-6, "hub_diameter": 0.0, "shaft_bore": 0.0,
                                            "friction": np.float32(0.15)}),
            "population": (_hvas.population, {"code": "H7/p6", "diameter": 0.04, "length": 0.05, "count": np.int32(100), "seed": 2**64 - 1,
                                              "hub_diameter": 0.0, "friction": 0.15, "threads": 1}),
        }
        for call, arguments in calls.values():
            call(**arguments)  # Each of them is good.
        before = self.run_.led
        checked = 0
        for (function, name), annotation in stubs().items():
            call, arguments = calls.get(function, (None, {}))
            values = hostile(annotation, arguments.get(name))
            self.assertTrue(not values or name in arguments, f"{function} {name} is not tested")
            for value in values:
                self.refuse(call, arguments, name, value, annotation != "bool" and "Mapping" not in annotation)
                checked += 1
        self.assertGreater(checked, 1000)
        self.assertEqual(self.run_.led, before)  # What was refused has led the hand nowhere.
        self.assertTrue(np.isfinite(self.run_.step(ticks=5)["X_WB"]).all())

    def test_say_name_value_and_range(self):
        for call, text in [
                (lambda: self.model.plan(weights={"turn": math.nan}), "weights['turn'] has to be a number of 0 to 1000000000, not nan"),
                (lambda: self.model.with_friction(-0.1), "friction has to be a number of 0 to 2, not -0.1"),
                (lambda: hvas.fits.press(0.0, 0.05, 50e-6), "diameter has to be a number above 0 and at most 10000, not 0.0"),
                (lambda: hvas.Run(self.model, start=[0, 0, 0, 1, 0, 0]), "start has to be a sequence of 7 numbers, not of 6"),
                (lambda: hvas.Run(self.model, start=[0, 0, 0, 1, 0, 0, math.nan]), "start[6] has to be a number of -10000 to 10000, not nan"),
                (lambda: self.run_.step(force=(0, 0, math.inf)), "force[2] has to be a number of -1000000 to 1000000, not inf"),
                (lambda: self.run_.step(ticks=0), "ticks has to be a whole number of 1 to 1000000, not 0")]:
            with self.assertRaises(ValueError) as caught:
                call()
            self.assertEqual(str(caught.exception), text)
        with self.assertRaises(TypeError) as caught:
            self.model.with_friction("0.1")
        self.assertEqual(str(caught.exception), "friction has to be a number, not str")

    def test_of_the_package_refuse_as_those_of_the_compiled_module(self):
        calls = [(hvas.open, {"file": PRODUCTS / "bushing.step"}), (hvas.prepare, {"product": self.product}),
                 (hvas.fits.limits, {"code": "H7/p6", "diameter": 0.04}),
                 (hvas.fits.press, {"diameter": 0.04, "length": 0.05, "interference": 50e-6}),
                 (hvas.fits.population, {"code": "H7/p6", "diameter": 0.04, "length": 0.05}),
                 (gym.Insertion, {"model": self.model}), (gym.peg_in_hole, {}),
                 (gym.Vector, {"make_one": lambda: gym.Insertion(self.model), "count": 1})]
        for call, arguments in calls:
            for name, parameter in inspect.signature(call).parameters.items():
                number = arguments.get(name, parameter.default)
                if isinstance(number, (int, float)) and not isinstance(number, bool):
                    for value in NOT_NUMBERS + OUT_OF_RANGE:
                        self.refuse(call, arguments, name, value, True)
        for name in ("fits", "apart", "rigid"):
            for value in ("H7/g6", b"all", [1], [None], 5, None):
                self.refuse(hvas.open, {"file": PRODUCTS / "bushing.step"}, name, value, False)
        for value in ("bushing", [1], 5):
            self.refuse(hvas.prepare, {"product": self.product}, "first_parts", value, False)
        for value in ["0.1", (), (0.1, 0.2, 0.3), (0.1, math.nan), *(v for v in OUT_OF_RANGE)]:
            self.refuse(gym.Insertion, {"model": self.model}, "friction", value, True)
        for value in [64, (64,), (64, 0), (64, -1), (64, 1e9), "64x48", (64, "48")]:
            self.refuse(gym.Insertion, {"model": self.model}, "picture", value, True)

    def test_an_action_is_six_finite_numbers(self):
        environment = gym.Insertion(self.model)
        environment.reset(seed=1)
        for action in [np.zeros(5), np.zeros((6, 1)), 0.0, "000000", [math.nan] * 6, [0.0] * 5 + [math.inf], np.zeros(6, complex),
                       np.zeros(6, bool), None, [None] * 6]:
            self.refuse(environment.step, {}, "action", action, True)
        environment.step(np.zeros(6, np.float32))
        environment.step([2, 0, 0, 0, 0, 0])  # Beyond its space: as far as that goes.


if __name__ == "__main__":
    unittest.main()
