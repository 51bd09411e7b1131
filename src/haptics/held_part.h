#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/units.h"
#include "contact/scene.h"
#include "contact/shape.h"
#include "fits/fit_force.h"
#include "fits/friction.h"
#include "fits/iso286.h"
#include "haptics/giving_curve.h"
#include "haptics/rigid_group.h"
#include "mates/capture.h"
#include "product/ids.h"
#include "spatial/pose.h"

namespace hvas::haptics {

/** Faces that a captured mate answers for. The neighbours are the faces that share an edge with the
 mating faces, or end in their plane: a shaft's rim passes the rim of its hole, and a tooth of a
 horn the rim of the plate that it slides onto, at no distance at all. Sorted. */
struct MateFaces {
  std::vector<std::uint32_t> mating;
  std::vector<std::uint32_t> with_neighbours;
};

/** A threaded joint of the held part, as the hand feels it. */
struct HeldThread {
  double lead{0};            ///< Advance of a turn; negative: left-handed [m].
  double play{0};            ///< Axial play between the flanks [m].
  double pitch_diameter{0};  ///< d2 [m]
  double friction{0};        ///< mu of the thread, and under the head.
  double running_torque{0};  ///< Torque that it takes to turn it without load [N m].
  double head_radius{0};     ///< Mean radius of the contact under the head, D_K / 2 [m].
  /** Force along the axis for each metre that screw and clamped parts give together [N/m]; 0: there
   is nothing to clamp. */
  double stiffness{0};
  double preload{0};  ///< F_M, tightened in its place [N].

  /** Advance of a radian, >= 0: |lead| / (2 pi) [m/rad]. */
  [[nodiscard]] double rise() const noexcept { return std::abs(lead) / units::kTurn; }

  /** Angle before its place at which its head comes to rest [rad]. */
  [[nodiscard]] double head_angle() const noexcept {
    return stiffness > 0 ? preload / (stiffness * rise()) : 0;
  }
};

/** A mate of the held part with a part that is already in its place. */
struct HeldMate {
  product::MateId id;
  spatial::Pose X_WM;     ///< Connector of the placed side; prismatic: x is the way out.
  spatial::Pose X_BN;     ///< Connector of the held side. z as X_WM's (axes) or opposed (planes).
  std::size_t member{0};  ///< Whose face it is: 0 for the part itself, else members[member - 1].
  mates::CaptureMate capture;  ///< Kind and spans, for recognition.
  double radius{0};      ///< Nominal, of the hole; half the width of a slot [m]; 0 for planes.
  double breadth{0};     ///< Prismatic: of the contact across its way [m]; else 0.
  double shift{0};       ///< Prismatic: z of the held side from the middle, as drawn [m].
  bool has_shaft{true};  ///< Axis-hole: the held side is the shaft, not the hole.
  bool is_stop{false};   ///< A plane that ends the insertion, not one that guides it.
  std::shared_ptr<const fits::FitForce> fit;          ///< Null for planes and threads.
  std::optional<HeldThread> thread;                   ///< Where its pitch is known.
  fits::FitKind fit_kind{fits::FitKind::kClearance};  ///< Says which factor of PaperFactors counts.
  contact::BodyId body;                               ///< The placed part in the scene.
  std::shared_ptr<const MateFaces> held_faces;
  std::shared_ptr<const MateFaces> placed_faces;
};

/** A further part that moves with the one in the hand, when a subassembly is held as one body (X3).
 */
struct HeldMember {
  product::OccurrenceId occurrence;
  contact::BodyId body;
  std::shared_ptr<const contact::Shape> shape;
  spatial::Pose X_BS;                          ///< Pose in the frame of the part in the hand.
  std::vector<contact::BodyId> left_out;       ///< The rest of the subassembly.
  std::vector<contact::Allowance> allowances;  ///< What it may overlap; spans of the model.
};

/** A fastener in its place that the part in the hand, a tool, can turn by contact with it (X16). It
 moves along its thread only, and stands still until contacts turn it harder than its dry friction.
 */
struct HeldDrive {
  contact::BodyId body;
  spatial::Pose X_WB_seat;     ///< Pose in which it is seated: it goes no further in.
  Vec3 p_WQ{Vec3::Zero()};     ///< Point of its axis.
  Vec3 axis_W{Vec3::UnitZ()};  ///< Unit, out of its thread.
  double travel{0};            ///< Along the axis, counter-clockwise about it [m/rad].
  double torque{0};            ///< Dry friction in its thread and under its head [N m].
};

/** A part that gives on the way of the held part to its place, or the held part itself. */
struct HeldGive {
  std::shared_ptr<const GivingCurve> curve;
  double widest{0};  ///< The furthest that it gives [m].
};

/** Everything the tick needs to know of the part in the hand; built outside the tick, then
 * constant. */
struct HeldPart {
  product::OccurrenceId occurrence;
  contact::BodyId body;
  std::shared_ptr<const contact::Shape> shape;
  double mass{0};  ///< [kg]
  Vec3 p_BoBcm_B{Vec3::Zero()};
  Mat3 I_BBcm_B{Mat3::Zero()};
  spatial::Pose X_WB_start;          ///< Where it is taken up, unless it moves.
  spatial::Pose X_WB_goal;           ///< Its place in the product.
  Vec3 insertion_W{-Vec3::UnitZ()};  ///< Unit, the way in.
  /** How far from its place its way is straight [m]; where a way bends or turns, nothing draws it
   straight to its place. */
  double straight_end{std::numeric_limits<double>::infinity()};
  bool starts_in_place{false};  ///< It is taken out: X_WB_start is its place.
  std::vector<HeldMate> mates;
  /** Diameter or width of the smallest feature that guides it; infinite where none does [m]. */
  double smallest_guide{std::numeric_limits<double>::infinity()};
  bool lacks_partners{false};  ///< What it should have been put to is not there: it never seats.
  std::vector<contact::BodyId> left_out;       ///< They move with it: no contact.
  std::vector<contact::Allowance> allowances;  ///< What it may overlap; spans of the model.
  std::vector<HeldMember> members;             ///< Other parts of a subassembly.
  std::vector<contact::BodyId> bodies;  ///< All that is in the hand: `body`, and the members'.
  fits::FrictionSurface surface{fits::FrictionSurface::kUnknown};
  std::vector<HeldGive> gives;     ///< What gives against a part in its place.
  std::vector<HeldDrive> drives;   ///< Fasteners that it fits, where it is a tool.
  bool falls_when_dropped{false};  ///< Let go anywhere but in its place, it is a free body.

  // Parts that are put together on the table (X1).
  std::shared_ptr<const RigidGroup> group;  ///< It and its members, let go; null: a part alone.
  /** What stays together of the subassembly that it is taken out of; null: none does. */
  std::shared_ptr<const RigidGroup> left_behind;
  /** Its places at loose parts on the table: the same part with another goal and other mates. */
  std::vector<std::shared_ptr<const HeldPart>> table_places;
  /** Only of a table place: the loose parts that it is put to, which stand still meanwhile. */
  std::shared_ptr<const RigidGroup> target;
  spatial::Pose X_WT_target;  ///< Pose of the target's first part.
  double target_range{0};     ///< Distance from which on the target stands still [m].
  std::shared_ptr<const RigidGroup> joined;  ///< The target with this part in its place.

  [[nodiscard]] bool has_bent_way() const noexcept { return std::isfinite(straight_end); }
};

}  // namespace hvas::haptics
