"""Fits: ISO 286, press fits, and batches within limits. Lengths in metres, forces in newtons."""

from ._hvas import fit_limits as _fit_limits
from ._hvas import population as _population
from ._hvas import press_fit as _press_fit


def limits(code, diameter):
    """Limits of an ISO 286 fit such as "H7/p6" at a diameter [m].

    Raises:
        hvas.Error: for a code that is none, or a size that the standard does not cover.
    """
    return _fit_limits(code, diameter)


def press(diameter, length, interference, *, hub_diameter=0.0, shaft_bore=0.0, friction=0.15):
    """A press fit of steel in steel by DIN 7190-1: pressure, forces, torque.

    Args:
        diameter: Of the joint [m].
        length: Of the joint [m].
        interference: Diametral [m].
        hub_diameter: Outside [m]; 0: twice the joint's.
        shaft_bore: 0 for a solid shaft [m].
        friction: Coulomb's coefficient, in and out.
    """
    return _press_fit(diameter, length, interference, hub_diameter, shaft_bore, friction)


def population(code, diameter, length, *, count=100_000, seed=0, hub_diameter=0.0, friction=0.15, threads=1):
    """Draws a batch of pairs within the limits of a fit, and presses each together."""
    return _population(code, diameter, length, count, seed, hub_diameter, friction, threads)
