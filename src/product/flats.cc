#include "product/flats.h"

#include <algorithm>

#include "product/mesh_ray.h"

namespace hvas::product {
namespace {

constexpr std::size_t kMostFlats = 600;  // Planes of a part; a choice, for the time it takes.

/** How far the material of a part goes on beside the flats, at either end: blocked or open. Rays
 start beside the middle of each flat of a form outside the material, or on the axis of a recess. */
bool IsOpenTowards(const Part& part, const std::vector<FaceId>& faces, bool is_recess, double width,
                   const Vec3& middle, const Vec3& direction) {
  const double reach = part.box_B.size().norm();
  if (is_recess) {
    return !IsBlocked(part, middle, direction, reach);
  }
  constexpr double kBeside = 0.08;  // Of the width: within the wall of what is put on.
  return std::none_of(faces.begin(), faces.end(), [&](FaceId face) {
    const Vec3& n = part.faces[face.index()].surface.axis;
    return IsBlocked(part, middle + (0.5 + kBeside) * width * n, direction, reach);
  });
}

}  // namespace

void FlatExtent::Add(double x) {
  low = std::min(low, x);
  high = std::max(high, x);
}

std::vector<Flat> CollectFlats(const Part& part, RecognitionLimits* limits) {
  std::vector<Flat> flats;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    const Face& face = part.faces[f];
    if (face.surface.kind != SurfaceKind::kPlane || face.triangle_count == 0) {
      continue;
    }
    if (flats.size() == kMostFlats) {
      limits->Add("more than 600 planes for drives and polygons");
      break;
    }
    const Vec3& normal = face.surface.axis;
    const Vec3 centre = face.box_B.centre();
    flats.push_back(
        {FaceId(f), normal, centre - (centre - face.surface.origin).dot(normal) * normal});
  }
  return flats;
}

FlatExtent CalcFlatExtent(const Part& part, FaceId id, const Vec3& origin, const Vec3& dir) {
  const Face& face = part.faces[id.index()];
  FlatExtent extent;
  for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
    for (const std::uint32_t v : part.mesh.triangles[t]) {
      extent.Add((part.mesh.vertices[v] - origin).dot(dir));
    }
  }
  return extent;
}

std::optional<OpenEnd> FindOpenEnd(const Part& part, const std::vector<FaceId>& faces,
                                   bool is_recess, double width, const Vec3& origin,
                                   const Vec3& axis, const FlatExtent& along) {
  const Vec3 middle = origin + 0.5 * (along.low + along.high) * axis;
  const bool is_open_low = IsOpenTowards(part, faces, is_recess, width, middle, -axis);
  const bool is_open_high = IsOpenTowards(part, faces, is_recess, width, middle, axis);
  if (!is_open_low && !is_open_high) {
    return std::nullopt;
  }
  OpenEnd end;
  bool enters_low = is_open_low;
  end.is_through = is_open_low && is_open_high;
  if (end.is_through) {
    // From the end beyond which less of the part is: away from a bolt's shank.
    FlatExtent whole;
    for (const Vec3& vertex : part.mesh.vertices) {
      whole.Add((vertex - origin).dot(axis));
    }
    enters_low = along.low - whole.low <= whole.high - along.high + 1e-9;
  }
  end.origin_B = origin + (enters_low ? along.low : along.high) * axis;
  end.axis_B = enters_low ? axis : Vec3(-axis);
  end.depth = along.length();
  return end;
}

}  // namespace hvas::product
