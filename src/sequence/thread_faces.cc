#include "sequence/thread_faces.h"

#include <algorithm>
#include <set>

#include "mates/mate_kind.h"
#include "product/axis_features.h"

namespace hvas::sequence {
namespace {

constexpr double kDrawnOverlap = 20e-6;  // [m] of radius; less is drawn at its nominal size

}  // namespace

bool IsDrawnThread(const product::Mate& mate) {
  const bool has_kind = mate.fit && (mate.fit->kind == product::FitKind::kThread ||
                                     mate.fit->kind == product::FitKind::kInsert);
  return has_kind && mate.shaft_radius > mate.hole_radius + kDrawnOverlap;
}

std::vector<product::FaceId> ListLockingFaces(const product::Product& product,
                                              const product::Mate& mate) {
  constexpr double kNarrowest =
      0.7;  // Of the screw's radius; nuts of ISO 7040 have 0.78. A choice.
  const product::Part& part = product.part_of(mate.a.occurrence);
  const product::Feature& thread = part.features[mate.a.feature.index()];
  constexpr double kOnAxis = 50e-6;  // [m]: rings are drawn less exactly than threads. A choice.
  std::vector<product::FaceId> faces;
  for (const product::Feature& feature : part.features) {
    if (feature.kind == product::FeatureKind::kHole && feature.radius < mate.hole_radius &&
        feature.radius > kNarrowest * mate.shaft_radius &&
        product::IsParallel(feature.axis_B, thread.axis_B) &&
        product::DistanceToAxis(feature.origin_B, thread.origin_B, thread.axis_B) < kOnAxis) {
      faces.insert(faces.end(), feature.faces.begin(), feature.faces.end());
    }
  }
  return faces;
}

std::vector<std::uint32_t> ListPassing(const product::Product& product, product::OccurrenceId own,
                                       product::OccurrenceId other,
                                       const haptics::MateFaces& faces) {
  std::set<std::uint32_t> stops;
  for (const product::Mate& mate : product.mates) {
    if (mates::HoldsAcross(mate.kind) || !mate.Joins(own, other)) {
      continue;
    }
    const product::Connector& side = mate.a.occurrence == own ? mate.a : mate.b;
    for (const product::FaceId id : product::FacesOf(product, side)) {
      stops.insert(id.value());
    }
  }
  std::vector<std::uint32_t> passing;
  std::copy_if(faces.with_neighbours.begin(), faces.with_neighbours.end(),
               std::back_inserter(passing),
               [&stops](std::uint32_t face) { return stops.count(face) == 0; });
  return passing;
}

std::shared_ptr<const haptics::MateFaces> WidenForThread(const product::Product& product,
                                                         const product::Mate& mate,
                                                         const product::Connector& side,
                                                         const haptics::MateFaces& faces) {
  const product::OccurrenceId other =
      mate.a.occurrence == side.occurrence ? mate.b.occurrence : mate.a.occurrence;
  auto wide = std::make_shared<haptics::MateFaces>(faces);
  wide->mating = ListPassing(product, side.occurrence, other, faces);
  return wide;
}

}  // namespace hvas::sequence
