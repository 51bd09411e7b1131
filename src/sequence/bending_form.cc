#include "sequence/bending_form.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "fits/elastic_parts.h"
#include "product/bearable_strain.h"
#include "product/flexible.h"
#include "product/mesh_ray.h"
#include "product/wall.h"
#include "spatial/pose.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

constexpr double kMostThickness = 1.0 / 3;  // Of the length; beams are slender: a choice.
constexpr double kBesideFaces = 0.1;        // Of the deflection: a choice.

/** How far the material of a part goes on from a point of it along a direction, and where it begins
 there, as distances [m]; none where it does not end within `reach`. */
std::optional<std::pair<double, double>> FindMaterial(const product::Part& part, const Vec3& p_B,
                                                      const Vec3& dir_B, double reach) {
  const std::vector<product::Crossing> crossings = product::ListCrossings(part, p_B, dir_B, reach);
  const auto leaves =
      std::find_if(crossings.begin(), crossings.end(),
                   [](const product::Crossing& crossing) { return !crossing.is_entering; });
  if (leaves == crossings.end()) {
    return std::nullopt;
  }
  const double begins = leaves == crossings.begin() ? 0.0 : std::prev(leaves)->distance;
  return std::pair(begins, leaves->distance);
}

}  // namespace

std::optional<Bending> FindBending(const product::Product& product, product::OccurrenceId id,
                                   const Vec3& p_W, const Vec3& inward_W, const Vec3& way_W,
                                   double deflection) {
  const product::Part& part = product.part_of(id);
  const spatial::Pose X_BW = product.occurrences[id.index()].X_WB.Inverse();
  const Vec3 way_B = X_BW.q() * way_W;
  const double length = product::CalcExtentAlong(part, way_B);
  const Vec3 inward_B = X_BW.q() * inward_W;
  const Vec3 p_B = X_BW * p_W;
  const double most = kMostThickness * length;
  // A ray in the plane of a face is in the material or beside it as rounding has it.
  const double aside = kBesideFaces * deflection;
  const Vec3 across_B = way_B.cross(inward_B);
  double thickness = 0;
  double back = 0;
  for (int k = 0; k < 9; ++k) {
    const Vec3 from_B = p_B + aside * ((k / 3 - 1) * way_B + (k % 3 - 1) * across_B);
    const auto inner = FindMaterial(part, from_B, inward_B, most);
    if (!inner || inner->first > deflection) {
      continue;
    }
    // Where the point is in the material, what lies behind it counts, too.
    const auto outer = FindMaterial(part, from_B, -inward_B, part.box_B.size().norm());
    const bool is_inside = inner->first == 0 && outer && outer->first == 0;
    const double there = inner->second - inner->first + (is_inside ? outer->second : 0.0);
    if (there > thickness) {
      thickness = there;
      back = inner->second;
    }
  }
  if (!(thickness > 0) || thickness > most) {
    return std::nullopt;
  }
  const fits::SnapArm arm{length, 0, thickness, 0};
  return Bending{deflection / fits::CalcArmDeflection(arm, 1), length, thickness,
                 p_W + back * inward_W};
}

namespace {

/** A wall that would bend aside, and where it is on the way. */
struct BendingWall {
  OccurrenceId part;
  Vec3 p_back_W;      // Its far side, while the two meet.
  Vec3 inward_W;      // Unit, where it bends.
  double deflection;  // [m]
};

/** Looks for what a wall would come to: along a line that begins before its far side, as what it
 meets may lie in it there. */
std::optional<NoRoom> FindNoRoom(const product::Product& product, const SideMeeting& meeting,
                                 const BendingWall& wall, const std::vector<bool>& is_present) {
  constexpr double kAround = 1.5;  // Of the deflection: what overlaps lies before the far side.
  const double before = kAround * wall.deflection;
  std::optional<NoRoom> nearest;
  for (const product::Occurrence& occurrence : product.occurrences) {
    if (occurrence.id == wall.part ||
        (!is_present[occurrence.id.index()] && occurrence.id != meeting.moved)) {
      continue;
    }
    const bool is_moved = occurrence.id == meeting.moved;
    const Vec3 travel_W = is_moved ? Vec3(meeting.travelled * meeting.way_W) : Vec3::Zero();
    const spatial::Pose X_BW = occurrence.X_WB.Inverse();
    const Vec3 p_B = X_BW * Vec3(wall.p_back_W - before * wall.inward_W - travel_W);
    const product::Part& part = product.part_of(occurrence.id);
    spatial::Box reach = part.box_B;
    reach.low.array() -= 2 * before;
    reach.high.array() += 2 * before;
    if ((p_B.array() < reach.low.array()).any() || (p_B.array() > reach.high.array()).any()) {
      continue;
    }
    const auto hit = product::FindFirstHit(part, p_B, X_BW.q() * wall.inward_W, 2 * before);
    const double free = hit ? std::max(0.0, hit->distance - before) : 0;
    if (hit && (!nearest || free < nearest->free)) {
      nearest = NoRoom{wall.part, occurrence.id, wall.deflection, free};
    }
  }
  return nearest;
}

}  // namespace

BendingAnswer FindWhatBends(const product::Product& product, const SideMeeting& meeting,
                            const std::vector<bool>& is_present) {
  BendingAnswer answer;
  const Vec3 aside_W =
      (meeting.nhat_W - meeting.nhat_W.dot(meeting.way_W) * meeting.way_W).normalized();
  const auto look = [&](OccurrenceId part, const Vec3& inward_W) {
    // The part that bends is looked at as drawn.
    const Vec3 moved_W =
        part == meeting.moved ? Vec3(meeting.travelled * meeting.way_W) : Vec3::Zero();
    const auto bending =
        FindBending(product, part, meeting.p_W - moved_W, inward_W, meeting.way_W, meeting.width);
    if (!bending || bending->strain > FindBearableStrain(product.part_of(part).material)) {
      return;
    }
    const BendingWall wall{part, bending->p_back_W + moved_W, inward_W, meeting.width};
    if (auto no_room = FindNoRoom(product, meeting, wall, is_present)) {
      const bool has_more = !answer.no_room || no_room->free > answer.no_room->free;
      answer.no_room = has_more ? no_room : answer.no_room;
    } else if (!answer.bends || bending->strain < answer.bends->bending.strain) {
      answer.bends = WhatBends{part, *bending, inward_W.dot(meeting.nhat_W) > 0 ? 1.0 : -1.0};
    }
  };
  for (const OccurrenceId part : {meeting.moved, meeting.other}) {
    if (!IsStatedRigid(product, part)) {
      // Past the middle of a thin wall, the nearest way out of it leads on: both sides are looked
      // at.
      look(part, aside_W);
      look(part, -aside_W);
    }
  }
  if (answer.bends) {
    answer.no_room.reset();
  }
  return answer;
}

}  // namespace hvas::sequence
