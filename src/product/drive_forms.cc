#include "product/drive_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "product/axis_features.h"
#include "product/flats.h"
#include "product/polygons.h"

namespace hvas::product {
namespace {

/** The facing flats on both sides of an axis whose normals are along a direction. */
struct Walls {
  std::vector<FaceId> faces;
  double width{0};
  FlatExtent across;  ///< Extent along the slot.
  FlatExtent along;   ///< Extent along the axis that all have.
};

/** The walls of a slot through an axis: flats that face each other, at the same distance on both
 sides, and reach out on both sides of the axis. */
std::optional<Walls> FindSlotWalls(const Part& part, const std::vector<Flat>& flats,
                                   const Vec3& origin, const Vec3& axis, const Flat& first,
                                   double tolerance) {
  const double distance = -(first.centre - origin).dot(first.normal);
  if (distance < tolerance) {
    return std::nullopt;
  }
  const Vec3 side = axis.cross(first.normal);
  Walls walls;
  walls.width = 2 * distance;
  walls.along = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::array<FlatExtent, 2> reach;
  for (const Flat& flat : flats) {
    const double cosine = flat.normal.dot(first.normal);
    const double at = -(flat.centre - origin).dot(flat.normal);
    if (std::abs(cosine) < 1 - 0.5 * kSameFlatAngle * kSameFlatAngle ||
        std::abs(at - distance) > 4 * tolerance + kSameFlatWidth * distance) {
      continue;
    }
    const FlatExtent across = CalcFlatExtent(part, flat.face, origin, side);
    const FlatExtent along = CalcFlatExtent(part, flat.face, origin, axis);
    FlatExtent& of_side = reach[cosine > 0 ? 0 : 1];
    of_side.Add(across.low);
    of_side.Add(across.high);
    walls.along.low = std::max(walls.along.low, along.low);
    walls.along.high = std::min(walls.along.high, along.high);
    walls.faces.push_back(flat.face);
  }
  walls.across = {std::max(reach[0].low, reach[1].low), std::min(reach[0].high, reach[1].high)};
  constexpr double kLeastSpan = 1.5;  // Of a slot, in its widths: ISO 1207 has 5. A choice.
  constexpr double kEven = 0.2;       // By how much its ends may differ in distance.
  const double span = walls.across.high - walls.across.low;
  const bool is_even = std::abs(walls.across.high + walls.across.low) < kEven * span;
  if (!(walls.across.low < 0 && walls.across.high > 0) || !is_even ||
      span < kLeastSpan * walls.width || walls.along.high - walls.along.low < 4 * tolerance) {
    return std::nullopt;
  }
  return walls;
}

/** Slots and crosses on the axis of a hole or shaft. */
void FindSlotsOn(const Part& part, const std::vector<Flat>& flats, const Feature& feature,
                 double tolerance, std::vector<DriveForm>* found) {
  const Vec3 axis = Canonical(feature.axis_B);
  const Vec3& origin = feature.origin_B;
  std::vector<Flat> around;
  for (const Flat& flat : flats) {
    if (std::abs(flat.normal.dot(axis)) < kSameFlatAngle) {
      around.push_back(flat);
    }
  }
  std::vector<std::pair<Vec3, Walls>> slots;
  for (const Flat& flat : around) {
    const bool is_known = std::any_of(slots.begin(), slots.end(), [&flat](const auto& slot) {
      return std::find(slot.second.faces.begin(), slot.second.faces.end(), flat.face) !=
             slot.second.faces.end();
    });
    if (is_known) {
      continue;
    }
    if (auto walls = FindSlotWalls(part, around, origin, axis, flat, tolerance)) {
      slots.emplace_back(flat.normal, std::move(*walls));
    }
  }
  constexpr std::size_t kMostSlots = 2;  // Of a drive: more of them are a spline or a fan.
  if (slots.empty() || slots.size() > kMostSlots) {
    return;
  }
  DriveForm drive;
  drive.kind = DriveKind::kSlot;
  drive.is_recess = true;
  drive.flat_B = slots[0].first;
  drive.width = slots[0].second.width;
  drive.faces = slots[0].second.faces;
  FlatExtent along = slots[0].second.along;
  drive.span = slots[0].second.across.high - slots[0].second.across.low;
  if (slots.size() == 2) {
    const Walls& other = slots[1].second;
    if (std::abs(slots[0].first.dot(slots[1].first)) > kSameFlatAngle ||
        std::abs(other.width - drive.width) > kSameFlatWidth * drive.width) {
      return;
    }
    drive.kind = DriveKind::kCross;
    drive.faces.insert(drive.faces.end(), other.faces.begin(), other.faces.end());
    along = {std::max(along.low, other.along.low), std::min(along.high, other.along.high)};
  }
  // A fork or a hub with a keyway is no drive: a driver's slot is shallow in the part.
  const double size = part.box_B.size().norm();
  constexpr double kShallow = 0.5;  // Of the part's diagonal. A choice.
  if (along.high - along.low > kShallow * size) {
    return;
  }
  std::sort(drive.faces.begin(), drive.faces.end());
  const auto end = FindOpenEnd(part, drive.faces, true, drive.width, origin, axis, along);
  if (end && !end->is_through) {
    drive.origin_B = end->origin_B;
    drive.axis_B = end->axis_B;
    drive.depth = end->depth;
    found->push_back(std::move(drive));
  }
}

bool IsSame(const DriveForm& a, const DriveForm& b) {
  return a.faces == b.faces;
}

}  // namespace

std::vector<DriveForm> FindDriveForms(const Part& part, double tolerance,
                                      RecognitionLimits* limits) {
  const std::vector<Flat> flats = CollectFlats(part, limits);
  std::vector<DriveForm> found;
  for (PolygonForm& hexagon : FindRegularPolygons(part, 6, tolerance, limits)) {
    found.push_back({DriveKind::kHexagon, hexagon.is_recess, hexagon.is_through, hexagon.origin_B,
                     hexagon.axis_B, hexagon.flat_B, hexagon.width, 0, hexagon.depth,
                     std::move(hexagon.faces)});
  }
  for (const Feature& feature : part.features) {
    if (IsCylinder(feature.kind)) {
      FindSlotsOn(part, flats, feature, tolerance, &found);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const DriveForm& a, const DriveForm& b) {
    return a.faces.front() < b.faces.front();
  });
  found.erase(std::unique(found.begin(), found.end(), IsSame), found.end());
  return found;
}

}  // namespace hvas::product
