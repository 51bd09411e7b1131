#pragma once

#include <string>

#include "orders/gap_reason.h"

namespace hvas::evidence {

// Size of the picture [pixels]: a choice.
inline constexpr int kGapPictureWidth = 480;
inline constexpr int kGapPictureHeight = 360;

/** Picture of why a part cannot be brought in, as a PNG file: the part where its best straight way
 ends, orange, what stops it there, grey, and the faces that meet, red, also where something hides
 them; from where most of them is seen. The same bytes every time. Empty where the reason has no
 such way, or nothing stops the part on it. */
[[nodiscard]] std::string MakeGapPicture(const simulation::Model& model,
                                         const orders::GapReason& reason);

/** Describes such a picture in one sentence, for who does not see it. */
[[nodiscard]] std::string DescribeGapPicture(const simulation::Model& model,
                                             const orders::GapReason& reason);

}  // namespace hvas::evidence
