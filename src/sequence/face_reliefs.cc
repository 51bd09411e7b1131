#include "sequence/face_reliefs.h"

#include <algorithm>
#include <utility>

#include "contact/face_offsets.h"

namespace hvas::sequence {

using product::OccurrenceId;

void FaceReliefs::AddContact(OccurrenceId self, const contact::Contact& contact,
                             Depths* depths) const {
  if (!contact.body.is_valid() || contact.distance >= -kReliefFrom) {
    return;
  }
  const double half = 0.5 * (kReliefRoom - contact.distance);
  for (const Face& face : {Face{self, contact.held_face},
                           Face{OccurrenceId(contact.body.index()), contact.scene_face}}) {
    if (face.face < input_.product->part_of(face.occurrence).faces.size()) {
      double& depth = (*depths)[face];
      depth = std::max(depth, half);
    }
  }
}

std::set<OccurrenceId> FaceReliefs::Add(const Depths& depths) {
  std::set<OccurrenceId> parts;
  for (const auto& [face, depth] : depths) {
    double& relief = depths_[face];
    const double before = relief;
    relief = std::min(relief + depth, contact::FaceOffsets::kLargest);
    if (relief > before) {
      parts.insert(face.occurrence);
    }
  }
  return parts;
}

void FaceReliefs::GiveOffsets(const std::set<OccurrenceId>& parts) const {
  for (const OccurrenceId id : parts) {
    std::vector<contact::FaceOffset> offsets(input_.product->part_of(id).faces.size());
    for (auto entry = depths_.lower_bound({id, 0});
         entry != depths_.end() && entry->first.occurrence == id; ++entry) {
      offsets[entry->first.face].uniform = -entry->second;
    }
    // Offsets within the largest one are never refused.
    if (auto made = contact::FaceOffsets::Make(input_.shapes[id.index()], offsets)) {
      input_.scene->SetOffsets(contact::BodyId(id.index()), std::move(*made));
    }
  }
}

void FaceReliefs::Restore(std::span<const FaceRelief> reliefs) {
  std::set<OccurrenceId> parts;
  for (const FaceRelief& relief : reliefs) {
    depths_[{relief.occurrence, relief.face}] = relief.depth;
    parts.insert(relief.occurrence);
  }
  GiveOffsets(parts);
}

std::vector<FaceRelief> FaceReliefs::List() const {
  std::vector<FaceRelief> list;
  for (const auto& [face, depth] : depths_) {
    list.push_back({face.occurrence, face.face, depth});
  }
  return list;
}

}  // namespace hvas::sequence
