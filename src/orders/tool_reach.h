#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contact/scene.h"
#include "product/product.h"
#include "simulation/tool_mates.h"

namespace hvas::orders {

/** Pose of the tool on a fastener, drawn out along the axis by `lift` [m] and turned about the axis
 by `angle` [rad], counter-clockwise as seen by the user. At angle 0 flats are parallel. */
[[nodiscard]] spatial::Pose CalcToolPose(const simulation::ToolMate& mate,
                                         const spatial::Pose& X_WF, double angle, double lift);

/** Angles in which a tool on a fastener can be swung, from one part in its way to the next. */
struct FreeArc {
  double from{0};           ///< [rad], as CalcToolPose takes it.
  double to{0};             ///< Larger than `from`.
  contact::BodyId at_from;  ///< Body that ends it; invalid where nothing does.
  contact::BodyId at_to;
  bool is_full{false};     ///< The whole turn is free.
  bool can_put_on{false};  ///< Nothing is in the way along the axis, at some angle of it.
  /** It can be swung by a pitch, taken off, put on again where it began, and so on without end. */
  bool can_go_on{false};

  [[nodiscard]] double angle() const { return to - from; }
};

/** Where a tool can be put on a fastener and swung. */
struct ToolReach {
  std::vector<FreeArc> arcs;
  contact::BodyId obstacle;             ///< Where there is no arc: the body that is met at angle 0.
  contact::BodyId obstacle_along_axis;  ///< The body first met in putting on; invalid: none.
  double lever{0};           ///< Largest distance of a point of the tool from the axis [m].
  bool is_truncated{false};  ///< A contact query reached its limit: an obstacle may be missed.

  /** The arc to work in: one that lets it go on, else the widest; null: it cannot be put on. */
  [[nodiscard]] const FreeArc* FindBest() const;
};

struct ReachQuery {
  const contact::Scene* scene{nullptr};
  contact::BodyId fastener;                     ///< Left out.
  std::span<const contact::BodyId> left_out{};  ///< Further bodies that do not count.
  const contact::Shape* tool{nullptr};
  const product::Part* tool_part{nullptr};
  /** Bodies that are no deeper than this in the tool do not stop it: what touches as drawn [m]. */
  double tolerance{5e-6};
  /** Shortest step of any point of the tool: an obstacle thinner than it, met between two steps,
   may be missed by this depth [m]. */
  double shortest_step{50e-6};
};

/** Swings a tool on a fastener around the whole turn, and tries to put it on along the axis. Steps
 are as long as the distance to the nearest body allows (conservative advancement), and at least
 ReachQuery::shortest_step. @pre all pointers are set. */
[[nodiscard]] ToolReach CalcToolReach(const ReachQuery& query, const simulation::ToolMate& mate,
                                      const spatial::Pose& X_WF);

}  // namespace hvas::orders
