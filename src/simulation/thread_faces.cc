#include "simulation/thread_faces.h"

#include <algorithm>
#include <set>

#include "mates/mate_kind.h"

namespace hvas::simulation {
namespace {

constexpr double kDrawnOverlap = 20e-6;  // [m] of radius; less is drawn at its nominal size

}  // namespace

bool IsDrawnThread(const product::Mate& mate) {
  const bool has_kind = mate.fit && (mate.fit->kind == product::FitKind::kThread ||
                                     mate.fit->kind == product::FitKind::kInsert);
  return has_kind && mate.shaft_radius > mate.hole_radius + kDrawnOverlap;
}

std::shared_ptr<const haptics::MateFaces> WidenForThread(const product::Product& product,
                                                         const product::Mate& mate,
                                                         const product::Connector& side,
                                                         const haptics::MateFaces& faces) {
  const auto joins_same_parts = [&mate](const product::Mate& other) {
    return (other.a.occurrence == mate.a.occurrence && other.b.occurrence == mate.b.occurrence) ||
           (other.a.occurrence == mate.b.occurrence && other.b.occurrence == mate.a.occurrence);
  };
  std::set<std::uint32_t> stops;
  for (const product::Mate& other : product.mates) {
    if (mates::HoldsAcross(other.kind) || !joins_same_parts(other)) {
      continue;
    }
    const product::Connector& own = other.a.occurrence == side.occurrence ? other.a : other.b;
    for (const product::FaceId id : product::FacesOf(product, own)) {
      stops.insert(id.value());
    }
  }
  auto wide = std::make_shared<haptics::MateFaces>(faces);
  wide->mating.clear();
  std::copy_if(faces.with_neighbours.begin(), faces.with_neighbours.end(),
               std::back_inserter(wide->mating),
               [&stops](std::uint32_t face) { return stops.count(face) == 0; });
  return wide;
}

}  // namespace hvas::simulation
