#include "sequence/test/small_products.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "product/features.h"
#include "product/test/mesh_mass.h"

namespace hvas::sequence::testing {
namespace {

constexpr double kDeviation = 20e-6;  // [m] of chords from circles

product::Face MeasureFace(const product::Mesh& mesh, std::uint32_t first, std::uint32_t count,
                          const spatial::Surface& surface) {
  product::Face face;
  face.surface = surface;
  face.first_triangle = first;
  face.triangle_count = count;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3& a = mesh.vertices[t[0]];
    face.area += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    for (const std::uint32_t v : t) {
      face.box_B.Add(mesh.vertices[v]);
    }
  }
  return face;
}

}  // namespace

contact::ShapeSource SortByFace(const contact::ShapeSource& source) {
  contact::ShapeSource sorted = source;
  sorted.triangles.clear();
  sorted.triangle_face.clear();
  for (std::uint32_t face = 0; face < source.faces.size(); ++face) {
    for (std::size_t t = 0; t < source.triangles.size(); ++t) {
      if (source.triangle_face[t] == face) {
        sorted.triangles.push_back(source.triangles[t]);
        sorted.triangle_face.push_back(face);
      }
    }
  }
  return sorted;
}

PartId AddPart(Product* product, const std::string& name, const contact::ShapeSource& source) {
  product::Part part;
  part.id = PartId(product->parts.size());
  part.name = name;
  part.solid_count = 1;
  part.mesh.vertices = source.vertices;
  part.mesh.triangles = source.triangles;
  std::uint32_t first = 0;
  for (std::uint32_t f = 0; f < source.faces.size(); ++f) {
    std::uint32_t count = 0;
    while (first + count < source.triangle_face.size() &&
           source.triangle_face[first + count] == f) {
      ++count;
    }
    part.faces.push_back(MeasureFace(part.mesh, first, count, source.faces[f]));
    part.box_B.Add(part.faces.back().box_B);
    first += count;
  }
  part.mass = product::testing::CalcMass(part.mesh, part.material.density);
  product::BuildFeatures(&part);
  product->parts.push_back(std::move(part));
  return product->parts.back().id;
}

OccurrenceId Place(Product* product, PartId part, const std::string& name, const Pose& X_WB) {
  if (product->subassemblies.empty()) {
    product->subassemblies.emplace_back();
    product->subassemblies[0].id = product::SubassemblyId(0);
    product->subassemblies[0].name = product->name;
  }
  product::Occurrence occurrence;
  occurrence.id = OccurrenceId(product->occurrences.size());
  occurrence.part = part;
  occurrence.parent = product::SubassemblyId(0);
  occurrence.name = name;
  occurrence.path = product->name + "/" + name;
  occurrence.X_WB = X_WB;
  product->subassemblies[0].occurrences.push_back(occurrence.id);
  product->occurrences.push_back(occurrence);
  return occurrence.id;
}

void Complete(Product* product) {
  product->box_W = {};
  for (const product::Occurrence& occurrence : product->occurrences) {
    product->box_W.Add(spatial::Transform(occurrence.X_WB, product->part_of(occurrence.id).box_B));
  }
  Diagnostics diagnostics;
  mates::Infer(product, &diagnostics);
}

Product PegInBlock(const Pose& X_WP) {
  Product product;
  product.name = "rig";
  const PartId block =
      AddPart(&product, "block", contact::testing::Cup(kBoreRadius, 15e-3, kFloor, kBlockHeight));
  const PartId peg =
      AddPart(&product, "peg", contact::testing::Shaft(kBoreRadius, kPegLength, kDeviation));
  Place(&product, block, "block", X_WP);
  Place(&product, peg, "peg", X_WP * Pose(Vec3(0, 0, kFloor)));
  Complete(&product);
  return product;
}

Product PegInBlockInCollar() {
  constexpr double kFine = 0.1e-6;  // [m] of chords from circles.
  Product product = PegInBlock();
  const PartId collar =
      AddPart(&product, "collar", contact::testing::Bushing(16e-3, 20e-3, 5e-3, kFine));
  Place(&product, collar, "collar");
  product.mates.clear();
  Complete(&product);
  return product;
}

