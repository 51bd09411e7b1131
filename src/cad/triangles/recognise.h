#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "spatial/surface.h"

namespace hvas::cad {

/** A point of a surface and the unit normal there; normals of one surface agree in sense. */
struct SurfaceSample {
  Vec3 p;
  Vec3 nhat;
};

/** The simplest of plane, cylinder, cone, sphere and torus on which all samples lie within
 `tolerance` [m], with `outward` +1 where the given normals point out of it; empty when none does.

 Plane: principal axes of the points. Cylinder: the axis is the direction of least variance of the
 normals, then a circle. Cone: the normals make one angle with the axis, and the tangent planes meet
 in the apex. Torus: the normals meet the axis, a linear line complex (Pottmann and Wallner,
 Computational Line Geometry, 2001, section 5.3), then a circle in the meridian plane. */
[[nodiscard]] std::optional<spatial::Surface> RecogniseSurface(
    std::span<const SurfaceSample> samples, double tolerance);

/** The surface of a kind that goes through samples, by the same methods but unchecked: a start for
 RefineSurface. Empty where the samples do not determine one. Its `outward` is +1. */
[[nodiscard]] std::optional<spatial::Surface> FitSurface(spatial::SurfaceKind kind,
                                                         std::span<const SurfaceSample> samples);

/** Sets the sense of a surface so that the gradients of CalcDistance agree with the outward normals
 of the triangles on it, and the axis of a cone so that it points into the nappe in use.
 @returns Area-weighted mean of gradient times normal: 1 for a perfect match, near 0 when the
 surface and the triangles have nothing in common. */
double OrientSurface(std::span<const Vec3> vertices,
                     std::span<const std::array<std::uint32_t, 3>> triangles,
                     spatial::Surface* surface);

}  // namespace hvas::cad
