#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "haptics/options.h"
#include "orders/tool_reach.h"

namespace hvas::orders {

/** How a fastener in its thread answers to a tool, and what the hand does. */
struct TurnOptions {
  double angle{0};  ///< Angle wanted of the fastener, counter-clockwise as seen by the user [rad].
  double torque{0.5};  ///< Dry friction of the fastener in its thread and under its head [N m].
  double lead{0};      ///< Travel along the axis in a turn of a right-hand thread [m]; 0: unknown.
  double turn_rate{0.5};  ///< Speed of the hand [rad/s].
  /** Does not heed the arc that is free: turns until something is in the way. */
  bool is_blind{false};
  haptics::CouplingGains coupling;  ///< Spring and damper between the hand and the tool.
  haptics::ContactOptions contact;
  double mass{0.05};                       ///< Mass of the tool [kg].
  Vec3 p_BoBcm_B{Vec3::Zero()};            ///< Centre of mass of the tool [m].
  Mat3 I_BBcm_B{1e-5 * Mat3::Identity()};  ///< Inertia of the tool [kg m^2].
};

/** One moment of turning; angles counter-clockwise as seen by the user [rad]. */
struct TurnSample {
  double time{0};  ///< [s]
  double lift{0};  ///< Distance of the hand along the axis from where the tool is put on [m].
  double hand_angle{0};
  double tool_angle{0};
  double fastener_angle{0};
  double fastener_travel{0};  ///< Out along the axis [m].
  double torque{0};       ///< Torque of the tool's contacts on the fastener, about its axis [N m].
  double hand_torque{0};  ///< Torque of the coupling on the hand, about the fastener's axis [N m].
  int contact_count{0};   ///< Contacts of the tool with the fastener that press.
  contact::BodyId obstacle;  ///< Another body that the tool presses on; invalid: none.
  double obstacle_force{0};  ///< [N]
};

struct TurnResult {
  bool is_complete{false};   ///< The angle wanted has been reached.
  double angle{0};           ///< Angle of the fastener [rad].
  double travel{0};          ///< [m]
  int strokes{0};            ///< Times that the tool was put on.
  double peak_torque{0};     ///< Largest torque on the fastener [N m].
  double deepest{0};         ///< Deepest penetration of the tool into anything [m], positive.
  contact::BodyId obstacle;  ///< What the tool pressed on where a stroke ended early; else invalid.
  double obstacle_angle{0};  ///< Angle of the tool there [rad].
  bool has_slipped{false};   ///< The tool turned over the flats: peak_torque is what they bear.
  bool is_truncated{false};  ///< A contact query, or the solver, had more than it has room for.
  std::vector<TurnSample> samples;  ///< Every 10 ms.
};

/** A hand puts a tool on a fastener and turns it, in virtual time of 1 kHz (X16). The tool is
 coupled to the hand by spring and damper, and only its contacts with the fastener, of the exact
 shapes, turn that. The fastener has one degree of freedom, along its thread: at rest until the
 contacts' torque exceeds its dry friction. Where the whole angle is not free the tool is taken off
 and put on again. The fastener's own contacts are not calculated: what was drawn seated advances no
 further in.
 @param query  As for CalcToolReach; `scene` has the fastener and is moved.
 @param arc  Where the tool is put on; null: only with TurnOptions::is_blind. Deterministic. */
[[nodiscard]] TurnResult TurnByContact(contact::Scene* scene, const ReachQuery& query,
                                       const simulation::ToolMate& mate, const spatial::Pose& X_WF,
                                       const FreeArc* arc, const TurnOptions& options);

}  // namespace hvas::orders
