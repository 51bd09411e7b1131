#pragma once

#include <optional>
#include <span>

#include "paths/path.h"
#include "sequence/grip_way.h"
#include "sequence/sequence.h"
#include "spatial/box.h"

namespace hvas::sequence {

/** Length of the straight last piece of a way that turns [m]; as long as the hand needs to see
 where it leads. */
inline constexpr double kLastPiece = 10e-3;

/** The step of a part that comes out along a path; its way goes on straight after the last pose, in
 the direction of an axis of the world that leads past all others, and is divided so that from one
 pose to the next the part goes evenly. None where no axis leads past them.
 @param path  Poses X_WB from the part's place on; a screw leads from one to the next.
 @param others  Boxes in W of what is there. */
[[nodiscard]] std::optional<SequenceStep> MakeTurningStep(product::OccurrenceId id,
                                                          const paths::Path& path,
                                                          const spatial::Box& box_B,
                                                          std::span<const spatial::Box> others);

/** The way of the grip of a part that goes along poses X_WB. @param p_BG  The grip in the part. */
[[nodiscard]] GripWay MakeGripWay(const paths::Path& way, const Vec3& p_BG,
                                  const spatial::Box& box_B);

}  // namespace hvas::sequence
