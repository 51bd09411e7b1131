#include "cad/step/step_surface.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace hvas::cad {
namespace {

using spatial::Pose;
using spatial::Surface;
using spatial::SurfaceKind;

/** The triple of a point or direction. */
std::optional<Vec3> ReadTriple(const StepText& text, std::uint64_t id) {
  for (const StepRecord& record : text.Find(id)) {
    if (record.values.size() > 1 && record.values[1].items.size() == 3) {
      const std::vector<StepValue>& items = record.values[1].items;
      const Vec3 triple(items[0].number, items[1].number, items[2].number);
      return triple.allFinite() ? std::optional(triple) : std::nullopt;
    }
  }
  return std::nullopt;
}

Vec3 ReadDirection(const StepText& text, const StepValue& value, const Vec3& otherwise) {
  const auto direction = value.reference > 0 ? ReadTriple(text, value.reference) : std::nullopt;
  return direction && direction->norm() > 1e-12 ? Vec3(direction->normalized()) : otherwise;
}

}  // namespace

std::optional<Vec3> ReadStepPoint(const StepText& text, std::uint64_t id, const ShapeUnits& units) {
  const auto point = ReadTriple(text, id);
  return point ? std::optional<Vec3>(units.length * *point) : std::nullopt;
}

std::optional<Pose> ReadStepPlacement(const StepText& text, std::uint64_t id,
                                      const ShapeUnits& units) {
  for (const StepRecord& record : text.Find(id)) {
    if (record.name != "AXIS2_PLACEMENT_3D" || record.values.size() < 4) {
      continue;
    }
    const auto point = ReadStepPoint(text, record.values[1].reference, units);
    if (!point) {
      return std::nullopt;
    }
    const Vec3 z = ReadDirection(text, record.values[2], Vec3::UnitZ());
    Vec3 x = ReadDirection(text, record.values[3], Vec3::UnitX());
    x -= x.dot(z) * z;
    if (x.norm() < 1e-9) {
      x = z.unitOrthogonal();
    }
    x.normalize();
    Mat3 R;
    R << x, z.cross(x), z;
    return Pose(Quat(R).normalized(), *point);
  }
  return std::nullopt;
}

std::optional<Surface> ReadStepSurface(const StepText& text, std::uint64_t id,
                                       const ShapeUnits& units) {
  StepEntity entity = text.Find(id);
  if (entity.size() == 1 &&
      (entity[0].name == "ADVANCED_FACE" || entity[0].name == "FACE_SURFACE") &&
      entity[0].values.size() > 2) {
    entity = text.Find(entity[0].values[2].reference);
  }
  if (entity.size() != 1 || entity[0].values.size() < 2) {
    return std::nullopt;
  }
  const StepRecord& record = entity[0];
  const auto placement = ReadStepPlacement(text, record.values[1].reference, units);
  if (!placement) {
    return std::nullopt;
  }
  const auto number = [&record](std::size_t i) {
    return i < record.values.size() ? record.values[i].number : 0;
  };
  Surface surface;
  surface.origin = placement->p();
  surface.axis = placement->q() * Vec3::UnitZ();
  surface.radius = units.length * number(2);
  bool is_sound = surface.radius > 0;
  if (record.name == "PLANE") {
    surface.kind = SurfaceKind::kPlane;
    surface.radius = 0;
    is_sound = true;
  } else if (record.name == "CYLINDRICAL_SURFACE") {
    surface.kind = SurfaceKind::kCylinder;
  } else if (record.name == "SPHERICAL_SURFACE") {
    surface.kind = SurfaceKind::kSphere;
  } else if (record.name == "TOROIDAL_SURFACE") {
    surface.kind = SurfaceKind::kTorus;
    surface.second = units.length * number(3);
    is_sound = surface.second > 0 && surface.second < surface.radius;
  } else if (record.name == "CONICAL_SURFACE") {
    surface.kind = SurfaceKind::kCone;
    surface.second = units.angle * number(3);
    is_sound = surface.radius >= 0 && surface.second > 0 && surface.second < std::numbers::pi / 2;
    if (is_sound) {
      surface.origin -= surface.radius / std::tan(surface.second) * surface.axis;
      surface.radius = 0;
    }
  } else {
    return std::nullopt;
  }
  return is_sound && std::isfinite(surface.radius) && std::isfinite(surface.second)
             ? std::optional(surface)
             : std::nullopt;
}

}  // namespace hvas::cad
