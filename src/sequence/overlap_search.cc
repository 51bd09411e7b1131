#include "sequence/overlap_search.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "contact/face_offsets.h"
#include "mates/drawing_errors.h"
#include "mates/drawn_volumes.h"
#include "sequence/thread_faces.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

constexpr double kMostRelief = 2 * contact::FaceOffsets::kLargest;  // [m] of two faces
constexpr int kRounds = 8;        // In each, the deepest contacts of a query are seen: a choice.
constexpr double kOpposed = 0.3;  // Cosine of a face's normal against a contact: 73 degrees.

/** Normal of a face out of the material, near a point of it. */
Vec3 NormalNear(const product::Part& part, std::uint32_t face_index, const Vec3& p_B) {
  const product::Face& face = part.faces[face_index];
  if (const auto exact = spatial::CalcDistance(face.surface, p_B); exact.is_valid) {
    return exact.gradient;
  }
  Vec3 normal = Vec3::Zero();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
    const auto& [i, j, k] = part.mesh.triangles[t];
    const Vec3& a = part.mesh.vertices[i];
    const Vec3& b = part.mesh.vertices[j];
    const Vec3& c = part.mesh.vertices[k];
    const double distance = ((a + b + c) / 3 - p_B).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      normal = (b - a).cross(c - a);
    }
  }
  return normal.normalized();
}

void Insert(std::uint32_t face, std::vector<std::uint32_t>* faces) {
  const auto at = std::lower_bound(faces->begin(), faces->end(), face);
  if (at == faces->end() || *at != face) {
    faces->insert(at, face);
  }
}

}  // namespace

std::vector<DrawnOverlap> OverlapSearch::Find() {
  for (const product::DrawingError& error : input_.product->drawing_errors) {
    EntryOf(error.a, error.b).depth = error.depth;  // They get no allowance.
  }
  FindDeeper(kMostRelief);
  Relieve();
  FindDeeper(kDepthTolerance);
  return std::move(overlaps_);
}

std::vector<contact::BodyId> OverlapSearch::ListExamined(OccurrenceId id) const {
  std::vector<contact::BodyId> partners;
  const auto own = entries_of_.find(id);
  if (own == entries_of_.end()) {
    return partners;
  }
  for (const std::size_t entry : own->second) {
    const DrawnOverlap& overlap = overlaps_[entry];
    if (overlap.answer != DrawnOverlap::Answer::kRelief) {
      partners.emplace_back((overlap.a == id ? overlap.b : overlap.a).index());
    }
  }
  return partners;
}

void OverlapSearch::FindDeeper(double depth) {
  for (const product::Occurrence& occurrence : input_.product->occurrences) {
    const contact::BodyId self(occurrence.id.index());
    if (!input_.scene->is_enabled(self)) {
      continue;
    }
    const std::vector<contact::IgnoredPair> ignored = ignored_of_(occurrence.id);
    contact::QueryOptions query;
    query.margin = -depth;
    query.ignored = ignored;
    query.self = self;
    // A query reports a limited number of contacts: ask again without those found until none is
    // left.
    for (bool is_clear = false; !is_clear && !input_.stop.stop_requested();) {
      const std::vector<contact::BodyId> examined = ListExamined(occurrence.id);
      query.left_out[0] = examined;
      input_.scene->Query(input_.scene->shape(self), occurrence.X_WB, query, &workspace_);
      std::set<contact::BodyId> touched;
      for (const contact::Contact& contact : workspace_.contacts()) {
        if (contact.body.is_valid() && contact.distance < -depth) {
          touched.insert(contact.body);
        }
      }
      is_clear = touched.empty();
      for (const contact::BodyId body : touched) {
        if (input_.stop.stop_requested()) {
          return;
        }
        Examine(occurrence.id, OccurrenceId(body.index()));
      }
    }
  }
}

