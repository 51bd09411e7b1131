#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mates/solve_together.h"
#include "product/product.h"

namespace hvas::mates {

/** Describes what mates leave free to parts that move as one, in W: "can still be shifted along
 (0.00, 0.00, 1.00), and turned about (0.00, 0.00, 1.00) through (10.0, 0.0, 5.0) mm". A turn about
 an axis around which all of the parts are round is nothing to be said. None where nothing is left.
 @param product  In its assembled poses. @param X_WB  Pose of the body of the parts. */
[[nodiscard]] std::optional<std::string> ExplainFreedom(
    const product::Product& product, const std::vector<product::OccurrenceId>& members,
    const BodyFreedom& freedom, const Pose& X_WB);

/** True where a part looks the same however it is turned about an axis, by the surfaces of its
 faces. @param p_BQ  A point of the axis. */
[[nodiscard]] bool IsRoundAbout(const product::Part& part, const Vec3& p_BQ, const Vec3& axis_B);

}  // namespace hvas::mates
