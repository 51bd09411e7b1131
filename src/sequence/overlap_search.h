#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "contact/scene.h"
#include "sequence/face_reliefs.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

/** Finds the parts that lie in one another as drawn, and what lets them pass one another
 (docs/algorithms/overlaps.md). */
class OverlapSearch {
 public:
  /** The faces of a part that its mates answer for. */
  using IgnoredOf = std::function<std::vector<contact::IgnoredPair>(product::OccurrenceId)>;

  /** @param input  All its parts are present. @param reliefs  Get what gives way.
   All outlive this object. SequenceInput::stop ends the search early. */
  OverlapSearch(const SequenceInput& input, IgnoredOf ignored_of, FaceReliefs* reliefs)
      : input_(input), ignored_of_(std::move(ignored_of)), reliefs_(*reliefs) {}

  [[nodiscard]] std::vector<DrawnOverlap> Find();

 private:
  /** What was seen of two faces that overlap. */
  struct Meeting {
    std::uint32_t own{0};
    std::uint32_t other{0};
    double depth{0};  // From the nearest point of the other surface [m].
    double along{0};  // By which the face would have to give along its normal [m]; 0: it does not
                      // look at the other one.

    [[nodiscard]] bool is_opposed() const { return along > 0; }
  };

  /** Finds the pairs that lie in one another deeper than this [m]. */
  void FindDeeper(double depth);
  /** Lets faces give way where parts lie in one another by no more than faces can. */
  void Relieve();
  void NoteRelieved(product::OccurrenceId self, const contact::Contact& contact, double along);
  /** Inserts a face of a part, where contact knows which one it is: deep inside it does not. */
  void InsertKnown(product::OccurrenceId id, std::uint32_t face,
                   std::vector<std::uint32_t>* faces) const;
  /** Finds out which faces of a pair overlap, and what they allow. */
  void Examine(product::OccurrenceId a, product::OccurrenceId b);
  [[nodiscard]] std::vector<Meeting> ListMeetings(product::OccurrenceId self,
                                                  product::OccurrenceId other);
  /** How far a face in contact would have to give along its normal; 0 where the two faces do not
   look at each other [m]. */
  [[nodiscard]] double CalcDepthAlong(product::OccurrenceId self,
                                      const contact::Contact& contact) const;
  [[nodiscard]] std::vector<std::uint32_t> Widen(product::OccurrenceId own,
                                                 product::OccurrenceId other,
                                                 const std::vector<std::uint32_t>& faces) const;
  [[nodiscard]] DrawnOverlap& EntryOf(product::OccurrenceId a, product::OccurrenceId b);
  /** Partners of a part whose overlaps are examined already. */
  [[nodiscard]] std::vector<contact::BodyId> ListExamined(product::OccurrenceId id) const;

  const SequenceInput& input_;
  IgnoredOf ignored_of_;
  FaceReliefs& reliefs_;
  std::vector<DrawnOverlap> overlaps_;
  std::map<std::pair<product::OccurrenceId, product::OccurrenceId>, std::size_t> entries_;
  std::map<product::OccurrenceId, std::vector<std::size_t>> entries_of_;  // In their order.
  contact::QueryWorkspace workspace_;
};

}  // namespace hvas::sequence
