#include "product/drive_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/units.h"
#include "product/axis_features.h"
#include "product/mesh_ray.h"

namespace hvas::product {
namespace {

constexpr std::size_t kMostFlats = 600;   // Planes of a part; a choice, for the time it takes.
constexpr std::size_t kMostPairs = 4000;  // Of opposite planes; so.
constexpr double kSameFlatWidth = 1e-3;   // Share by which widths of one hexagon may differ.
constexpr double kSameFlatAngle = 2e-3;   // [rad]: what exports err by, as in mates/fasteners.cc.
constexpr double kCentred = 0.25;         // Of the width, by which a flat's middle may be aside.

/** A plane face with a point of its plane near its middle. */
struct Flat {
  FaceId face;
  Vec3 normal;
  Vec3 centre;
};

/** Two opposite flats: `width` apart, and away from one another (outside) or facing (a recess). */
struct Pair {
  const Flat* a;
  const Flat* b;
  double width;
  double middle;  ///< Offset of the middle plane along the normal of `a` [m].
  bool is_recess;
};

struct Interval {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void Add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

Interval CalcFlatExtent(const Part& part, FaceId id, const Vec3& origin, const Vec3& dir) {
  const Face& face = part.faces[id.index()];
  Interval extent;
  for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
    for (const std::uint32_t v : part.mesh.triangles[t]) {
      extent.Add((part.mesh.vertices[v] - origin).dot(dir));
    }
  }
  return extent;
}

std::vector<Flat> CollectDriveFlats(const Part& part, RecognitionLimits* limits) {
  std::vector<Flat> flats;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    const Face& face = part.faces[f];
    if (face.surface.kind != SurfaceKind::kPlane || face.triangle_count == 0) {
      continue;
    }
    if (flats.size() == kMostFlats) {
      limits->Add("more than 600 planes for drives");
      break;
    }
    const Vec3& normal = face.surface.axis;
    const Vec3 centre = face.box_B.centre();
    flats.push_back(
        {FaceId(f), normal, centre - (centre - face.surface.origin).dot(normal) * normal});
  }
  return flats;
}

std::vector<Pair> CollectFlatPairs(const std::vector<Flat>& flats, RecognitionLimits* limits) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < flats.size(); ++i) {
    for (std::size_t j = i + 1; j < flats.size(); ++j) {
      const Flat& a = flats[i];
      const Flat& b = flats[j];
      if (a.normal.dot(b.normal) > -1 + 0.5 * kSameFlatAngle * kSameFlatAngle) {
        continue;
      }
      const Vec3 across = a.centre - b.centre;
      const double width = across.dot(a.normal);
      if (std::abs(width) == 0) {
        continue;
      }
      if (pairs.size() == kMostPairs) {
        limits->Add("more than 4,000 pairs of planes for drives");
        return pairs;
      }
      pairs.push_back(
          {&a, &b, std::abs(width), 0.5 * (a.centre + b.centre).dot(a.normal), width < 0});
    }
  }
  return pairs;
}

/** Point of the line with direction n_p x n_q in which the middle planes of two pairs meet. */
Vec3 CalcLinePoint(const Pair& p, const Pair& q, const Vec3& near) {
  Mat3 A;
  const Vec3 axis = p.a->normal.cross(q.a->normal).normalized();
  A.row(0) = p.a->normal;
  A.row(1) = q.a->normal;
  A.row(2) = axis;
  return A.inverse() * Vec3(p.middle, q.middle, axis.dot(near));
}

/** How far the material of a part goes on beside the flats, at either end: blocked or open. Rays
 start beside the middle of each flat of a drive outside the material, or on the axis of a recess.
 */
bool IsOpenTowards(const Part& part, const DriveForm& drive, const Vec3& middle,
                   const Vec3& direction) {
  const double reach = part.box_B.size().norm();
  if (drive.is_recess) {
    return !IsBlocked(part, middle, direction, reach);
  }
  constexpr double kBeside = 0.08;  // Of the width: within the wall of what is put on.
  return std::none_of(drive.faces.begin(), drive.faces.end(), [&](FaceId face) {
    const Vec3& n = part.faces[face.index()].surface.axis;
    return IsBlocked(part, middle + (0.5 + kBeside) * drive.width * n, direction, reach);
  });
}

/** Chooses the open end of a drive along its axis. None where both ends are closed. */
std::optional<DriveForm> Orient(const Part& part, DriveForm drive, const Vec3& origin,
                                const Vec3& axis, const Interval& along) {
  const double mid = 0.5 * (along.low + along.high);
  const Vec3 middle = origin + mid * axis;
  const bool is_open_low = IsOpenTowards(part, drive, middle, -axis);
  const bool is_open_high = IsOpenTowards(part, drive, middle, axis);
  if (!is_open_low && !is_open_high) {
    return std::nullopt;
  }
  bool enters_low = is_open_low;
  drive.is_through = is_open_low && is_open_high;
  if (drive.is_through) {
    // From the end beyond which less of the part is: away from a bolt's shank.
    Interval whole;
    for (const Vec3& vertex : part.mesh.vertices) {
      whole.Add((vertex - origin).dot(axis));
    }
    enters_low = along.low - whole.low <= whole.high - along.high + 1e-9;
  }
  drive.origin_B = origin + (enters_low ? along.low : along.high) * axis;
  drive.axis_B = enters_low ? axis : Vec3(-axis);
  drive.depth = along.high - along.low;
  return drive;
}