Product CoinUnderLid() {
  Product product;
  product.name = "box";
  const PartId cup = AddPart(&product, "cup", contact::testing::Cup(10e-3, 15e-3, 5e-3, 25e-3));
  const PartId coin = AddPart(&product, "coin", contact::testing::Shaft(5e-3, 10e-3, kDeviation));
  const PartId lid = AddPart(&product, "lid", contact::testing::Shaft(15e-3, 4e-3, kDeviation));
  Place(&product, cup, "cup");
  Place(&product, coin, "coin", Pose(Vec3(1e-3, 0, 5e-3)));
  Place(&product, lid, "lid", Pose(Vec3(0, 0, 25e-3)));
  Complete(&product);
  return product;
}

Product PendantUnderLid() {
  constexpr double kRim = 25e-3;
  constexpr double kLength = 10e-3;
  Product product;
  product.name = "box";
  const PartId cup = AddPart(&product, "cup", contact::testing::Cup(10e-3, 15e-3, 5e-3, kRim));
  const PartId lid = AddPart(&product, "lid", contact::testing::Shaft(15e-3, 4e-3, kDeviation));
  const PartId pendant =
      AddPart(&product, "pendant", contact::testing::Shaft(4e-3, kLength, kDeviation));
  Place(&product, cup, "cup");
  Place(&product, lid, "lid", Pose(Vec3(0, 0, kRim)));
  Place(&product, pendant, "pendant", Pose(Vec3(1e-3, 0, kRim - kLength)));
  Complete(&product);
  return product;
}

namespace {

Product MakeTrap(bool has_cap) {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  constexpr double kCollar = 10e-3;  // radius
  constexpr double kEnd = kCollarHeight + 4e-3;
  Product product;
  product.name = "trap";
  const PartId block =
      AddPart(&product, "block", contact::testing::Cup(kBoreRadius, 15e-3, kFloor, kBlockHeight));
  const PartId peg = AddPart(
      &product, "collared peg",
      contact::testing::Lathe(
          {{{{0, 0}, {kBoreRadius, 0}}, PlaneAt(0, -1)},
           {{{kBoreRadius, 0}, {kBoreRadius, kCollarHeight}}, CylinderZ(kBoreRadius, 1)},
           {{{kBoreRadius, kCollarHeight}, {kCollar, kCollarHeight}}, PlaneAt(kCollarHeight, -1)},
           {{{kCollar, kCollarHeight}, {kCollar, kEnd}}, CylinderZ(kCollar, 1)},
           {{{kCollar, kEnd}, {0, kEnd}}, PlaneAt(kEnd, 1)}},
          contact::testing::Segments(kCollar, kDeviation)));
  constexpr double kGap = 0.5e-3;  // Between collar and clamp.
  const Vec3 half(4e-3, 3e-3, 0.5 * (kClampHeight - kFloor - kEnd - kGap));
  const PartId clamp = AddPart(&product, "clamp", contact::testing::Block(half));
  Place(&product, block, "block");
  Place(&product, peg, "peg", Pose(Vec3(0, 0, kFloor)));
  Place(&product, clamp, "clamp", Pose(Vec3(11e-3, 0, kClampHeight - half.z())));
  if (has_cap) {
    const PartId cap = AddPart(&product, "cap", contact::testing::Shaft(4e-3, 3e-3, kDeviation));
    Place(&product, cap, "cap", Pose(Vec3(-4e-3, 0, kFloor + kEnd)));
  }
  Complete(&product);
  return product;
}

}  // namespace

Product CollarUnderClamp() {
  return MakeTrap(false);
}

Product CappedCollarUnderClamp() {
  return MakeTrap(true);
}

Product CaptiveRing() {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  constexpr double kNeck = 5e-3;
  constexpr double kFlange = 10e-3;
  constexpr double kLow = 6e-3;
  constexpr double kHigh = 16e-3;
  constexpr double kEnd = 22e-3;
  Product product;
  product.name = "captive";
  const PartId spool =
      AddPart(&product, "spool",
              contact::testing::Lathe({{{{0, 0}, {kFlange, 0}}, PlaneAt(0, -1)},
                                       {{{kFlange, 0}, {kFlange, kLow}}, CylinderZ(kFlange, 1)},
                                       {{{kFlange, kLow}, {kNeck, kLow}}, PlaneAt(kLow, 1)},
                                       {{{kNeck, kLow}, {kNeck, kHigh}}, CylinderZ(kNeck, 1)},
                                       {{{kNeck, kHigh}, {kFlange, kHigh}}, PlaneAt(kHigh, -1)},
                                       {{{kFlange, kHigh}, {kFlange, kEnd}}, CylinderZ(kFlange, 1)},
                                       {{{kFlange, kEnd}, {0, kEnd}}, PlaneAt(kEnd, 1)}},
                                      contact::testing::Segments(kFlange, kDeviation)));
  const PartId ring =
      AddPart(&product, "ring", contact::testing::Bushing(kNeck, 12e-3, 8e-3, kDeviation));
  Place(&product, spool, "spool");
  Place(&product, ring, "ring", Pose(Vec3(0, 0, 7e-3)));
  Complete(&product);
  return product;
}

