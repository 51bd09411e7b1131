#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/result.h"
#include "simulation/model.h"

namespace hvas::orders {

struct StateStaticsOptions {
  Vec3 ghat_W{-Vec3::UnitZ()};   ///< Unit direction of gravity.
  bool is_base_held{true};       ///< The base part is in the fixture, which takes any wrench.
  bool are_screws_tight{true};   ///< What a screw's head lies on is clamped by it.
  bool finds_least_holds{true};  ///< False: only whether it stands, and what moves.
};

/** Whether the parts in their places stay there by themselves. */
struct StateStability {
  bool stands{false};
  /** Parts that fall, slide, or are pushed by those that do, sorted. */
  std::vector<product::OccurrenceId> moving;
  std::vector<product::OccurrenceId> holds;  ///< Parts to hold so that all stand, sorted.
  int least{0};                              ///< It is proved that fewer holds do not suffice.
  bool is_least_proven{false};               ///< `holds` are as few as `least`.
  std::size_t contact_count{0};              ///< Contacts among the parts in their places.
  std::size_t joint_count{0};                ///< Mates among them that hold, and clamped parts.
};

/** Statics of the states of one model: contacts of all pairs as drawn, found once, so that each
 state costs a linear programme only (docs/algorithms/statics.md). */
class StateStatics {
 public:
  /** @param model  Outlives this object. */
  explicit StateStatics(const simulation::Model& model);
  ~StateStatics();
  StateStatics(const StateStatics&) = delete;
  StateStatics& operator=(const StateStatics&) = delete;

  /** Decides on a state. Tools are not there; fixtures are always there, and stand still.
   @param is_in_place  Indexed by OccurrenceId.
   Errors: kInvalid where there is not one entry for each occurrence, or the direction is no unit
   vector; those of statics::SolveEquilibrium. */
  [[nodiscard]] Result<StateStability> CalcStability(const std::vector<bool>& is_in_place,
                                                     const StateStaticsOptions& options = {}) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/** Decides on one state of a model; for several, StateStatics takes less time. */
[[nodiscard]] Result<StateStability> CalcStability(const simulation::Model& model,
                                                   const std::vector<bool>& is_in_place,
                                                   const StateStaticsOptions& options = {});

/** The angle by which a horizontal table may be inclined in any direction before a part, as drawn
 and placed on it, tips [rad]; not above zero where it does not stand.
 @param ghat_W  Unit direction of gravity, with the part as drawn. */
[[nodiscard]] double CalcStandingMargin(const simulation::Model& model, product::OccurrenceId part,
                                        const Vec3& ghat_W);

}  // namespace hvas::orders
