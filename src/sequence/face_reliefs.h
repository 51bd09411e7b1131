#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "contact/scene.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

inline constexpr double kDepthTolerance = 50e-6;  ///< [m]; drawn surfaces may touch this deep.
inline constexpr double kReliefFrom = 5e-6;   ///< [m]; contact gives way by this much by itself.
inline constexpr double kReliefRoom = 10e-6;  ///< [m] that is left between faces: a choice.

/** How far the faces of parts give way, as offsets of faces in a scene. */
class FaceReliefs {
 public:
  struct Face {
    product::OccurrenceId occurrence;
    std::uint32_t face{0};

    bool operator==(const Face&) const = default;

    bool operator<(const Face& other) const {
      return std::tie(occurrence, face) < std::tie(other.occurrence, other.face);
    }
  };

  using Depths = std::map<Face, double>;  ///< [m]

  /** @param input  Outlives this object. */
  explicit FaceReliefs(const SequenceInput& input) : input_(input) {}

  /** Adds the faces of a contact of `self`, both with half of its depth, where it is deeper than
   contact gives way by itself. */
  void AddContact(product::OccurrenceId self, const contact::Contact& contact,
                  Depths* depths) const;

  /** Lets faces give way further by these depths, as far as faces can; returns the parts whose
   faces do. The scene is as before until GiveOffsets. */
  std::set<product::OccurrenceId> Add(const Depths& depths);

  /** Gives the scene the offsets of these parts. */
  void GiveOffsets(const std::set<product::OccurrenceId>& parts) const;

  /** Takes reliefs that were found before into the scene. */
  void Restore(std::span<const FaceRelief> reliefs);

  [[nodiscard]] const Depths& depths() const { return depths_; }

  [[nodiscard]] std::vector<FaceRelief> List() const;

 private:
  const SequenceInput& input_;
  Depths depths_;
};

}  // namespace hvas::sequence
