#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "shopfloor/work_plan.h"

namespace hvas::shopfloor {

/** How long a step of an animation takes, and of it the way of its part [s]: choices, as an eye
 follows one part. */
inline constexpr double kStepSeconds = 2;
inline constexpr double kWaySeconds = 1.2;

/** When each step of a plan begins in its animation [s]. Laying aside takes no time there, and
 begins with the next step. */
[[nodiscard]] std::vector<double> ListStepStarts(const WorkPlan& plan);

/** Makes the steps of a plan as an animated binary glTF 2.0 file (cad/glb.h): each part appears
 before its place when its step begins, and goes in. Parts without a way in are not seen. Errors:
 those of cad::MakeGlb. */
[[nodiscard]] Result<std::string> MakeWorkAnimation(const simulation::Model& model,
                                                    const WorkPlan& plan);

}  // namespace hvas::shopfloor