double OverlapSearch::CalcDepthAlong(OccurrenceId self, const contact::Contact& contact) const {
  const auto along_normal = [&](OccurrenceId id, std::uint32_t face) {
    const product::Part& part = input_.product->part_of(id);
    const product::Pose& X_WB = input_.product->occurrences[id.index()].X_WB;
    // Far inside, contact does not know the face of the other part: its direction is what it knows.
    return face < part.faces.size()
               ? (X_WB.q() * NormalNear(part, face, X_WB.Inverse() * contact.p_WC))
                     .dot(contact.nhat_W)
               : 0.0;
  };
  const OccurrenceId other(contact.body.index());
  const double own = along_normal(self, contact.held_face);
  const bool is_other_known = contact.scene_face < input_.product->part_of(other).faces.size();
  const double along_other = is_other_known ? along_normal(other, contact.scene_face) : 1.0;
  const bool are_opposed = own < -kOpposed && along_other > kOpposed;
  if (!are_opposed) {
    return 0;
  }
  const double by_contact = -contact.distance * std::min(-own, along_other);
  if (!is_other_known) {
    return by_contact;
  }
  // Beside an edge, the nearest point of the other part is further than its face.
  const product::Pose& X_WO = input_.product->occurrences[other.index()].X_WB;
  const auto to_surface =
      spatial::CalcDistance(input_.product->part_of(other).faces[contact.scene_face].surface,
                            X_WO.Inverse() * contact.p_WC);
  return to_surface.is_valid && to_surface.distance < 0 ? std::min(by_contact, -to_surface.distance)
                                                        : by_contact;
}

std::vector<OverlapSearch::Meeting> OverlapSearch::ListMeetings(OccurrenceId self,
                                                                OccurrenceId other) {
  std::vector<contact::BodyId> others;
  for (const product::Occurrence& occurrence : input_.product->occurrences) {
    if (occurrence.id != other) {
      others.emplace_back(occurrence.id.index());
    }
  }
  const std::vector<contact::IgnoredPair> of_mates = ignored_of_(self);
  std::vector<Meeting> meetings;
  std::vector<std::uint32_t> own_faces;
  std::vector<std::uint32_t> other_faces;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<contact::IgnoredPair> ignored = of_mates;
    ignored.push_back({contact::BodyId(other.index()), own_faces, other_faces});
    contact::QueryOptions query;
    query.margin = -kDepthTolerance;
    query.ignored = ignored;
    query.left_out[0] = others;
    query.self = contact::BodyId(self.index());
    input_.scene->Query(input_.scene->shape(query.self),
                        input_.product->occurrences[self.index()].X_WB, query, &workspace_);
    if (workspace_.contacts().empty()) {
      break;
    }
    std::vector<std::uint32_t> own_next = own_faces;
    std::vector<std::uint32_t> other_next = other_faces;
    for (const contact::Contact& contact : workspace_.contacts()) {
      meetings.push_back({contact.held_face, contact.scene_face, -contact.distance,
                          CalcDepthAlong(self, contact)});
      Insert(contact.held_face, &own_next);
      Insert(contact.scene_face, &other_next);
    }
    if (own_next == own_faces && other_next == other_faces) {
      break;
    }
    own_faces = std::move(own_next);
    other_faces = std::move(other_next);
  }
  return meetings;
}

void OverlapSearch::InsertKnown(OccurrenceId id, std::uint32_t face,
                                std::vector<std::uint32_t>* faces) const {
  if (face < input_.product->part_of(id).faces.size()) {
    Insert(face, faces);
  }
}

void OverlapSearch::Examine(OccurrenceId a, OccurrenceId b) {
  std::vector<Meeting> meetings = ListMeetings(a, b);
  for (const Meeting& meeting : ListMeetings(b, a)) {
    meetings.push_back({meeting.other, meeting.own, meeting.depth, meeting.along});
  }
  double deepest = 0;
  double allowed = 0;
  double along = 0;
  double estimated = 0;
  for (const Meeting& meeting : meetings) {
    // Far inside, contact does not know the other face: its distance is an estimate there.
    const std::uint32_t none = contact::kNoFace;
    const bool is_known = meeting.own != none && meeting.other != none;
    along = std::max(along, is_known ? meeting.along : 0);
    estimated = std::max(estimated, meeting.along);
    deepest = std::max(deepest, meeting.depth);
    allowed = std::max(allowed, meeting.is_opposed() ? meeting.depth : 0);
  }
  if (allowed == 0 && deepest <= kMostRelief) {
    allowed = deepest;  // Edges that meet a little: no part runs through the other one.
  }
  DrawnOverlap& overlap = EntryOf(a, b);
  const bool is_swapped = overlap.a != a;
  for (const Meeting& meeting : meetings) {
    if (allowed > 0 && meeting.depth > allowed + kDepthTolerance) {
      continue;  // It runs through: this has no allowance.
    }
    InsertKnown(a, meeting.own, is_swapped ? &overlap.faces_b : &overlap.faces_a);
    InsertKnown(b, meeting.other, is_swapped ? &overlap.faces_a : &overlap.faces_b);
  }
  overlap.answer = allowed > 0 ? DrawnOverlap::Answer::kAllowance : DrawnOverlap::Answer::kNone;
  if (along == 0) {
    const double measured = mates::MeasureSharedVolume(*input_.product, a, b).depth;
    along = measured > 0 ? std::min(estimated, measured) : estimated;
  }
  overlap.depth = std::max(overlap.depth, allowed > 0 ? along : deepest);
  overlap.allowed = allowed > 0 ? std::min(allowed, overlap.largest) + kReliefRoom : 0;
  if (allowed > 0) {
    overlap.passing_a = Widen(overlap.a, overlap.b, overlap.faces_a);
    overlap.passing_b = Widen(overlap.b, overlap.a, overlap.faces_b);
  }
}

