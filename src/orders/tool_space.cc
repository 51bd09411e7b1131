#include "orders/tool_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/units.h"
#include "spatial/box.h"

namespace hvas::orders {
namespace {

using product::DriveForm;
using product::DriveKind;

struct KeyArms {
  double width_mm, long_mm, short_mm;
};

// Source: ISO 2936, standard long arm and short arm, from public tables (docs/references.md).
constexpr std::array<KeyArms, 16> kKeys{{{1.3, 41, 13},
                                         {1.5, 46.5, 15.5},
                                         {2, 52, 18},
                                         {2.5, 58.5, 20.5},
                                         {3, 66, 23},
                                         {3.5, 69.5, 25.5},
                                         {4, 74, 29},
                                         {4.5, 80, 30.5},
                                         {5, 85, 33},
                                         {6, 96, 38},
                                         {7, 102, 41},
                                         {8, 108, 44},
                                         {9, 114, 47},
                                         {10, 122, 50},
                                         {12, 137, 57},
                                         {14, 154, 70}}};
constexpr double kPerWidth = 11;  // Lengths of larger keys, by their width, as the last one's.
constexpr double kCornersPerFlats = 2 / std::numbers::sqrt3;
// The outer diameter of sockets, some 15.5 mm for 10 mm and 27 mm for 19 mm, and their length with
// an extension: choices.
constexpr double kSocketPerWidth = 1.25;
constexpr double kSocketWall = 3e-3;     // [m]
constexpr double kSocketLength = 80e-3;  // [m]
constexpr double kOnFlats = 0.5;         // Of the flats' length that the socket covers: a choice.
// A screwdriver of usual size: choices.
constexpr double kBladeLength = 100e-3;   // [m]
constexpr double kThinnestBlade = 3e-3;   // [m]
constexpr double kHandleLength = 100e-3;  // [m]
constexpr double kHandleRadius = 15e-3;   // [m]
// What touches the tool as drawn is not in its way, as facets of round holes would be [m].
constexpr double kTouching = 50e-6;

ToolSpace MakeKey(double width, double stroke) {
  const double width_mm = units::ToMm(width);
  const auto key = std::find_if(kKeys.begin(), kKeys.end(), [width_mm](const KeyArms& arms) {
    return arms.width_mm > width_mm - 0.1;
  });
  const double long_arm = key != kKeys.end() ? units::FromMm(key->long_mm) : kPerWidth * width;
  const double short_arm =
      key != kKeys.end() ? units::FromMm(key->short_mm) : 0.5 * kPerWidth * width;
  const double corners = kCornersPerFlats * width;
  ToolSpace space;
  space.tool = fmt::format("hexagon key {:.3g} mm", width_mm);
  space.cylinders = {{0, long_arm + stroke, 0.5 * corners},
                     {long_arm - corners, long_arm + stroke, short_arm}};
  return space;
}

ToolSpace MakeSocket(const DriveForm& drive, double stroke) {
  ToolSpace space;
  space.tool = fmt::format("socket {:.3g} mm", units::ToMm(drive.width));
  space.cylinders = {{-kOnFlats * drive.depth, kSocketLength + stroke,
                      0.5 * (kSocketPerWidth * drive.width + kSocketWall)}};
  return space;
}

ToolSpace MakeScrewdriver(const DriveForm& drive, double stroke) {
  ToolSpace space;
  space.tool = "screwdriver";
  space.cylinders = {{0, kBladeLength + stroke, 0.5 * std::max(kThinnestBlade, drive.span)},
                     {kBladeLength, kBladeLength + kHandleLength + stroke, kHandleRadius}};
  return space;
}

/** A convex polygon: points with their place along the axis as z. */
struct Polygon {
  std::array<Vec3, 5> points;  // A triangle that two planes cut has five corners at most.
  std::size_t count{0};

  void Add(const Vec3& p) { points[count++] = p; }
};

/** What of a polygon is above a plane across the axis, or below it for sign -1. */
Polygon Clip(const Polygon& polygon, double place, double sign) {
  Polygon clipped;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3& a = polygon.points[i];
    const Vec3& b = polygon.points[(i + 1) % polygon.count];
    const double da = sign * (a.z() - place);
    const double db = sign * (b.z() - place);
    if (da >= 0) {
      clipped.Add(a);
    }
    if (da * db < 0) {
      clipped.Add(a + da / (da - db) * (b - a));
    }
  }
  return clipped;
}

/** Distance of a polygon from the axis. */
double CalcDistance(const Polygon& polygon) {
  double least = polygon.points[0].head<2>().norm();
  bool is_left = true;
  bool is_right = true;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const auto a = polygon.points[i].head<2>();
    const auto b = polygon.points[(i + 1) % polygon.count].head<2>();
    const auto ab = b - a;
    const double length_squared = ab.squaredNorm();
    const double s = length_squared > 0 ? std::clamp(-a.dot(ab) / length_squared, 0.0, 1.0) : 0.0;
    least = std::min(least, (a + s * ab).norm());
    const double turn = a.x() * b.y() - a.y() * b.x();
    is_left = is_left && turn > 0;
    is_right = is_right && turn < 0;
  }
  return is_left || is_right ? 0 : least;
}

}  // namespace

ToolSpace MakeToolSpace(const DriveForm& drive, const spatial::Pose& X_WB, const Vec3& axis_W,
                        double stroke) {
  ToolSpace space = drive.kind != DriveKind::kHexagon ? MakeScrewdriver(drive, stroke)
                    : drive.is_recess                 ? MakeKey(drive.width, stroke)
                                                      : MakeSocket(drive, stroke);
  // A nut may be put on with either end first: its tool comes from where the nut came from.
  const Vec3 out_W = X_WB.q() * -drive.axis_B;
  const bool is_turned = !drive.is_recess && out_W.dot(axis_W) < 0;
  space.axis_W = is_turned ? Vec3(-out_W) : out_W;
  space.p_WQ = X_WB * Vec3(drive.origin_B + (is_turned ? drive.depth : 0) * drive.axis_B);
  return space;
}

bool IsInToolSpace(const ToolSpace& space, const product::Part& part, const spatial::Pose& X_WB) {
  const spatial::Pose X_WQ(Quat::FromTwoVectors(Vec3::UnitZ(), space.axis_W), space.p_WQ);
  const spatial::Pose X_QB = X_WQ.Inverse() * X_WB;
  const spatial::Box box = spatial::Transform(X_QB, part.box_B);
  for (const ToolCylinder& cylinder : space.cylinders) {
    const double radius = cylinder.radius - kTouching;
    spatial::Box of_cylinder;
    of_cylinder.Add(Vec3(-radius, -radius, cylinder.from + kTouching));
    of_cylinder.Add(Vec3(radius, radius, cylinder.to));
    if (!of_cylinder.Overlaps(box)) {
      continue;
    }
    for (const auto& triangle : part.mesh.triangles) {
      Polygon polygon;
      for (const std::uint32_t vertex : triangle) {
        polygon.Add(X_QB * part.mesh.vertices[vertex]);
      }
      polygon = Clip(Clip(polygon, cylinder.from + kTouching, 1), cylinder.to, -1);
      if (polygon.count > 0 && CalcDistance(polygon) < radius) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hvas::orders
