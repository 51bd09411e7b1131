#include "mates/explain_freedom.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"

namespace hvas::mates {
namespace {

using product::OccurrenceId;
using product::Part;
using product::Product;
using spatial::Surface;
using spatial::SurfaceKind;

constexpr double kSameDirection = 1e-4;  // Sine between axes that count as one: a choice.
constexpr double kSamePlace = 10e-6;     // [m], as planes that touch.

double RoundOff(double x) {
  return std::abs(x) < 5e-3 ? 0.0 : x;  // No "-0.00".
}

std::string DescribeDirection(const Vec3& direction) {
  // One of two opposed ones: the first number that is not zero is positive.
  Vec3 shown = direction;
  for (const double x : direction) {
    if (std::abs(x) > 1e-6) {
      shown = x < 0 ? Vec3(-direction) : direction;
      break;
    }
  }
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", RoundOff(shown.x()), RoundOff(shown.y()),
                     RoundOff(shown.z()));
}

/** The point of the axis of a turn that is nearest to a point. @param p_WB  Where the turn has v.
 */
Vec3 FindNearestPoint(const Twist& turn, const Vec3& p_WB, const Vec3& p_WQ) {
  const Vec3 p_WA = p_WB + turn.w.cross(turn.v);
  return p_WA + turn.w.dot(p_WQ - p_WA) * turn.w;
}

bool IsSurfaceRound(const Surface& surface, const Vec3& p_BQ, const Vec3& axis_B) {
  const auto is_on_axis = [&](const Vec3& p) { return axis_B.cross(p - p_BQ).norm() < kSamePlace; };
  const bool is_along = surface.axis.cross(axis_B).norm() < kSameDirection;
  switch (surface.kind) {
    case SurfaceKind::kPlane:
      return is_along;
    case SurfaceKind::kCylinder:
    case SurfaceKind::kCone:
    case SurfaceKind::kTorus:
      return is_along && is_on_axis(surface.origin);
    case SurfaceKind::kSphere:
      return is_on_axis(surface.origin);
    case SurfaceKind::kFreeform:
      return false;
  }
  return false;
}

}  // namespace

bool IsRoundAbout(const Part& part, const Vec3& p_BQ, const Vec3& axis_B) {
  return !part.faces.empty() &&
         std::all_of(part.faces.begin(), part.faces.end(), [&](const product::Face& face) {
           return IsSurfaceRound(face.surface, p_BQ, axis_B);
         });
}

std::optional<std::string> ExplainFreedom(const Product& product,
                                          const std::vector<OccurrenceId>& members,
                                          const BodyFreedom& freedom, const Pose& X_WB) {
  std::vector<std::string> shifts;
  for (const Vec3& shift : freedom.shifts) {
    shifts.push_back(DescribeDirection(shift));
  }
  const Vec3 centre_W = spatial::Transform(product.occurrences[members.front().index()].X_WB,
                                           product.part_of(members.front()).box_B)
                            .centre();
  std::vector<std::string> turns;
  for (const Twist& turn : freedom.turns) {
    const Vec3 p_WQ = FindNearestPoint(turn, X_WB.p(), centre_W);
    const bool is_round = std::all_of(members.begin(), members.end(), [&](OccurrenceId id) {
      const Pose X_BW = product.occurrences[id.index()].X_WB.Inverse();
      return IsRoundAbout(product.part_of(id), X_BW * p_WQ, X_BW.q() * turn.w);
    });
    if (!is_round) {
      turns.push_back(fmt::format("{} through ({:.1f}, {:.1f}, {:.1f}) mm",
                                  DescribeDirection(turn.w), units::ToMm(p_WQ.x()),
                                  units::ToMm(p_WQ.y()), units::ToMm(p_WQ.z())));
    }
  }
  if (shifts.empty() && turns.empty()) {
    return std::nullopt;
  }
  std::string text = "the mates leave the part free to be";
  if (!shifts.empty()) {
    text += fmt::format(" shifted along {}", fmt::join(shifts, " and "));
  }
  if (!turns.empty()) {
    text += fmt::format("{} turned about {}", shifts.empty() ? "" : ", and",
                        fmt::join(turns, " and about "));
  }
  return text + "; there it is as drawn";
}

}  // namespace hvas::mates
