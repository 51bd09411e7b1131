#pragma once

#include <span>
#include <vector>

#include "base/diagnostics.h"
#include "base/work_watch.h"
#include "mates/resolve.h"
#include "product/product.h"

/** Relations of two parts beside the mates (X2, X3): their equations, the motions that they leave,
 and their inference from the drawn poses. docs/algorithms/relations.md has the equations. */
namespace hvas::mates {

/** A relation with one part held and the other placed, as MateConstraint is a mate. */
struct RelationConstraint {
  product::RelationKind kind{product::RelationKind::kParallel};
  double magnitude{0};  ///< Angle [rad] or distance [m].
  product::ElementKind placed{product::ElementKind::kPlane};
  product::ElementKind held{product::ElementKind::kPlane};
  Vec3 p_W, axis_W;         ///< The element of the placed side.
  Vec3 p_B, axis_B;         ///< The element of the held side in the held part.
  bool is_reversed{false};  ///< True where `a` is held: distances of planes count along its normal.
  double contact_distance{0};  ///< Tangent: distance of axes, centres or the plane [m].
};

/** A relation with one part held and the other placed at X_WP. @pre held is one of its occurrences.
 */
[[nodiscard]] RelationConstraint MakeConstraint(const product::Relation& relation,
                                                product::OccurrenceId held, const Pose& X_WP);

/** Whether a relation of this kind can tie the two elements. */
[[nodiscard]] bool CanTie(product::RelationKind kind, product::ElementKind a,
                          product::ElementKind b);

/** Root of the sum of squares of the equations, angles times `length` [m]. */
[[nodiscard]] double CalcResidual(const RelationConstraint& relation, const Pose& X_WB,
                                  double length);

/** One row for each equation: its derivative by the held part's twist, (L w, v of B's origin), in
 W.
 @param length  L [m]. */
[[nodiscard]] std::vector<Vec6> CalcJacobian(const RelationConstraint& relation, const Pose& X_WB,
                                             double length);

/** What a set of mates and relations leaves free. */
struct FreeCount {
  int translations{3};
  int rotations{3};
};

[[nodiscard]] FreeCount CountFree(std::span<const MateConstraint> mates,
                                  std::span<const RelationConstraint> relations, const Pose& X_WB);

/** Resolve() with relations beside the mates: the pose near the start that fulfils all of them, by
 Gauss-Newton with the shortest steps. */
[[nodiscard]] Resolution ResolveAll(std::span<const MateConstraint> mates,
                                    std::span<const RelationConstraint> relations,
                                    const Pose& X_WBStart);

/** Limits of the inference. Choices: what a product of some hundred parts needs, so that no list
 gets longer than anybody reads. */
struct RelationLimits {
  std::size_t per_pair{32};   ///< Relations of two parts; the largest features come first.
  std::size_t total{20'000};  ///< Relations of a product.
  std::size_t features{200};  ///< Features of a part that are looked at.
  double near{1e-3};          ///< Gap of the boxes of parts that are near each other [m].
};

/** The relations that the drawn poses show, of parts that have mates, touch or are near: parallel,
 perpendicular or at an angle (the main directions of the two parts), flush planes, facing planes
 and parallel main axes at a distance, tangent cylinders and spheres, straight edges on one line,
 holes on one axis. Product::relations, which the user states, come first. Each has the degrees of
 freedom that it leaves alone. Reports `limit-relations` where a limit ends it. Deterministic. */
[[nodiscard]] std::vector<product::Relation> ListRelations(const product::Product& product,
                                                           Diagnostics* diagnostics,
                                                           WorkWatch* watch = nullptr,
                                                           const RelationLimits& limits = {});

/** One side of a relation on a feature of an occurrence. */
[[nodiscard]] product::RelationSide MakeSide(const product::Product& product,
                                             product::OccurrenceId occurrence,
                                             product::FeatureId feature);

/** Fills free degrees of freedom and residual of a relation in the drawn poses. */
void Measure(const product::Product& product, product::Relation* relation);

[[nodiscard]] const char* NameOf(product::RelationKind kind);

}  // namespace hvas::mates
