"""Types of the compiled part of the package."""

from os import PathLike
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from .types import (Diagnostic, Event, Feature, FitLimits, Mate, Occurrence, Order, Outcome, Part, PartResult, Population,
                    Pose, PressFit, ReplayReport, Step)

STATES: tuple[str, ...]
__version__: str

Progress = Optional[Callable[[str, float], None]]
File = str | PathLike[str]

class Product:
    """A CAD file that is open: parts, where they are, and the mates that were found."""

    diagnostics: list[Diagnostic]
    @property
    def name(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def mass(self) -> float: ...
    @property
    def parts(self) -> list[Part]: ...
    @property
    def occurrences(self) -> list[Occurrence]: ...
    @property
    def mates(self) -> list[Mate]: ...
    def features(self, part: int) -> list[Feature]:
        """Holes, shafts, planes, cones and spheres of a part."""
    def vertices(self, part: int) -> NDArray[np.float64]:
        """n x 3, in the part's frame [m]."""
    def triangles(self, part: int) -> NDArray[np.uint32]:
        """n x 3 indices into vertices, outward; a view that keeps the product alive."""
    def export_files(self, format: str, name: str) -> dict[str, bytes]:
        """Files of an export ("mjcf", "urdf" or "usda") by their paths; hvas.export writes them."""

class Model:
    """A product that is prepared: immutable, and shared by all runs."""

    @property
    def steps(self) -> list[Step]: ...
    @property
    def gaps(self) -> dict[str, str]:
        """Reasons of the parts that no step brings in, by path."""
    @property
    def seed(self) -> int: ...
    def with_seed(self, seed: int) -> Model:
        """The same model with other sizes of its fits."""
    def plan(self, orders: int = 5, before: Sequence[tuple[str, str]] = (), weights: Mapping[str, float] = {}) -> list[Order]:
        """Orders of assembly of low cost. Weights: turn, direction_change, tool_change, loose, cramped, reach, force, hand_time."""
    def assemble(self, seed: int = 1, devices: Sequence[str] = ("",), condition: str = "hybrid", realtime: bool = False,
                 limit_s: float = 0.0, record: File = "", replace: bool = False,
                 on_part: Optional[Callable[[PartResult], None]] = None) -> Outcome:
        """Has a simulated person, or the user of a device, put every part in; in virtual time unless realtime."""

class Run:
    """One step of the order, tick by tick, with a hand that the caller leads. The part is in the hand from the beginning.

    Args of Run: start is the part's pose when it is taken (None: as it lies on the table); condition is "hybrid",
    "collision" or "constraint"; stiffness [N/m], damping [N s/m], turn_stiffness [N m/rad] and turn_damping [N m s/rad]
    are the arm's.
    """

    def __init__(self, model: Model, step: int = 1, start: Optional[Sequence[float]] = None, condition: str = "hybrid",
                 contact_in_holes: bool = False, stiffness: float = 400.0, damping: float = 25.0, turn_stiffness: float = 6.0,
                 turn_damping: float = 0.2, rate_hz: float = 1000.0) -> None: ...
    def step(self, pose: Optional[Sequence[float]] = None, force: Optional[Sequence[float]] = None, ticks: int = 1,
             grip: bool = True) -> NDArray[Any]:
        """Runs ticks, without the interpreter's lock.

        Args:
            pose: Where the hand leads the part to; None: as before.
            force: Of the arm besides its spring, in the world [N]; None: none.
            ticks: 1 to 1,000,000.
            grip: False lets go.

        Returns:
            A structured array with a row for each tick, a view: the next call writes over it, so copy what is to stay.
            Fields: t_s, X_WH (hand), X_WB (part), F_felt_W and F_true_W (force, then torque), p_WC and f_C_W (the contact
            that presses hardest), deepest, insertion, axial_true, offset, tilt, contacts, state (index into hvas.STATES).
        """
    @property
    def rows(self) -> NDArray[Any]:
        """What the last step returned."""
    @property
    def seated(self) -> bool: ...
    @property
    def t(self) -> float:
        """Session time at the beginning of the last tick [s]."""
    @property
    def pose(self) -> NDArray[np.float64]:
        """Of the part."""
    @property
    def led(self) -> Pose:
        """Where the part would be if it hung in the hand without giving way."""
    @property
    def force(self) -> NDArray[np.float64]:
        """Force and torque that the hand is given [N, N m]."""
    @property
    def goal(self) -> Pose: ...
    @property
    def poses(self) -> list[Pose]:
        """Of all parts, by the ids of their occurrences."""
    def picture(self, width: int = 320, height: int = 240, to_eye: tuple[float, float, float] = ...) -> NDArray[np.uint8]:
        """Height x width x 4 (red, green, blue, opacity): what is in its place and in the hand, drawn without a screen."""
    @property
    def mass(self) -> float:
        """Of what is in the hand [kg]."""

class Record:
    """A recorded session."""

    def __init__(self, file: File) -> None: ...
    @property
    def meta(self) -> dict[str, str]: ...
    @property
    def complete(self) -> bool: ...
    @property
    def tick_count(self) -> int: ...
    def ticks(self, every: int = 1) -> dict[str, NDArray[np.float64]]:
        """All numbers of all ticks, or of every so many-th of each hand, by the name of the column, which ends with its unit."""
    def events(self) -> list[Event]: ...
    def verify(self) -> str:
        """Reads everything against its checksums; the digest."""
    def replay(self, progress: Progress = None) -> ReplayReport:
        """Runs every tick again from what is recorded, and compares it bit for bit."""

def open_product(file: File, fits: Sequence[str], unit: Optional[float], encoding: str, apart: Sequence[str],
                 rigid: Sequence[str], cache: bool, time_limit: float, progress: Progress) -> Product: ...
def prepare(product: Product, seed: int, base: str, first_parts: Sequence[str], cache: bool, progress: Progress) -> Model: ...
def fit_limits(code: str, diameter: float) -> FitLimits: ...
def press_fit(diameter: float, length: float, interference: float, hub_diameter: float = 0.0, shaft_bore: float = 0.0,
              friction: float = 0.15) -> PressFit: ...
def population(code: str, diameter: float, length: float, count: int = 100_000, seed: int = 0, hub_diameter: float = 0.0,
               friction: float = 0.15, threads: int = 1) -> Population: ...
