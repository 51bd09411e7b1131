#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "assembly/plan_order.h"
#include "orders/hand_time.h"
#include "shopfloor/order_arrow.h"
#include "simulation/model.h"

namespace hvas::shopfloor {

/** A fit that a part enters at a step. */
struct WorkFit {
  product::OccurrenceId other;
  std::string code;  ///< "20 H7/p6": nominal size in mm, and the fit.
  product::FitKind kind{product::FitKind::kClearance};
  bool is_proposed{false};
  double force{0};  ///< F_in over the whole length, of the actual sizes; 0: none [N].
};

/** A thread that is tightened at a step. */
struct WorkThread {
  std::string size;   ///< "M6"
  double turns{0};    ///< 0: not known.
  double torque{0};   ///< [N m]; 0: not known.
  double preload{0};  ///< [N]
};

/** One step of the work at the bench: parts that come from the same side, one after the other. */
struct WorkStep {
  enum class Kind : std::uint8_t {
    kBase,      ///< The first part of the product, or of a subassembly, goes into the fixture.
    kInsert,    ///< Parts come to what is there.
    kLayAside,  ///< A finished subassembly is laid aside.
  };
  Kind kind{Kind::kInsert};
  /** What comes: equal parts one after the other; the leading one of each first. */
  std::vector<product::OccurrenceId> leading;
  std::vector<product::OccurrenceId> coming;  ///< All parts that come, those of a subassembly too.
  std::vector<product::OccurrenceId> there;   ///< What is there before.
  Vec3 out_W{Vec3::UnitZ()};                  ///< Unit; the way in is the reverse.
  double engaged{0};                          ///< Distance until nothing is engaged [m].
  std::vector<spatial::Pose> way;  ///< Poses X_WB of the first leading part, from its place
                                   ///< outward; empty: the way is straight.
  Vec3 up_W{Vec3::UnitZ()};        ///< The side of the product that is upwards.
  bool is_turned{false};           ///< The product is turned before, so that this side is upwards.
  product::OccurrenceId moved_aside;  ///< A part that is moved aside for it; invalid: none.
  std::string tool;                   ///< Empty: none.
  std::vector<WorkFit> fits;          ///< Fits of the first leading part.
  std::vector<WorkThread> threads;
  double press{0};                           ///< What the fits of one part need [N].
  double force{0};                           ///< Force of the hands for one part [N].
  std::vector<product::OccurrenceId> holds;  ///< What has to be held after it.
  std::vector<OrderArrow> before;            ///< What it has to come before, and is not implied.
  std::vector<orders::HandMotion> motions;   ///< Motions for all its parts.
  int mods{0};                               ///< Their sum [MOD].
};

/** A line of the bill of parts. */
struct BillLine {
  product::OccurrenceId first;  ///< One of them.
  std::string name;
  int count{0};
  double mass{0};  ///< Mass of one [kg].
  std::string material;
};

/** The work by which a product is put together. */
struct WorkPlan {
  std::vector<WorkStep> steps;
  std::vector<BillLine> bill;  ///< Lines in the order in which the parts are needed.
  std::vector<product::OccurrenceId> left_out;  ///< Parts that have no way in.
  int mods{0};                                  ///< [MOD]
};

/** Makes the steps of the best order of a plan. Equal parts that come from the same side one after
 the other are one step. @param plan  As PlanOrder makes it for the model. */
[[nodiscard]] WorkPlan MakeWorkPlan(const simulation::Model& model,
                                    const assembly::OrderPlan& plan);

}  // namespace hvas::shopfloor
