#pragma once

#include <string>

#include "shopfloor/work_plan.h"

namespace hvas::shopfloor {

/** A picture of a step: what is there in its own colours, pale; what comes before its place, in
 orange; and arrows along its way. */
struct StepPicture {
  std::string png;  ///< Empty where there is nothing to see.
  std::string svg;  ///< The arrows, in the same pixels; empty: none.
  int width{0};     ///< [pixels]
  int height{0};
  Vec3 to_eye{Vec3::Zero()};  ///< The view: direction to the eye where +z is upwards.
};

/** Draws a step, with the side that is upwards at the top, from where most of the part that comes
 and of the faces that it goes to is seen; small parts are drawn with what is around them. The same
 bytes every time.
 @param last_to_eye  View of the picture before, which stays where it is nearly as good as another;
 zero: none. */
[[nodiscard]] StepPicture DrawStep(const simulation::Model& model, const WorkStep& step,
                                   const Vec3& last_to_eye);

/** How far before its place the part of a step is drawn, along its way out [m]. */
[[nodiscard]] double CalcApart(const simulation::Model& model, const WorkStep& step);

}  // namespace hvas::shopfloor
