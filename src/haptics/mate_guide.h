#pragma once

#include <array>
#include <span>

#include "haptics/bore_contacts.h"
#include "haptics/constraint_solver.h"
#include "haptics/fit_rows.h"
#include "haptics/held_part.h"
#include "haptics/options.h"

namespace hvas::haptics {

/** Where the held part stands to one mate. */
struct MateGeometry {
  Vec3 axis_W{Vec3::UnitZ()};  ///< Axis or outward normal of the placed side; prismatic: across.
  Vec3 way_W{Vec3::UnitZ()};   ///< Along which it is engaged: the axis; prismatic: the way out.
  Vec3 p_WQ{Vec3::Zero()};     ///< The held side's point that the mate acts on.
  Vec3 offset_W{
      Vec3::Zero()};  ///< Vector from where Q belongs to Q: across the axis, or along the normal.
  Vec3 tilt_W{Vec3::Zero()};  ///< Small rotation that takes the held axis to the placed one [rad].
  double angle{0};            ///< |tilt| (X(7)) [rad].
  double distance{0};         ///< |offset| [m].
  double engaged{0};          ///< Length of the overlap: the insertion depth l [m].
  double depth{0};            ///< Insertion depth; negative by how far the spans are apart [m].
};

/** Geometry of a mate at a pose of the held part. RT-safe. */
[[nodiscard]] MateGeometry CalcMateGeometry(const HeldMate& mate,
                                            const spatial::Pose& X_WB) noexcept;

/** Recognises, captures, guides by and releases the mates of the held part (X5, X8..X10).

 A captured mate pulls by springs whose stiffness grows from nothing to its full value along a
 geometric ramp, and fades the same way: nothing the hand feels ever jumps. RT-safe. */
class MateGuide {
 public:
  /** Room for a held subassembly, with all its parts: a choice. */
  static constexpr std::size_t kMaxMates = 96;
  /** Shafts whose contacts in their holes are calculated at once; further ones are guided there:
   room in the solver. */
  static constexpr std::size_t kMaxBores = 4;
  static constexpr std::size_t kPairsPerMate = 2;  ///< Pairs that CollectIgnored fills for a mate.

  void Reset() noexcept { mates_.fill({}); }

  /** All mates of a part that is in its place hold it there from the first tick on. */
  void StartInPlace() noexcept;

  /** Captures and releases for the part at X_WB (displayed) while the hand wants X_WT. How far it
   wants the part beyond its place, along the way in, does not matter. */
  void Update(const HeldPart& part, const GuidanceOptions& options, const spatial::Pose& X_WB,
              const spatial::Pose& X_WT, double dt) noexcept;

  /** Adds the springs of all captured mates. */
  void AddSprings(const HeldPart& part, const GuidanceOptions& options,
                  ConstraintSolver* solver) noexcept;

  [[nodiscard]] bool is_near() const noexcept { return is_near_; }

  [[nodiscard]] int captured_count() const noexcept { return captured_count_; }

  /** A captured mate is on its axis (or square to its plane); its faces answer by their fit. */
  [[nodiscard]] bool is_aligned() const noexcept { return is_aligned_; }

  [[nodiscard]] bool is_captured(std::size_t i) const noexcept { return mates_[i].is_captured; }

  [[nodiscard]] const MateGeometry& geometry(std::size_t i) const noexcept {
    return mates_[i].geometry;
  }

  /** Fills pairs of faces that contact leaves to the mates of a member (0: the part itself);
   returns how many were written. */
  std::size_t CollectIgnored(const HeldPart& part, std::span<contact::IgnoredPair> pairs,
                             std::size_t member = 0) const noexcept;

  /** Mates whose shaft is in its hole with play, and touches it where the two are: guidance ends
   there, and contact answers (N5). */
  [[nodiscard]] bool is_bore(std::size_t i) const noexcept { return mates_[i].is_bore; }

  /** There is such a mate. */
  [[nodiscard]] bool has_bores() const noexcept { return has_bores_; }

  /** More shafts are in their holes than kMaxBores: the others are guided. */
  [[nodiscard]] bool has_guided_bores() const noexcept { return has_guided_bores_; }

  /** Contacts of a mate of which is_bore() is true. @returns how many were filled. */
  std::size_t CalcContacts(const HeldMate& mate, std::size_t i, const spatial::Pose& X_WB,
                           double margin, BoreContacts* contacts) const noexcept;

  /** Sum over aligned fits at their present depths, for a part that slips outwards at a speed
   [m/s]. */
  [[nodiscard]] FitLoad CalcFitLoad(const HeldPart& part, double slip,
                                    const PaperFactors& factors = {}) const noexcept;

  /** Force with which the bores hold the shaft back, for W5's Coulomb friction [N]. */
  [[nodiscard]] double lateral_force() const noexcept { return lateral_force_; }

  /** Deepest engagement of a captured mate that has a fit, of a shaft or a tongue [m]. */
  [[nodiscard]] double insertion_depth() const noexcept { return insertion_depth_; }

  /** The captured mate of shaft or tongue that is engaged deepest, or null. */
  [[nodiscard]] const MateGeometry* axis() const noexcept { return axis_; }

  [[nodiscard]] std::size_t axis_index() const noexcept { return axis_index_; }

  /** How far the fit on that axis lets the shaft be off the axis [m]; 0 without an axis, infinite
   for a tongue, which may lie anywhere along the walls. */
  [[nodiscard]] double CalcAxisPlay(const HeldPart& part) const noexcept;

 private:
  struct MateState {
    bool is_captured{false};
    bool is_aligned{false};  ///< Came onto its axis, and has not left the hole since.
    bool is_bore{false};     ///< Its shaft is in the hole, and touches it by contact.
    double ramp{0};          ///< 0: no guidance, 1: full stiffness.
    MateGeometry geometry;
  };

  static void UpdateAlignment(const HeldMate& mate, MateState* state) noexcept;
  /** Adds the spring that turns the part onto the mate's direction. @param guided  Share of the
   spring that is left in a hole. */
  static void AddTiltSpring(const HeldMate& mate, const MateState& state, double guided,
                            const GuidanceOptions& options, ConstraintSolver* solver) noexcept;
  /** Adds the spring that pulls two planes together. */
  static void AddWallSpring(const HeldMate& mate, const MateState& state,
                            const GuidanceOptions& options, ConstraintSolver* solver) noexcept;
  /** Adds the spring that pulls the part onto the mate's axis or centre. */
  void AddOffsetSpring(const HeldMate& mate, const MateState& state, double guided,
                       const GuidanceOptions& options, ConstraintSolver* solver) noexcept;
  void ChooseBores(const HeldPart& part, const GuidanceOptions& options) noexcept;

  std::array<MateState, kMaxMates> mates_{};
  bool is_near_{false};
  bool is_aligned_{false};
  bool has_bores_{false};
  bool has_guided_bores_{false};
  int captured_count_{0};
  double insertion_depth_{0};
  double lateral_force_{0};
  const MateGeometry* axis_{nullptr};
  std::size_t axis_index_{0};
};

}  // namespace hvas::haptics
