#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "base/result.h"
#include "contact/scene.h"
#include "paths/path.h"

namespace hvas::paths {

/** A line in W about which a part may turn, while it goes along the line. */
struct ScrewAxis {
  Vec3 p_WQ{Vec3::Zero()};     ///< A point of the line.
  Vec3 axis_W{Vec3::UnitZ()};  ///< Unit.
  double pitch{0};             ///< What a whole turn goes along the axis [m]; 0: a rotation.
};

/** A point at which the part is near another body, whichever of the two it is a sample of. */
struct NearPoint {
  Vec3 p_W{Vec3::Zero()};
  Vec3 nhat_W{Vec3::UnitZ()};  ///< Unit: moving the part along it separates them.
  double distance{0};          ///< Signed gap [m].
  contact::BodyId body;
  bool is_of_part{false};                ///< Whether it lies on the part, or on the body.
  std::uint32_t face{contact::kNoFace};  ///< Face of the other one that is nearest.
};

/** A screw that the faces around a part leave it. */
struct FreeScrew {
  ScrewAxis axis;
  double turn{0};                 ///< Turn about the axis on the way out [rad], >= 0.
  std::vector<NearPoint> flanks;  ///< What leaves it, with the part in the middle of its play.
  std::vector<NearPoint> passed;  ///< What it passes so on its way.
};

/** A rigid part among others, and where it has to go. What is pointed to outlives the search. */
struct WayProblem {
  const contact::Scene* scene{
      nullptr};  ///< All bodies, at their poses; disabled ones are not there.
  std::shared_ptr<const contact::Shape> part;
  contact::BodyId self;                    ///< The part itself in the scene, if it is there.
  spatial::Pose X_WB_start;                ///< Usually assembled: in contact or next to it.
  std::optional<spatial::Pose> X_WB_goal;  ///< None: out, clear of the boxes of all bodies.
  std::span<const contact::IgnoredPair> ignored{};
  std::span<const contact::Allowance> allowances{};
  std::array<std::span<const contact::BodyId>, 2> left_out{};
  /** How deep the part may be in others at a pose [m]; negative: the gap that it has to keep. */
  double tolerance{50e-6};
  std::vector<Vec3> directions_W;  ///< Straight directions to try first, as mates have them.
  std::vector<ScrewAxis> axes;     ///< Axes to try first.
};

struct WayOptions {
  std::uint64_t seed{1};  ///< Any number: a choice.
  /** How many contact queries (a choice: minutes) the search may take; what improves and checks the
   way comes on top, with at most as many again. */
  std::uint64_t budget{4'000'000};
  /** How many sample points they may test, so that fine shapes do not take longer than others. */
  std::uint64_t point_budget{std::numeric_limits<std::uint64_t>::max()};
  bool has_to_improve{true};  ///< The way is shortened, and moved to where it is clear of others.
  std::stop_token stop;
  std::function<void(double fraction)>
      progress;  ///< Gets the share of the budget; called by the calling thread.
};

enum class WayMethod {
  kStraight,    ///< One straight piece.
  kFreeMotion,  ///< The screw that the faces around the part leave it.
  kPushes,      ///< Pushes along given or found directions and axes, which slide along contacts.
  kTree,        ///< Tree search.
};

/** A way from the start to where the part has to go. Between poses the part moves along a screw. */
struct Way {
  Path path;  ///< Poses X_WB.
  /** The least distance at the poses of the path, no more than the tolerance's size; negative:
   penetration [m]. Between them it is as CheckWay() bounds it. */
  double deepest{0};
  WayMethod method{WayMethod::kStraight};
  FreeScrew screw{};  ///< kFreeMotion: which one.
};

/** What the part met where it got no further. */
struct StoppingFaces {
  contact::BodyId body;  ///< Invalid for the ground.
  std::uint32_t held_face{contact::kNoFace};
  std::uint32_t scene_face{contact::kNoFace};
};

struct WaySearch {
  std::optional<Way> way;
  std::uint64_t queries{0};  ///< Contact queries of all kinds.
  std::uint64_t points{0};   ///< Sample points that they tested: a measure of the time.
  /** The way to the pose nearest to the goal, or farthest from the start, where no way is found. */
  Path farthest;
  double distance_to_go{
      0};  ///< Distance to the goal; without one, how far boxes still overlap [m].
  std::vector<StoppingFaces> stops;  ///< What was met there, where no way is found.
  bool is_budget_over{false};
  bool is_stopped{false};
};

/** Finds a way for a rigid part in six degrees of freedom. Methods in this order: straight along
 the directions; pushes along directions and about axes, one after the other, where the part slides
 along what it meets; a tree of poses that grows along contacts, from both ends where there is a
 goal pose. docs/algorithms/planning.md describes them. What is found passes CheckWay() at a step of
 CheckStepOf(). The same input, seed and budget give the same way.
 Errors: kInvalid without a scene or a part, or where the start (or the goal) is deeper in
 others than the tolerance. */
[[nodiscard]] Result<WaySearch> FindWay(const WayProblem& problem, const WayOptions& options);

[[nodiscard]] const char* NameOf(WayMethod method);

}  // namespace hvas::paths
