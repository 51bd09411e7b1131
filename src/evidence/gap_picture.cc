#include "evidence/gap_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "evidence/picture.h"

namespace hvas::evidence {
namespace {

using orders::GapReason;
using product::OccurrenceId;
using sequence::MetFaces;
using simulation::Model;

// Pixels of the pictures by which the view is chosen: choices.
constexpr int kTrialWidth = 96;
constexpr int kTrialHeight = 72;

constexpr product::Color kPart{0.96F, 0.62F, 0.2F};   // Orange: a choice.
constexpr product::Color kOther{0.66F, 0.7F, 0.76F};  // Grey: a choice.

void Mark(std::uint32_t face, std::vector<std::uint32_t>* marked) {
  if (face != contact::kNoFace) {
    marked->push_back(face);
  }
}

std::vector<PictureBody> MakeBodies(const Model& model, const GapReason& reason) {
  std::map<OccurrenceId, std::vector<std::uint32_t>> marked;  // Faces of each part that is drawn.
  for (std::size_t i = 0; i < std::min(orders::kToldStops, reason.stops.size()); ++i) {
    const MetFaces& stop = reason.stops[i];
    if (stop.other.is_valid()) {
      Mark(stop.other_face, &marked[stop.other]);
      Mark(stop.own_face, &marked[reason.occurrence]);
    }
  }
  std::vector<PictureBody> bodies;
  for (auto& [id, faces] : marked) {
    const bool is_own = id == reason.occurrence;
    const Vec3 moved_W = is_own ? Vec3(reason.travelled * reason.direction_W) : Vec3::Zero();
    const spatial::Pose& X_WB = model.bodies[id.index()].X_WB_goal;
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    bodies.push_back({&model.product->part_of(id),
                      {X_WB.q(), Vec3(X_WB.p() + moved_W)},
                      is_own ? kPart : kOther,
                      faces,
                      0});
  }
  return bodies;
}

/** From above and below in all directions, steps of 45 degrees; the usual one where none is better.
 */
Vec3 ChooseView(const std::vector<PictureBody>& bodies, const spatial::Box& box_W) {
  Vec3 best_W = UsualView();
  const auto rate_view = [&](const Vec3& to_eye_W) {
    return RateMarks(bodies, Projection(box_W, kTrialWidth, kTrialHeight, to_eye_W)).front();
  };
  double best = rate_view(best_W);
  constexpr int kTurns = 8;  // Steps of 45 degrees: a choice.
  for (const double height : {0.6, -0.6}) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = 2 * std::numbers::pi * (turn + 0.4) / kTurns;
      const Vec3 to_eye_W(std::cos(angle), std::sin(angle), height);
      const double rate = rate_view(to_eye_W);
      constexpr double kBetter = 1.2;  // Unusual views are harder to read: a choice.
      if (rate > kBetter * best) {
        best = rate;
        best_W = to_eye_W;
      }
    }
  }
  return best_W;
}

}  // namespace

std::string MakeGapPicture(const Model& model, const GapReason& reason) {
  const std::vector<PictureBody> bodies = MakeBodies(model, reason);
  if (bodies.empty() || reason.direction_W == Vec3::Zero()) {
    return {};
  }
  const spatial::Box box_W = BoxAround(bodies);
  return MakePicture(
      bodies, Projection(box_W, kGapPictureWidth, kGapPictureHeight, ChooseView(bodies, box_W)));
}

std::string DescribeGapPicture(const Model& model, const GapReason& reason) {
  const std::string& name = model.product->occurrences[reason.occurrence.index()].path;
  return fmt::format(
      "{} {:.2f} mm along its best straight way out, and what stops it there; the "
      "faces that meet are red",
      name, units::ToMm(reason.travelled));
}

}  // namespace hvas::evidence
