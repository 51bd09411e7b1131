#pragma once

#include <span>
#include <vector>

#include "contact/scene.h"
#include "product/product.h"

/** Proofs that a rigid part has no way out of others that stay where they are as drawn
 (docs/algorithms/reasons.md). */
namespace hvas::sequence {

/** Whether wrenches of contacts, as rows (force direction, torque / length), leave no motion free
 but those of `free`: every twist with no negative product with any row is a combination of
 these. The rows, without their parts along `free`, then span all of what is left positively.
 Source: Goldman and Tucker, Polyhedral Convex Cones, 1956; Mishra, Schwartz and Sharir, On the
 Existence and Synthesis of Multifinger Positive Grips, Algorithmica 2, 1987.
 @param rows  Each unit or zero in its first three elements.
 @param free  Orthonormal twists that no row has a product with. */
[[nodiscard]] bool DoRowsHold(const std::vector<Eigen::Matrix<double, 6, 1>>& rows,
                              const std::vector<Eigen::Matrix<double, 6, 1>>& free);

/** Whether the contacts of a part as drawn hold it in all six degrees of freedom: faces that are
 nearer than 50 um and look at each other. A turn of a part of revolution about its axis is no way
 out and does not count. First order: a motion that every contact lets slide is taken as free.
 @param scene  All parts at their drawn poses; disabled ones are not there.
 @param ignored  Pairs of faces that are no contact, as drawn threads. */
[[nodiscard]] bool IsHeldByContacts(const product::Product& product, const contact::Scene& scene,
                                    product::OccurrenceId id,
                                    std::span<const contact::IgnoredPair> ignored);

/** Radius of a large ball inside of a part [m]: half of how thick it is where it is thickest, or
 less. */
[[nodiscard]] double FindInnerRadius(const product::Part& part);

/** What encloses a part. */
struct Cage {
  bool is_closed{false};
  double radius{0};  ///< Radius of the ball in the part that cannot get out [m].
};

/** Whether a part cannot leave the space between others because a ball that is inside of it cannot:
 on a grid, the ball's centre gets nowhere that is not certainly too near to a surface. So it is
 proven for all motions, also those that turn; where it is not closed, nothing is.
 @param others  Parts that stay. @param allowed  How deep the part may be in others [m]. */
[[nodiscard]] Cage FindCage(const product::Product& product, product::OccurrenceId id,
                            std::span<const product::OccurrenceId> others, double allowed);

}  // namespace hvas::sequence