std::vector<std::uint32_t> OverlapSearch::Widen(OccurrenceId own, OccurrenceId other,
                                                const std::vector<std::uint32_t>& faces) const {
  const std::vector<product::FaceId> ids(faces.begin(), faces.end());
  std::vector<std::uint32_t> wide =
      ListPassing(*input_.product, own, other, CollectMateFaces(input_.product->part_of(own), ids));
  for (const std::uint32_t face : faces) {
    Insert(face, &wide);
  }
  return wide;
}

DrawnOverlap& OverlapSearch::EntryOf(OccurrenceId a, OccurrenceId b) {
  const auto [entry, is_new] = entries_.try_emplace(std::minmax(a, b), overlaps_.size());
  if (!is_new) {
    return overlaps_[entry->second];
  }
  entries_of_[a].push_back(overlaps_.size());
  entries_of_[b].push_back(overlaps_.size());
  DrawnOverlap overlap;
  overlap.a = a;
  overlap.b = b;
  overlap.largest = mates::CalcLargestDepth(*input_.product, a, b);
  overlaps_.push_back(std::move(overlap));
  return overlaps_.back();
}

void OverlapSearch::Relieve() {
  if (input_.shapes.empty()) {
    return;
  }
  for (int round = 0; round < kRounds; ++round) {
    std::set<OccurrenceId> parts;
    for (const product::Occurrence& occurrence : input_.product->occurrences) {
      if (input_.stop.stop_requested()) {
        return;
      }
      const std::vector<contact::IgnoredPair> ignored = ignored_of_(occurrence.id);
      const std::vector<contact::BodyId> examined = ListExamined(occurrence.id);
      contact::QueryOptions query;
      query.margin = -kReliefFrom;
      query.ignored = ignored;
      query.left_out[0] = examined;
      query.self = contact::BodyId(occurrence.id.index());
      input_.scene->Query(input_.scene->shape(query.self), occurrence.X_WB, query, &workspace_);
      FaceReliefs::Depths depths;
      for (const contact::Contact& contact : workspace_.contacts()) {
        const bool may_give = contact.body.is_valid() && contact.distance >= -kMostRelief;
        const double along = may_give ? CalcDepthAlong(occurrence.id, contact) : 0;
        if (along > 0) {
          NoteRelieved(occurrence.id, contact, along);
          reliefs_.AddContact(occurrence.id, contact, &depths);
        }
      }
      parts.merge(reliefs_.Add(depths));
    }
    if (parts.empty()) {
      return;
    }
    reliefs_.GiveOffsets(parts);
  }
}

void OverlapSearch::NoteRelieved(OccurrenceId self, const contact::Contact& contact, double along) {
  if (contact.distance >= -kDepthTolerance) {
    return;
  }
  const OccurrenceId other(contact.body.index());
  DrawnOverlap& overlap = EntryOf(self, other);
  overlap.answer = DrawnOverlap::Answer::kRelief;
  overlap.depth = std::max(overlap.depth, along);
  const bool is_swapped = overlap.a != self;
  InsertKnown(self, contact.held_face, is_swapped ? &overlap.faces_b : &overlap.faces_a);
  InsertKnown(other, contact.scene_face, is_swapped ? &overlap.faces_a : &overlap.faces_b);
}

}  // namespace hvas::sequence
