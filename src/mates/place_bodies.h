#pragma once

#include <vector>

#include "base/work_watch.h"
#include "mates/solve_together.h"
#include "product/product.h"

/** Poses of bodies from the mates between them (X12, docs/algorithms/mates.md, section 6). */
namespace hvas::mates {

/** A mate of a product, with its connectors in W: bodies count as at the identity in the poses that
 the product has. Its limits are those of inference; its bodies are not set. */
[[nodiscard]] BodyMate MakeBodyMate(const product::Product& product, const product::Mate& mate);

/** True for a mate of the user that the assembled poses do not fulfil, as others contradict it: it
 guides and seats nothing. */
[[nodiscard]] bool IsContradicted(const product::Product& product, const product::Mate& mate);

/** Bodies at their drawn poses, which count as the identity, and the mates between them. */
struct BodyProblem {
  std::vector<BodyMate> mates;
  std::vector<bool> is_fixed;  ///< Bodies that stay as drawn.
};

struct BodyPoses {
  std::vector<Pose> X_WB;
  bool is_fulfilled{false};  ///< All mates in use are, within their limits.
  bool is_given_up{false};   ///< It is not, and there are combinations that were not tried.
};

/** Places the bodies that are not fixed: one after the other, the one that the placed ones hold
 most comes first, where it fulfils its mates with them and is nearest to its drawn pose; then all
 of them together, where loops are still open. A shaft that would be outside its hole, and may
 slide, goes to where the middles of both are together. Where the sense of an axis is open, the
 nearer one is tried first, and up to kMaxTries combinations in all.
 @param is_used  By mate: the others have no effect. */
[[nodiscard]] BodyPoses PlaceBodies(const BodyProblem& problem, const std::vector<bool>& is_used,
                                    WorkWatch* watch = nullptr);

}  // namespace hvas::mates
