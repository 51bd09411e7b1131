#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "contact/face_offsets.h"
#include "contact/pool.h"
#include "contact/shape.h"
#include "spatial/box.h"
#include "spatial/pose.h"

namespace hvas::contact {

using BodyId = Id<struct ContactBodyTag>;

/** One contact point between the held shape H and a scene body S, or the ground. */
struct Contact {
  Vec3 p_WC{
      Vec3::Zero()};  ///< Point of the held part's surface (or of the projected scene edge) [m].
  Vec3 nhat_W{Vec3::UnitZ()};  ///< Unit, out of S: moving H along it separates.
  double distance{0};          ///< Signed gap [m]; negative is penetration.
  BodyId body;                 ///< Invalid for the ground.
  std::uint32_t held_face{kNoFace};
  std::uint32_t scene_face{kNoFace};
  bool is_exact{false};  ///< Refined on an analytic face; else the field's trilinear value.
};

/** Contacts between two sets of faces that something else answers for (a captured mate's fit).
 A contact is left out when its held face and its scene face are both in the pair's sets; sample
 points on an edge belong to every face that meets there. */
struct IgnoredPair {
  BodyId body;
  std::span<const std::uint32_t> held_faces;   ///< Sorted.
  std::span<const std::uint32_t> scene_faces;  ///< Sorted.
};

/** How deep the faces of two bodies may lie in one another before contact begins: by as much as
 they are drawn into each other, or as one of them gives. All other faces of the two have contact.
 */
struct Allowance {
  BodyId body;
  double depth{0};                             ///< [m], >= 0.
  std::span<const std::uint32_t> held_faces;   ///< Sorted; empty: all.
  std::span<const std::uint32_t> scene_faces;  ///< Sorted; empty: all.
};

/** Edges as real parts have them: not sharp. Drawn ones catch on one another by what contacts give
 way under load, and where they pass each other closely, seem to be met. */
struct BrokenEdges {
  double height{0};          ///< Ledges lower than this are not met from their side [m].
  spatial::Pose X_WH_ahead;  ///< Where the held part will be next, as far as is known.
};

/** Lists of bodies that a query leaves out: one of what moves with the part, and eight. A choice.
 */
inline constexpr std::size_t kMaxLeftOut = 9;

/** Points of a query of a tick. With 4,096 the 99th percentile of docs/algorithms/contact.md's
 tracks is up to 1.7 times as long; docs/algorithms/sensitivity.md has what comes of fewer. */
inline constexpr std::uint32_t kTickPointBudget = 2048;

struct QueryOptions {
  double margin{50e-6};  ///< Contacts with a distance below this are reported [m].
  std::span<const IgnoredPair> ignored{};
  std::span<const Allowance> allowances{};  ///< The first one of a body counts.
  /** Lists of bodies that are not asked: what moves with the part, and what others hold. */
  std::array<std::span<const BodyId>, kMaxLeftOut> left_out{};
  /** The held part's faces as made; null: those of `self`, and if there is none, as drawn. */
  const FaceOffsets* held_offsets{nullptr};
  BodyId self;  ///< This body of the scene is the held one itself: skipped.
  std::optional<BrokenEdges> broken_edges{};  ///< None: edges are as drawn.
  /** How many points are tested, at most and about. Where more are near, each pair of parts has its
   share, and what it has more of is thinned out evenly: fewer points then stand for a contact. */
  std::uint32_t point_budget{kDefaultPointBudget};

  // The times of docs/realtime.md are measured with it; docs/algorithms/sensitivity.md varies it.
  static constexpr std::uint32_t kDefaultPointBudget = 4096;

  /** The budget also bounds how many points go through triangles, as docs/algorithms/contact.md
   says: for queries that have to end in time. */
  bool bounds_refinement{false};

  /** Pairs of `ignored` with one body that are told apart, by the bits of a face's mask; the last
   of these and all further ones are one pair. */
  static constexpr std::size_t kMaxPairsPerBody = 8;
};

struct QueryStats {
  std::uint32_t bodies_tested{0};
  std::uint32_t points_tested{0};
  std::uint32_t points_dropped{0};  ///< Near, but beyond the budget; whole leaves of eight.
  std::uint32_t candidates{0};      ///< Points within the margin, before reduction.
  bool is_truncated{false};         ///< The point budget or a capacity was reached.
};

/** Whether queries of a workspace remember what is far away. */
enum class QueryMemory {
  kNone,
  kOfMotion  ///< They do, with the same answers: for poses that follow one another closely. Takes
             ///< 2 MB.
};

/** Everything a query writes to: sized once, so that a query allocates nothing. One per thread. */
class QueryWorkspace {
 public:
  static constexpr int kMaxContacts = 64;  ///< The solver has room for twice as many.

  explicit QueryWorkspace(QueryMemory memory = QueryMemory::kNone);
  ~QueryWorkspace();
  QueryWorkspace(QueryWorkspace&&) noexcept;
  QueryWorkspace& operator=(QueryWorkspace&&) noexcept;

  [[nodiscard]] std::span<const Contact> contacts() const noexcept;
  [[nodiscard]] const QueryStats& stats() const noexcept;
  /** The deepest distance met, over all points and not only the reported ones [m]; +inf if none. */
  [[nodiscard]] double deepest() const noexcept;

  /** The force of all points in contact, and not only the reported ones. */
  [[nodiscard]] const ContactLayer& layer() const noexcept;

  struct Data;

  [[nodiscard]] Data& data() noexcept { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/** Bodies in the world, each a shared shape at a pose, in a bounding-volume tree.

 Adding and removing allocate; SetPose, SetEnabled and Query do not and are RT-safe. */
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  BodyId Add(std::shared_ptr<const Shape> shape, const spatial::Pose& X_WB);
  void SetPose(BodyId body, const spatial::Pose& X_WB) noexcept;
  /** Gives a body its faces as made; null: as drawn, as are offsets of another shape. Frees what it
   had: not RT-safe. */
  void SetOffsets(BodyId body, std::shared_ptr<const FaceOffsets> offsets);
  [[nodiscard]] const FaceOffsets* offsets(BodyId body) const noexcept;
  void SetEnabled(BodyId body, bool is_enabled) noexcept;
  [[nodiscard]] bool is_enabled(BodyId body) const noexcept;
  [[nodiscard]] const spatial::Pose& pose(BodyId body) const noexcept;
  [[nodiscard]] const Shape& shape(BodyId body) const noexcept;
  [[nodiscard]] std::size_t size() const noexcept;

  /** Answers without vector instructions from now on, with the same results: to test and measure.
   */
  void UseScalarKernel() noexcept;

  /** A horizontal ground plane (a table) at height z, facing up; NaN for none. */
  void SetGround(double z_W) noexcept;

  /** Finds contacts of `held` at X_WH with all enabled bodies (both directions: held points against
   scene fields, scene edge points against the held field) and the ground, refined on exact faces,
   reduced to at most QueryWorkspace::kMaxContacts that span the contact. Results in `workspace`.
   RT-safe. */
  void Query(const Shape& held, const spatial::Pose& X_WH, const QueryOptions& options,
             QueryWorkspace* workspace) const noexcept;

  /** True when nothing comes closer than -tolerance; stops at the first deeper point. RT-safe. */
  [[nodiscard]] bool IsFree(const Shape& held, const spatial::Pose& X_WH, double tolerance,
                            const QueryOptions& options, QueryWorkspace* workspace) const noexcept;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace hvas::contact
