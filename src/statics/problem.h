#pragma once

#include <limits>
#include <vector>

#include "base/result.h"
#include "spatial/pose.h"

/** Statics of rigid bodies that lie on, lean on and hang from one another with dry friction
 (docs/algorithms/statics.md). */
namespace hvas::statics {

/** Standard gravity, downwards [m/s2] (General Conference on Weights and Measures, 1901). */
inline constexpr double kStandardGravity = 9.80665;

/** Index of what carries everything in contacts and joints: the ground, or a fixture. */
inline constexpr int kGround = -1;

struct StaticBody {
  double mass{1};           ///< [kg], > 0.
  Vec3 p_WC{Vec3::Zero()};  ///< Centre of mass [m].
  bool is_fixed{false};     ///< It is held: whatever acts on it is carried.
};

/** A point at which two bodies can push, and by friction not slide. */
struct StaticContact {
  int a{0};                    ///< Index of a body.
  int b{kGround};              ///< Index of another body, or kGround.
  Vec3 p_W{Vec3::Zero()};      ///< [m]
  Vec3 nhat_W{Vec3::UnitZ()};  ///< Unit, out of b: b pushes a along it.
  double friction{0};          ///< Static coefficient of Coulomb, >= 0.
};

/** What holds two bodies firmly together: it transmits any wrench up to its limits. */
struct StaticJoint {
  int a{0};                                                  ///< Index of a body.
  int b{kGround};                                            ///< Index of another body, or kGround.
  Vec3 p_W{Vec3::Zero()};                                    ///< A point of its axis [m].
  Vec3 axis_W{Vec3::UnitZ()};                                ///< Unit.
  double pull_out{std::numeric_limits<double>::infinity()};  ///< Most force along the axis [N].
  double torque{std::numeric_limits<double>::infinity()};    ///< Most torque about it [N m].
};

struct StaticProblem {
  Vec3 g_W{-kStandardGravity * Vec3::UnitZ()};  ///< Gravity [m/s2], not zero.
  std::vector<StaticBody> bodies;
  std::vector<StaticContact> contacts;
  std::vector<StaticJoint> joints;
};

/** Sides of the pyramid that stands for a cone of friction. It is inscribed: what it finds to stand
 stands with the cone, and between two edges it has cos(pi / 8) = 0.924 of the coefficient. A
 choice: its cross section is 0.900 of the cone's, with twice as many sides 0.974. */
inline constexpr int kPyramidSides = 8;

/** Lists the edges of a contact's pyramid: nhat + mu d for kPyramidSides directions d across it,
 the first of them along what of gravity is across the normal, so that the limit of a slope is
 exact. One edge, the normal, where there is no friction. Where gravity is along the normal, the
 first direction is the coordinate axis that is farthest from the normal, projected. */
[[nodiscard]] std::vector<Vec3> ListPyramidEdges(const StaticContact& contact, const Vec3& g_W);

/** Checks that numbers are finite and in their ranges, and that indices are those of two different
 bodies. Errors: kInvalid, with the index of what is wrong. */
[[nodiscard]] Result<void> CheckProblem(const StaticProblem& problem);

/** Finds the contacts that suffice: of those of one pair of bodies with the same friction in one
 plane (with normals equal within 1e-7, and offsets within 1e-7 of their extent), the corners of
 their convex hull. A force within the hull is a sum of such at its corners with the same resultant
 wrench, so the others add nothing. Sorted indices. */
[[nodiscard]] std::vector<int> ListSpanningContacts(const std::vector<StaticContact>& contacts);

}  // namespace hvas::statics
