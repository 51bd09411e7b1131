// What a part meets, and what more would let it pass: docs/algorithms/reasons.md.

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "sequence/extraction.h"

namespace hvas::sequence {

using product::OccurrenceId;

std::optional<SequenceStep> Extraction::TryRemoveCleared(OccurrenceId id, const Unit& others,
                                                         double clearance) {
  is_cleared_.assign(product_.occurrences.size(), false);
  for (const OccurrenceId other : others) {
    is_cleared_[other.index()] = true;
  }
  clearance_ = clearance;
  Memory memory;
  giving_ = Giving::kByClearance;
  std::optional<SequenceStep> step = TryRemove({id}, &memory);
  giving_ = Giving::kNone;
  return step;
}

std::optional<SequenceStep> Extraction::TryRemoveWithLimits(OccurrenceId id) {
  Memory memory;
  giving_ = Giving::kByLimits;
  std::optional<SequenceStep> step = TryRemove({id}, &memory);
  giving_ = Giving::kNone;
  return step;
}

std::vector<MetFaces> Extraction::MeasureFaces(OccurrenceId id, const Vec3& direction) {
  std::map<std::tuple<OccurrenceId, std::uint32_t, std::uint32_t>, MetFaces> pairs;
  SetUnit({id}, true);
  VisitContacts(id, direction, [&](const contact::Contact& contact, double travelled) {
    const OccurrenceId other =
        contact.body.is_valid() ? OccurrenceId(contact.body.index()) : OccurrenceId();
    const auto [entry, is_new] =
        pairs.try_emplace({other, contact.held_face, contact.scene_face},
                          MetFaces{contact.held_face, other, contact.scene_face, 0, travelled});
    entry->second.depth = std::max(entry->second.depth, -contact.distance);
  });
  SetUnit({id}, false);
  std::vector<MetFaces> list;
  for (const auto& [key, pair] : pairs) {
    list.push_back(pair);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const MetFaces& a, const MetFaces& b) { return a.depth > b.depth; });
  return list;
}

std::vector<product::MateId> Extraction::ListForbidding(OccurrenceId id,
                                                        const Vec3& direction) const {
  std::vector<product::MateId> mates;
  for (const MateView& view : mates_of_[id.index()]) {
    if (is_present_[view.other.index()] && view.other != id && !IsAllowed(view, direction)) {
      mates.push_back(view.mate->id);
    }
  }
  return mates;
}

}  // namespace hvas::sequence
