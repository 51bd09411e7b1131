#pragma once

#include <cstdint>
#include <limits>

#include "contact/scene.h"
#include "haptics/passivity_controller.h"
#include "haptics/workspace_mapping.h"
#include "product/ids.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** States of a held part, in the order in which an assembly passes through them. */
enum class HoldState : std::uint8_t {
  kEmpty,     ///< Nothing is in the hand.
  kFree,      ///< A part is held, and no mate is in range.
  kNear,      ///< A mate is close.
  kCaptured,  ///< A mate guides the part onto its axis.
  kMating,    ///< The part is on the axis; the faces of the mate answer by their fit.
  kSeated,    ///< The part is in its place; it moves exactly there and stays.
};

[[nodiscard]] const char* ToString(HoldState state) noexcept;

/** How the held part stands to the mate whose axis guides it. */
struct GuidedAxis {
  product::MateId mate;  ///< Invalid where no axis guides the part.
  Vec3 p_WQ{Vec3::Zero()};
  Vec3 axis_W{Vec3::UnitZ()};
  double tilt{0};        ///< [rad]
  double offset{0};      ///< Distance across the axis [m].
  double depth{0};       ///< Depth of insertion; negative by the distance to the hole [m].
  double depth_goal{0};  ///< Depth of insertion in its place [m].
};

/** What the loop knows at a tick besides the device's sample. */
struct TickContext {
  std::int64_t model_age_ns{0};    ///< Time since the physics loop last answered.
  bool is_stopped{false};          ///< All forces are switched off.
  int effort_level{0};             ///< The loop's own number of what SetEffort was given.
  std::int64_t since_write_ns{0};  ///< Time since the last write to the device: see WritePace.
};

/** A contact of the held part that presses in one tick. */
struct PressingContact {
  Vec3 p_WC{Vec3::Zero()};
  Vec3 f_C_W{Vec3::Zero()};  ///< Its force on the held part [N].
  double distance{0};        ///< Distance before the step; negative inside [m].
  contact::BodyId body;      ///< The body that it is with; invalid for the ground or none.
};

/** Contacts of the held part in one tick. */
struct ContactAccount {
  /** Deepest contact [m], negative inside; +inf where nothing is near. */
  double deepest{std::numeric_limits<double>::infinity()};
  int contact_count{0};          ///< Contacts that press.
  Vec3 p_WC{Vec3::Zero()};       ///< The contact that presses hardest.
  Vec3 f_C_W{Vec3::Zero()};      ///< Its force on the held part [N].
  contact::BodyId contact_body;  ///< The body that it is with; invalid for the ground or none.
  bool is_truncated{false};      ///< A contact query, or the step, had more than it has room for.
  /** A loose part stood still, though it was pushed or fell: as many as may move did. */
  bool is_crowded{false};
  std::uint32_t points_tested{0};  ///< Points tested by all contact queries of the tick.
};

/** What a tick gives: the wrench for the device, and everything a record wants to know. */
struct TickOutput : ContactAccount {
  spatial::Wrench
      F_H_D;  ///< Wrench for the device: after the gate, about the hand's point, in its base.
  spatial::Wrench F_H_W;  ///< The wrench for the device, in W.
  spatial::Pose X_WH;     ///< The hand.
  /** Wrench of physics, before the force map, about the displayed centre of mass. */
  spatial::Wrench F_true_W;
  spatial::Wrench F_felt_W;  ///< Wrench after the map and before the gate, about the same point.
  spatial::Pose X_WT;        ///< Tracked part, or the hand when it is empty.
  spatial::Pose X_WD;        ///< Displayed part, or the hand when it is empty.
  HoldState state{HoldState::kEmpty};
  bool is_matched{false};  ///< The part is so near to its place that it is drawn home (W7).
  product::OccurrenceId occurrence;
  double insertion_depth{0};  ///< Depth of insertion l [m].
  double axial_true{0};       ///< Force of the fits on their axis; positive against going in [N].
  double axial_felt{0};
  double preload{0};              ///< Force in a screw or nut that is being tightened, true [N].
  double tightening{0};           ///< Torque of its thread and head, true, >= 0 [N m].
  bool is_thread_crossed{false};  ///< It came into its thread tilted, and sticks there.
  std::uint32_t gate_actions{0};
  WorkspaceMapping workspace;       ///< How the handle moved the hand.
  PassivityAccount energy;          ///< Energy of forces so far, where passivity is controlled.
  PassivityAccount turning_energy;  ///< Energy of torques so far.
  GuidedAxis axis;
  TickContext context;  ///< Context as it was given.
};

}  // namespace hvas::haptics
