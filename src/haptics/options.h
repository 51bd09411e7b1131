#pragma once

#include <cstdint>
#include <optional>

#include "contact/scene.h"
#include "device/device.h"
#include "fits/friction.h"
#include "fits/paper_scales.h"
#include "haptics/safety_gate.h"
#include "haptics/workspace.h"
#include "mates/capture.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** The three conditions of X14. */
enum class Condition {
  kCollision,   ///< Contact only: no mate is captured.
  kConstraint,  ///< Mates only: parts can interpenetrate.
  kHybrid,      ///< Both, and the force of the fit.
};

/** How the true forces of fits become felt ones. */
enum class ForceMapKind {
  kPublished,  ///< One map for all (force_map.h).
  kPaper,      ///< Paper W's: each kind of fit by a factor of its own (fits/paper_scales.h).
};

[[nodiscard]] constexpr const char* ToString(ForceMapKind kind) noexcept {
  return kind == ForceMapKind::kPaper ? "paper" : "published";
}

/** Factors of ForceMapKind::kPaper. Those of clearance fits are 1: they are shown as they are. */
struct PaperFactors {
  double interference{fits::FindPaperScale(fits::FitKind::kInterference).factor};  ///< k_r of W(8).
  double transition{fits::FindPaperScale(fits::FitKind::kTransition).factor};      ///< k_s of W(9).

  [[nodiscard]] double Of(fits::FitKind kind) const noexcept {
    return kind == fits::FitKind::kInterference ? interference
           : kind == fits::FitKind::kTransition ? transition
                                                : 1;
  }

  friend bool operator==(const PaperFactors&, const PaperFactors&) = default;
};

/** Spring and damper between the tracked and the displayed part, X(1) and X(2). Those of a device
 are chosen for it (coupling_rule.h); these are choices, varied in docs/algorithms/sensitivity.md.
 */
struct CouplingGains {
  double k_lin{1000};  ///< [N/m]
  double b_lin{8};     ///< [N s/m]
  double k_rot{3};     ///< [N m/rad]
  double b_rot{0.02};  ///< [N m s/rad]
};

/** When a mate is captured and how it guides (docs/algorithms/haptics.md, section 4). Choices where
 the papers set none; docs/algorithms/sensitivity.md varies most. */
struct GuidanceOptions {
  mates::CaptureThresholds capture;
  double ramp_time{0.25};          ///< Time from first touch of guidance to full stiffness [s].
  double k_lin{1e6};               ///< Full stiffness across an axis [N/m].
  double k_rot{1e4};               ///< Full stiffness against tilt [N m/rad].
  double max_force{20};            ///< Guidance never pulls harder [N].
  double max_torque{2};            ///< [N m]
  double attraction_force{1.0};    ///< K1 F_max of X(9) [N].
  double attraction_torque{0.15};  ///< Attraction about a free axis [N m].
  /** Distance from its place at which a part is in it [m]; of a part that small features guide no
   more than a tenth of the smallest. */
  double seat_distance{0.15e-3};
  double seat_angle{0.06};      ///< [rad]
  double match_distance{3e-3};  ///< Distance at which a part is matched, and drawn home (W7) [m].
  double seat_time{0.12};       ///< Duration of the last, exact, movement into place [s].
  /** A part that is let go so near to its place, and can be moved there, is in it [m]. 0: it stays
   where it was let go. */
  double finish_distance{0};
  /** A shaft with play touches its hole where the two are: it tilts, jams and wedges. Without, its
   mate guides it in the hole as well, as in the papers. */
  bool contact_in_holes{false};
  /** A threaded part goes in and comes out by turning, and is tightened. Without, it goes straight,
   with the faces of the thread out of contact. */
  bool threads_turn{false};
  /** X(9) goes on where a fit resists, as in paper X. Without it the fit takes over as it engages:
   what draws a part in holds it back on the way out. */
  bool attracts_in_fits{false};
  /** Mates of a part whose way bends or turns capture it on the last, straight piece only: further
   out they would hold it where it passes. For a hand that needs no guidance to find its way. */
  bool captures_on_straight_end{false};
};

/** How contacts answer (docs/algorithms/haptics.md, section 2). Choices, not measured one by one
 but for those that docs/algorithms/sensitivity.md varies. */
struct ContactOptions {
  double compliance{5e-7};      ///< [m/N]; 5 um at 10 N.
  double settling_time{2e-3};   ///< Settling time of a contact under a new load [s].
  fits::FrictionLaw friction;   ///< Friction of pairs that the table of materials does not have.
  double rolling_arm{5e-4};     ///< Arm against rolling and turning of free bodies [m].
  double recovery_speed{0.02};  ///< Penetration is undone no faster [m/s].
  double max_depth{100e-6};     ///< A contact pushes no harder than at this depth [m].
  double edge_break{1e-6};      ///< Lower ledges do not catch [m].
  double min_margin{60e-6};     ///< Contacts are looked for at least this far away [m].
  double max_speed{1.0};        ///< The displayed part moves no faster [m/s].
  double max_turn_rate{10.0};   ///< [rad/s]
  double max_free_speed{3.0};   ///< Free bodies move no faster [m/s].
  double rest_time{0.3};        ///< A free body at rest for so long sleeps [s].
  double stop_depth{50e-6};  ///< No motion within a tick goes deeper than this, or than before [m].
};

/** How much a tick may do. Less of it where the time does not suffice, in this order. */
struct Effort {
  std::uint32_t point_budget{contact::kTickPointBudget};  ///< Points of each query.
  int iterations{30};                                     ///< Iterations of the solver.
  bool wakes_bodies{true};  ///< Loose parts begin to move when they are touched.
};

struct TickOptions {
  Condition condition{Condition::kHybrid};
  /** Fits resist on the way in and out; without, a guided part slides as if it had none (W8: A3).
   */
  bool renders_fits{true};
  WorkspaceOptions workspace;
  CouplingGains coupling;
  GuidanceOptions guidance;
  ContactOptions contact;
  Vec3 gravity_W{0, 0, -9.81};   ///< [m/s^2]
  double max_virtual_mass{1.0};  ///< Inertia that is felt at most; the weight is mapped [kg].
  ForceMapKind force_map{ForceMapKind::kPublished};
  PaperFactors paper_factors;
  device::DeviceProfile device;
  /** What the device is given at most; without: the device's peaks and usual rates. */
  std::optional<SafetyLimits> limits;
  /** A device is in the hand: the energy that it gives and takes is controlled (N6). */
  bool controls_passivity{false};
  /** Lever of a device that shows forces but no torques: from its point to where the hand holds it,
   in H [m]; a torque becomes the force at that lever. Zero: torques are not shown then. */
  Vec3 p_HG{Vec3::Zero()};
  double dt{1e-3};  ///< [s]
};

}  // namespace hvas::haptics
