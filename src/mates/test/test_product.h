#pragma once

#include <algorithm>
#include <cmath>
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

/** Triangles of a face whose points are at(u, v) for u, v in 0..1, `columns` by `rows` cells. */
template <typename At>
product::FaceId AddGridFace(product::Part* part, int columns, int rows, const At& at) {
  const product::FaceId id = AddFace(part);
  product::Face& face = part->faces[id.index()];
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  const auto width = static_cast<std::uint32_t>(columns + 1);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Vec3 p_B = at(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
      part->mesh.vertices.push_back(p_B);
      face.box_B.Add(p_B);
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i + 1 < width; ++i) {
      const std::uint32_t k = first + j * width + i;
      part->mesh.triangles.push_back({k, k + 1, k + width});
      part->mesh.triangles.push_back({k + 1, k + width + 1, k + width});
    }
  }
  face.triangle_count = static_cast<std::uint32_t>(2 * columns * rows);
  part->box_B.Add(face.box_B);
  return id;
}

/** A face of a cylinder (equal radii) or cone about z, from `begin` over `sweep` [rad]. */
inline product::FaceId AddRoundFace(product::Part* part, double radius_low, double radius_high,
                                    double low, double high, double begin, double sweep) {
  return AddGridFace(part, 24, 1, [=](double u, double v) {
    const double r = radius_low + v * (radius_high - radius_low);
    const double angle = begin + u * sweep;
    return Vec3(r * std::cos(angle), r * std::sin(angle), low + v * (high - low));
  });
}

/** A conical seat or taper with its apex at `apex_B`, from `low` to `high` along `axis_B`. */
inline void AddCone(product::Part* part, product::FeatureKind kind, const Vec3& apex_B,
                    const Vec3& axis_B, double half_angle, double low, double high) {
  const double slope = std::tan(half_angle);
  AddCylinder(part, kind, apex_B, axis_B, slope * high, low, high);
  product::Feature& feature = part->features.back();
  feature.half_angle = half_angle;
  feature.area = std::numbers::pi * slope * (high * high - low * low) / std::cos(half_angle);
}

/** The cap of a sphere around `centre_B` up to the polar angle from z: a ball, or a socket. */
inline void AddCap(product::Part* part, product::FeatureKind kind, const Vec3& centre_B,
                   double radius, double polar_begin, double polar_end) {
  product::Feature feature;
  feature.kind = kind;
  feature.faces = {AddGridFace(part, 48, 24, [&](double u, double v) {
    const double polar = polar_begin + v * (polar_end - polar_begin);
    const double angle = kFullTurn * u;
    return Vec3(centre_B + radius * Vec3(std::sin(polar) * std::cos(angle),
                                         std::sin(polar) * std::sin(angle), std::cos(polar)));
  })};
  feature.origin_B = centre_B;
  feature.radius = radius;
  feature.coverage = kFullTurn;
  feature.area = kFullTurn * radius * radius * (std::cos(polar_begin) - std::cos(polar_end));
  part->features.push_back(feature);
}

inline product::Part* AddPart(product::Product* product, const std::string& name) {
  product::Part part;
  part.id = product::PartId(product->parts.size());
  part.name = name;
  product->parts.push_back(part);
  return &product->parts.back();
}

inline product::SubassemblyId AddSubassembly(product::Product* product, const std::string& name) {
  product::Subassembly node;
  node.id = product::SubassemblyId(product->subassemblies.size());
  node.name = name;
  if (node.id.index() > 0) {
    node.parent = product::SubassemblyId(0);
    product->subassemblies[0].subassemblies.push_back(node.id);
  }
  product->subassemblies.push_back(node);
  return node.id;
}

inline product::OccurrenceId AddOccurrence(
    product::Product* product, product::PartId part, const spatial::Pose& X_WB,
    product::SubassemblyId parent = product::SubassemblyId(0)) {
  if (product->subassemblies.empty()) {
    AddSubassembly(product, "product");
  }
  product::Occurrence occurrence;
  occurrence.id = product::OccurrenceId(product->occurrences.size());
  occurrence.part = part;
  occurrence.parent = parent;
  occurrence.name = product->parts[part.index()].name;
  occurrence.path = occurrence.name + "#" + std::to_string(product->occurrences.size() + 1);
  occurrence.X_WB = X_WB;
  product->subassemblies[parent.index()].occurrences.push_back(occurrence.id);
  product->occurrences.push_back(occurrence);
  return occurrence.id;
}

[[nodiscard]] inline int CountMates(const product::Product& product, product::MateKind kind) {
  return static_cast<int>(
      std::count_if(product.mates.begin(), product.mates.end(),
                    [kind](const product::Mate& mate) { return mate.kind == kind; }));
}

}  // namespace hvas::mates::testing
