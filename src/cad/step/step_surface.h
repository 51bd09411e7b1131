#pragma once

#include <cstdint>
#include <optional>

#include "cad/step/step_text.h"
#include "spatial/surface.h"

namespace hvas::cad {

/** Units of a shape in a STEP text. */
struct ShapeUnits {
  double length{1e-3};  ///< [m]
  double angle{1};      ///< [rad]
};

/** A CARTESIAN_POINT [m]. */
[[nodiscard]] std::optional<Vec3> ReadStepPoint(const StepText& text, std::uint64_t id,
                                                const ShapeUnits& units);

/** An AXIS2_PLACEMENT_3D as a pose. */
[[nodiscard]] std::optional<spatial::Pose> ReadStepPlacement(const StepText& text, std::uint64_t id,
                                                             const ShapeUnits& units);

/** A plane, cylinder, cone, sphere or torus, or the one under a face; its sense is +1. Empty for
 anything else. */
[[nodiscard]] std::optional<spatial::Surface> ReadStepSurface(const StepText& text,
                                                              std::uint64_t id,
                                                              const ShapeUnits& units);

}  // namespace hvas::cad
