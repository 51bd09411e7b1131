#include "sequence/turning_way.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace hvas::sequence {
namespace {

constexpr double kStep = 0.5e-3;  // [m] between poses; a chord of an arc is good to 2 um: choices.

/** Whether a box may go on along an axis for ever. */
bool IsFree(const spatial::Box& box, int axis, double sign, std::span<const spatial::Box> others) {
  spatial::Box swept = box;
  constexpr double kFar = 1e3;  // [m]: farther than any product.
  (sign > 0 ? swept.high : swept.low)[axis] += sign * kFar;
  return std::none_of(others.begin(), others.end(),
                      [&](const spatial::Box& other) { return swept.Overlaps(other); });
}

/** The axis of the world along which a box leads past the others, upwards if it may be, else away
 from their middle. */
std::optional<Vec3> FindAxisOut(const spatial::Box& box, std::span<const spatial::Box> others) {
  spatial::Box around;
  for (const spatial::Box& other : others) {
    around.Add(other);
  }
  std::vector<Vec3> axes{Vec3::UnitZ(), Vec3::UnitX(),  -Vec3::UnitX(),
                         Vec3::UnitY(), -Vec3::UnitY(), -Vec3::UnitZ()};
  const Vec3 away = others.empty() ? Vec3::Zero() : Vec3(box.centre() - around.centre());
  std::stable_sort(axes.begin() + 1, axes.end(),
                   [&away](const Vec3& a, const Vec3& b) { return a.dot(away) > b.dot(away); });
  for (const Vec3& axis : axes) {
    int k = 0;
    (void)axis.cwiseAbs().maxCoeff(&k);
    if (IsFree(box, k, axis[k], others)) {
      return axis;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<SequenceStep> MakeTurningStep(product::OccurrenceId id, const paths::Path& path,
                                            const spatial::Box& box_B,
                                            std::span<const spatial::Box> others) {
  const auto axis_W = FindAxisOut(spatial::Transform(path.back(), box_B), others);
  if (!axis_W || path.size() < 2) {
    return std::nullopt;
  }
  SequenceStep step;
  step.occurrence = id;
  step.way = paths::Resample(path, box_B, kStep);
  step.way.emplace_back(path.back().q(), path.back().p() + kLastPiece * *axis_W);
  // Where it begins with a turn about a point of its own, its seats see the first distance.
  step.extraction_W = *axis_W;
  for (const spatial::Pose& X_WB : step.way) {
    const Vec3 gone = X_WB * box_B.centre() - path.front() * box_B.centre();
    if (gone.norm() > kStep) {
      step.extraction_W = gone.normalized();
      break;
    }
  }
  step.engage_distance = paths::CalcLength(step.way, box_B.centre());
  return step;
}

GripWay MakeGripWay(const paths::Path& way, const Vec3& p_BG, const spatial::Box& box_B) {
  const spatial::Pose X_BG(p_BG);
  std::vector<spatial::Pose> poses;
  for (const spatial::Pose& X_WB : way) {
    poses.push_back(X_WB * X_BG);
  }
  constexpr double kGyration = 0.29;  // Of the diagonal of a slender box: 1 / sqrt(12).
  return {std::move(poses), kGyration * box_B.size().norm()};
}

}  // namespace hvas::sequence