/** Whether the middle of a flat is at the axis, seen along its normal. */
bool IsCentred(const Part& part, const Flat& flat, const Vec3& origin, const Vec3& axis,
               double width) {
  const Interval side = CalcFlatExtent(part, flat.face, origin, axis.cross(flat.normal));
  return std::abs(0.5 * (side.low + side.high)) < kCentred * width;
}

/** The hexagon of three pairs of flats, where they make one. */
std::optional<DriveForm> MakeHexagon(const Part& part, const std::array<const Pair*, 3>& pairs,
                                     double tolerance) {
  const Pair& p = *pairs[0];
  const Vec3 axis = Canonical(p.a->normal.cross(pairs[1]->a->normal).normalized());
  const Vec3 origin = CalcLinePoint(p, *pairs[1], p.a->centre);
  const Pair& r = *pairs[2];
  if (std::abs(r.a->normal.dot(axis)) > kSameFlatAngle ||
      std::abs(r.a->normal.dot(origin) - r.middle) > 4 * tolerance + kSameFlatWidth * r.width) {
    return std::nullopt;
  }
  DriveForm drive;
  drive.kind = DriveKind::kHexagon;
  drive.is_recess = p.is_recess;
  drive.width = p.width;
  drive.flat_B = p.a->normal;
  Interval along{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const Pair* pair : pairs) {
    for (const Flat* flat : {pair->a, pair->b}) {
      if (!IsCentred(part, *flat, origin, axis, p.width)) {
        return std::nullopt;
      }
      const Interval extent = CalcFlatExtent(part, flat->face, origin, axis);
      along.low = std::max(along.low, extent.low);
      along.high = std::min(along.high, extent.high);
      drive.faces.push_back(flat->face);
    }
  }
  constexpr double kLeastDepth = 0.05;  // Of the width: a chamfer's rest is no drive. A choice.
  if (along.high - along.low < kLeastDepth * p.width) {
    return std::nullopt;
  }
  std::sort(drive.faces.begin(), drive.faces.end());
  return Orient(part, std::move(drive), origin, axis, along);
}

bool AreAtSixth(const Pair& p, const Pair& q) {
  return p.is_recess == q.is_recess && std::abs(p.width - q.width) < kSameFlatWidth * p.width &&
         std::abs(std::abs(p.a->normal.dot(q.a->normal)) - 0.5) < kSameFlatAngle;
}

void FindHexagons(const Part& part, const std::vector<Pair>& pairs, double tolerance,
                  std::vector<DriveForm>* found) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      if (!AreAtSixth(pairs[i], pairs[j])) {
        continue;
      }
      for (std::size_t k = j + 1; k < pairs.size(); ++k) {
        if (!AreAtSixth(pairs[i], pairs[k]) || !AreAtSixth(pairs[j], pairs[k])) {
          continue;
        }
        if (auto drive = MakeHexagon(part, {&pairs[i], &pairs[j], &pairs[k]}, tolerance)) {
          found->push_back(std::move(*drive));
        }
      }
    }
  }
}

/** The facing flats on both sides of an axis whose normals are along a direction. */
struct Walls {
  std::vector<FaceId> faces;
  double width{0};
  Interval across;  ///< Extent along the slot.
  Interval along;   ///< Extent along the axis that all have.
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
  std::array<Interval, 2> reach;
  for (const Flat& flat : flats) {
    const double cosine = flat.normal.dot(first.normal);
    const double at = -(flat.centre - origin).dot(flat.normal);
    if (std::abs(cosine) < 1 - 0.5 * kSameFlatAngle * kSameFlatAngle ||
        std::abs(at - distance) > 4 * tolerance + kSameFlatWidth * distance) {
      continue;
    }
    const Interval across = CalcFlatExtent(part, flat.face, origin, side);
    const Interval along = CalcFlatExtent(part, flat.face, origin, axis);
    Interval& of_side = reach[cosine > 0 ? 0 : 1];
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
  Interval along = slots[0].second.along;
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
  auto oriented = Orient(part, std::move(drive), origin, axis, along);
  if (oriented && !oriented->is_through) {
    found->push_back(std::move(*oriented));
  }
}

bool IsSame(const DriveForm& a, const DriveForm& b) {
  return a.faces == b.faces;
}

}  // namespace

std::vector<DriveForm> FindDriveForms(const Part& part, double tolerance,
                                      RecognitionLimits* limits) {
  const std::vector<Flat> flats = CollectDriveFlats(part, limits);
  const std::vector<Pair> pairs = CollectFlatPairs(flats, limits);
  std::vector<DriveForm> found;
  FindHexagons(part, pairs, tolerance, &found);
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