Product CapOnBead(double outer_radius) {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  Product product;
  product.name = "bottle";
  const auto neck = AddPart(
      &product, "neck",
      contact::testing::Lathe({{{{0, 0}, {10e-3, 0}}, PlaneAt(0, -1)},
                               {{{10e-3, 0}, {10e-3, 12e-3}}, CylinderZ(10e-3, 1)},
                               {{{10e-3, 12e-3}, {10.3e-3, 12e-3}}, PlaneAt(12e-3, -1)},
                               {{{10.3e-3, 12e-3}, {10.3e-3, 13e-3}}, CylinderZ(10.3e-3, 1)},
                               {{{10.3e-3, 13e-3}, {10e-3, 13e-3}}, PlaneAt(13e-3, 1)},
                               {{{10e-3, 13e-3}, {10e-3, 17e-3}}, CylinderZ(10e-3, 1)},
                               {{{10e-3, 17e-3}, {0, 17e-3}}, PlaneAt(17e-3, 1)}},
                              64));
  const double r = outer_radius;
  const auto cap = AddPart(
      &product, "cap",
      contact::testing::Lathe({{{{0, 17e-3}, {10.4e-3, 17e-3}}, PlaneAt(17e-3, -1)},
                               {{{10.4e-3, 17e-3}, {10.4e-3, 11e-3}}, CylinderZ(10.4e-3, -1)},
                               {{{10.4e-3, 11e-3}, {10.05e-3, 11e-3}}, PlaneAt(11e-3, 1)},
                               {{{10.05e-3, 11e-3}, {10.05e-3, 10e-3}}, CylinderZ(10.05e-3, -1)},
                               {{{10.05e-3, 10e-3}, {r, 10e-3}}, PlaneAt(10e-3, -1)},
                               {{{r, 10e-3}, {r, 19e-3}}, CylinderZ(r, 1)},
                               {{{r, 19e-3}, {0, 19e-3}}, PlaneAt(19e-3, 1)}},
                              64));
  Place(&product, neck, "neck");
  Place(&product, cap, "cap");
  Complete(&product);
  return product;
}

Product BlocksOnPlate(int count) {
  const Vec3 half(10e-3, 15e-3, 8e-3);
  constexpr double kPitch = 30e-3;
  constexpr double kHalfPlate = 5e-3;  // Of its thickness.
  Product product;
  product.name = "row";
  const PartId plate = AddPart(
      &product, "plate", contact::testing::Block(Vec3(0.5 * kPitch * count, 20e-3, kHalfPlate)));
  const PartId block = AddPart(&product, "block", contact::testing::Block(half));
  Place(&product, plate, "plate");
  for (int i = 0; i < count; ++i) {
    const double x = kPitch * (i - 0.5 * (count - 1));
    Place(&product, block, "block " + std::to_string(i + 1),
          Pose(Vec3(x, 0, kHalfPlate + half.z())));
  }
  Complete(&product);
  return product;
}

Product StateRigid(Product product) {
  for (const product::Occurrence& occurrence : product.occurrences) {
    product.flexible.push_back({occurrence.id, product::FlexibleKind::kStated, 0, "a test"});
  }
  return product;
}

Product PegInCarrierInCup() {
  constexpr double kCupBore = 20e-3;
  constexpr double kCupFloor = 5e-3;
  Product product;
  product.name = "cup";
  const PartId cup =
      AddPart(&product, "cup", contact::testing::Cup(kCupBore, 28e-3, kCupFloor, 30e-3));
  const PartId carrier =
      AddPart(&product, "carrier", contact::testing::Bushing(kBoreRadius, kCupBore, 24e-3, 10e-6));
  const PartId peg = AddPart(&product, "peg", contact::testing::Shaft(kBoreRadius, kPegLength));
  Place(&product, cup, "cup");
  Place(&product, carrier, "carrier", Pose(Vec3(0, 0, kCupFloor)));
  Place(&product, peg, "peg", Pose(Vec3(0, 0, kCupFloor + 2e-3)));
  Complete(&product);
  return product;
}

}  // namespace hvas::sequence::testing
