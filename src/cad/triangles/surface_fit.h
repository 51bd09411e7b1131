#pragma once

#include <span>

#include "spatial/surface.h"

namespace hvas::cad {

/** Moves a plane, cylinder, cone, sphere or torus to the least sum of squared distances to points:
 Levenberg and Marquardt's method on three turns, three shifts and the shape parameters. What a
 symmetry of the surface leaves free stays. Deterministic.
 @param scale  A length of the size of the points' extent [m]; > 0.
 @returns The largest distance of a point [m]; infinite where there is no fit. `outward` is kept. */
double RefineSurface(std::span<const Vec3> points, double scale, spatial::Surface* surface);

/** The largest distance of a point from a surface [m]; points on its axis have none. */
[[nodiscard]] double CalcResidual(std::span<const Vec3> points, const spatial::Surface& surface);

}  // namespace hvas::cad
