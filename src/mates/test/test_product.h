#pragma once

#include <numbers>
#include <string>

#include "product/product.h"

/** Products written by hand: features with the faces and triangles that inference looks at. */
namespace hvas::mates::testing {

inline constexpr double kFullTurn = 2 * std::numbers::pi;

inline product::FaceId AddFace(product::Part* part) {
  part->faces.emplace_back();
  part->faces.back().first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
  return product::FaceId(part->faces.size() - 1);
}

/** A hole or shaft along `axis_B` from `low` to `high`, seen from `origin_B`. */
inline void AddCylinder(product::Part* part, product::FeatureKind kind, const Vec3& origin_B,
                        const Vec3& axis_B, double radius, double low, double high,
                        double coverage = kFullTurn) {
  product::Feature feature;
  feature.kind = kind;
  feature.faces = {AddFace(part)};
  feature.origin_B = origin_B;
  feature.axis_B = axis_B;
  feature.radius = radius;
  feature.span_low = low;
  feature.span_high = high;
  feature.coverage = coverage;
  feature.area = coverage * radius * (high - low);
  part->features.push_back(feature);
  for (const double s : {low, high}) {
    part->box_B.Add(spatial::Box{origin_B + s * axis_B, origin_B + s * axis_B}.Expanded(radius));
  }
}

/** A rectangle of 2 half_x by 2 half_y around `centre_B`, its sides along FrameFromZ(normal_B). */
inline void AddRectangle(product::Part* part, const Vec3& centre_B, const Vec3& normal_B,
                         double half_x, double half_y) {
  const product::FaceId id = AddFace(part);
  product::Face& face = part->faces[id.index()];
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  const Mat3 R = spatial::FrameFromZ(normal_B).toRotationMatrix();
  for (const auto& [x, y] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    const Vec3 p_B = centre_B + R * Vec3(x * half_x, y * half_y, 0);
    part->mesh.vertices.push_back(p_B);
    face.box_B.Add(p_B);
  }
  part->mesh.triangles.push_back({first, first + 1, first + 2});
  part->mesh.triangles.push_back({first, first + 2, first + 3});
  face.triangle_count = 2;
  face.area = 4 * half_x * half_y;
  part->box_B.Add(face.box_B);
  product::Feature feature;
  feature.kind = product::FeatureKind::kPlane;
  feature.faces = {id};
  feature.origin_B = centre_B;
  feature.axis_B = normal_B;
  feature.area = face.area;
  part->features.push_back(feature);
}

inline product::Part* AddPart(product::Product* product, const std::string& name) {
  product::Part part;
  part.id = product::PartId(product->parts.size());
  part.name = name;
  product->parts.push_back(part);
  return &product->parts.back();
}

inline product::OccurrenceId AddOccurrence(product::Product* product, product::PartId part,
                                           const spatial::Pose& X_WB) {
  if (product->subassemblies.empty()) {
    product->subassemblies.emplace_back();
    product->subassemblies.back().id = product::SubassemblyId(0);
  }
  product::Occurrence occurrence;
  occurrence.id = product::OccurrenceId(product->occurrences.size());
  occurrence.part = part;
  occurrence.parent = product::SubassemblyId(0);
  occurrence.name = product->parts[part.index()].name;
  occurrence.path = occurrence.name + "#" + std::to_string(product->occurrences.size() + 1);
  occurrence.X_WB = X_WB;
  product->subassemblies[0].occurrences.push_back(occurrence.id);
  product->occurrences.push_back(occurrence);
  return occurrence.id;
}

}  // namespace hvas::mates::testing
