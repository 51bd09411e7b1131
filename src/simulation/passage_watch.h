#pragma once

#include <map>
#include <utility>
#include <vector>

#include "contact/scene.h"
#include "simulation/physics_side.h"

namespace hvas::simulation {

/** The deepest place that a part has met on its way, beyond what the drawing shows. */
struct Passage {
  product::OccurrenceId through;  ///< Invalid: it met nothing deeper than drawn.
  double depth{0};  ///< Penetration beyond that of the two parts in their drawn places [m].
};

/** Looks, independently of the ticks, whether a part passes through others: on all faces as drawn
 of all parts in their places, with none giving way. No pair of parts or faces is left out but the
 modelled flanks of a thread, along which going straight stands for a screw. What two parts lie in
 one another in their drawn places is no passage. A distance field knows depths up to
 its band: what is deeper counts as that. Physics thread. */
class PassageWatch {
 public:
  explicit PassageWatch(const Model& model);

  /** Looks at what a hand holds now, if it holds anything. */
  void Look(const PhysicsSide& physics, std::size_t hand);

  [[nodiscard]] const Passage& passage(product::OccurrenceId id) const {
    return passages_[id.index()];
  }

  /** Two faces that touch, or nearly so. */
  struct Touch {
    product::OccurrenceId other;  ///< Invalid: none is near.
    std::uint32_t own_face{contact::kNoFace};
    std::uint32_t other_face{contact::kNoFace};
  };

  /** Finds where a part at a pose touches others in their places: the deepest contact with this
   one, or with any where it is invalid. */
  [[nodiscard]] Touch FindTouch(const PhysicsSide& physics, product::OccurrenceId id,
                                const spatial::Pose& X_WB, product::OccurrenceId with);

 private:
  void PlaceOthers(const PhysicsSide& physics);
  /** @param leader  The part in the hand that `id` is, or moves with. */
  void LookAt(product::OccurrenceId leader, product::OccurrenceId id, const spatial::Pose& X_WB);
  void Query(product::OccurrenceId id, const spatial::Pose& X_WB);
  /** Depth of two parts in one another in their drawn places [m]. The scene has no other part then.
   */
  [[nodiscard]] double FindDrawnDepth(product::OccurrenceId id, product::OccurrenceId other);

  const Model& model_;
  contact::Scene scene_;
  contact::QueryWorkspace workspace_;
  std::map<std::pair<product::OccurrenceId, product::OccurrenceId>, double> drawn_depths_;
  std::vector<std::vector<contact::IgnoredPair>> threads_;  ///< Threads of each occurrence.
  std::vector<Passage> passages_;                           ///< Passages, indexed by OccurrenceId.
};

}  // namespace hvas::simulation
