"""What HVAS gives to Python: dataclasses in SI units, and the error that everything raises.

Positions are three numbers [m]; poses are seven: position, then the quaternion w, x, y, z.
"""

from dataclasses import dataclass, field
from typing import Any, Optional

Vector = tuple[float, float, float]
Pose = tuple[float, float, float, float, float, float, float]


class Error(Exception):
    """An error that a person can act on.

    Attributes:
        code: "not-found", "unreadable", "unsupported", "invalid", "out-of-resource", "cancelled" or "internal".
        message: What happened, in a sentence that names the entity.
        where: File, line or entity; may be empty.
        remedy: What to do about it; may be empty.
    """

    def __init__(self, code: str, message: str, where: str = "", remedy: str = ""):
        super().__init__(code, message, where, remedy)
        self.code, self.message, self.where, self.remedy = code, message, where, remedy

    def __str__(self) -> str:
        text = f"{self.where}: {self.message}" if self.where else self.message
        return f"{text} ({self.remedy})" if self.remedy else text


class ArgumentTypeError(TypeError, ValueError):
    """An argument is of another type than it has to be: also a ValueError, so that one clause catches all refused arguments."""


@dataclass(frozen=True)
class Diagnostic:
    """Something odd about an input that did not stop the work."""

    severity: str  # "note", "warning" or "error"
    code: str
    entity: str
    message: str
    remedy: str


@dataclass(frozen=True)
class Part:
    """A part of the file, in its own frame; occurrences place it."""

    id: int
    name: str
    material: str
    density: float  # [kg/m^3]
    volume: float  # [m^3]
    mass: float  # [kg]
    centre_of_mass: Vector
    inertia: tuple[Vector, Vector, Vector]  # about the centre of mass [kg m^2]
    box: tuple[Vector, Vector]  # lowest and highest corner
    faces: int
    triangles: int
    shape_hash: str


@dataclass(frozen=True)
class Feature:
    """Faces of a part that a mate can hold on to."""

    kind: str  # "hole", "shaft", "plane", "cone_seat", "taper", "socket" or "ball"
    origin: Vector
    axis: Vector
    radius: float  # [m]; 0 for planes
    half_angle: float  # of cones [rad]
    span: tuple[float, float]  # along the axis from the origin [m]
    thread: str


@dataclass(frozen=True)
class Occurrence:
    """A part in its place in the product."""

    id: int
    part: int  # index into Product.parts
    name: str
    path: str
    pose: Pose


@dataclass(frozen=True)
class Fit:
    """The fit of a mate."""

    kind: str  # "clearance", "transition", "interference", "thread", "insert" or "passage"
    code: str  # ISO 286, as "H7/g6"; empty for the last three kinds
    nominal: float  # diameter, or width of a prismatic mate [m]
    is_proposed: bool  # false where the file, a side file or the user says so
    reason: str


@dataclass(frozen=True)
class Mate:
    """Two parts that belong together: a has the hole, slot or seat, b the shaft, tongue or taper."""

    id: int
    key: str
    kind: str  # "axis_hole", "face_face", "cone_seat", "sphere_seat" or "prismatic"
    a: int  # ids of occurrences
    b: int
    fit: Optional[Fit]
    frame: Pose  # in the world; z is the axis, or the outward normal
    overlap: float  # engaged length [m], or area of planes [m^2]
    confidence: float
    evidence: str


@dataclass(frozen=True)
class Step:
    """A step of the order of assembly."""

    index: int
    kind: str  # "base", "insert", "park", "remove", "aside" or "return"
    occurrence: int
    path: str
    members: list[int]  # what else moves with it
    goal: Pose
    extraction: Vector  # unit; the way out
    engage_distance: float  # from the goal until nothing is engaged [m]


@dataclass(frozen=True)
class Order:
    """An order of assembly that was planned."""

    cost: float
    parts: list[str]  # paths


@dataclass(frozen=True)
class PartResult:
    """How one part fared."""

    occurrence: int
    path: str
    seated: bool
    assumed: bool  # put in its place for the parts after it, as nothing brought it there
    reason: str  # why it is not seated, where it is not
    note: str
    time: float  # [s]
    path_length: float  # [m]
    peak_true: float  # [N]
    peak_felt: float  # [N]
    fit_true: float  # [N]
    fit_felt: float  # [N]
    preload: float  # largest force in it as a screw or nut that was turned [N]
    tightening: float  # largest torque of its thread and head [N m]
    deepest: float  # deepest penetration [m], negative inside
    arrival: float  # how far the hand brought it from its place [m]


@dataclass(frozen=True)
class Outcome:
    """Results of an assembly."""

    parts: list[PartResult]
    complete: bool
    digest: str
    ticks: int
    session_time: float  # [s]
    wall_time: float  # [s]


@dataclass(frozen=True)
class FitLimits:
    """Limits of an ISO 286 fit at a size. Clearances are diametral; negative is interference."""

    code: str
    nominal: float  # [m]
    kind: str
    hole: tuple[float, float]  # EI, ES [m]
    shaft: tuple[float, float]  # ei, es [m]
    min_clearance: float  # [m]
    max_clearance: float  # [m]


@dataclass(frozen=True)
class PressFit:
    """A press fit by Lame's rings, DIN 7190-1."""

    pressure: float  # [Pa]
    press_in_force: float  # [N]
    push_out_force: float  # [N]
    torque: float  # [N m]
    hub_expansion: float  # diametral [m]
    shaft_contraction: float  # diametral [m]


@dataclass(frozen=True, eq=False)
class Population:
    """A batch of pairs within the limits of a fit, pressed together: arrays of NumPy."""

    count: int
    mean_clearance: float  # [m]
    sigma_clearance: float  # [m]
    interference_share: float
    shares: Any = field(repr=False)  # of the batch, for force_quantiles
    depth: Any = field(repr=False)  # [m]
    mean_force: Any = field(repr=False)  # at each depth [N]
    force_quantiles: Any = field(repr=False)  # depths x shares [N]


@dataclass(frozen=True)
class Event:
    """Something that happened in a recorded session."""

    t: float  # session time [s]
    kind: str
    occurrence: Optional[int]
    details: dict


@dataclass(frozen=True)
class ReplayReport:
    """What running a record's ticks again gave."""

    ticks: int
    different_ticks: int
    exact: bool
    largest_felt_difference: float  # [N]
