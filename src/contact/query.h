#pragma once

#include <array>
#include <limits>
#include <vector>

#include "contact/bound_memory.h"
#include "contact/pool.h"
#include "contact/reduce.h"
#include "contact/refine.h"
#include "contact/scene.h"
#include "contact/shape_data.h"

namespace hvas::contact {

// Rooms that are made once, so that a query allocates nothing: choices. What does not fit is left
// out, and QueryStats::is_truncated says so.
inline constexpr std::size_t kMaxQueryHits = 32768;
inline constexpr std::size_t kMaxQueryFaces = 65536;
inline constexpr std::size_t kMaxQueryLeaves = 65536;
inline constexpr std::size_t kMaxQueryBodies = 512;

/** Threads of the held part and of a body of the scene that are in one another; null: none are. */
struct ThreadPair {
  const Helix* held{nullptr};
  const Helix* scene{nullptr};
  bool is_deep{false};  ///< So far that what is left of flanks at their ends does not matter.
};

/** Which samples of a part the edges of its thread stand for. */
struct ThreadSamples {
  std::uint8_t number{0};  ///< Those of which Shell::thread is this; 0: none.
  std::uint8_t beyond{0};  ///< Number for those beyond its span; 0: none.

  [[nodiscard]] bool Has(std::uint8_t thread) const noexcept {
    return thread != 0 && (thread == number || thread == beyond);
  }
};

/** A body near the held part, and the leaves of either shell that are near the other's surface. */
struct NearBody {
  BodyId body;
  std::array<std::uint32_t, 2> first{};  ///< Into the leaves: of the held shell, of the body's.
  std::array<std::uint32_t, 2> count{};
  std::array<BoundView, 2> bounds;
  ThreadPair threads;
};

struct QueryWorkspace::Data {
  std::vector<Hit> hits = std::vector<Hit>(kMaxQueryHits);
  std::vector<NearLeaf> leaves = std::vector<NearLeaf>(kMaxQueryLeaves);
  std::size_t leaf_count{0};
  std::unique_ptr<BoundMemory> memory;  ///< Null: each query is for itself.
  std::array<NearBody, kMaxQueryBodies> bodies;
  std::size_t body_count{0};
  ContactReducer reducer;
  ContactLayer layer;  // In W.
  std::array<RawContact, kMaxContacts> raw;
  std::array<Contact, kMaxContacts> contacts;
  std::size_t contact_count{0};
  QueryStats stats;
  double deepest{std::numeric_limits<double>::infinity()};
  // For each face, bit i when it is in the i-th ignored pair of the body at hand; else all zero.
  std::vector<std::uint8_t> held_mask = std::vector<std::uint8_t>(kMaxQueryFaces);
  std::vector<std::uint8_t> scene_mask = std::vector<std::uint8_t>(kMaxQueryFaces);

  void Clear() noexcept;
};

/** Where a shape's centred frame is in the world, and its faces as made. */
struct Placed {
  const Shape::Data* shape;
  const FaceOffsets* offsets;  // Null: as drawn.
  Mat3 R_WC;
  Vec3 p_WC;

  Placed(const Shape& s, const spatial::Pose& X_WB, const FaceOffsets* o)
      : shape(&s.data()),
        offsets(o != nullptr && o->shape().get() == &s ? o : nullptr),
        R_WC(X_WB.R()),
        p_WC(X_WB.p() + R_WC * s.data().p_BC) {}

  /** Distance of the part as made. */
  [[nodiscard]] Vec3 half() const { return 0.5 * shape->box_B.size() + Vec3::Constant(growth()); }

  [[nodiscard]] double growth() const { return offsets != nullptr ? offsets->growth() : 0; }

  /** Sample i of one of the shape's shells, where it is on the part as made. */
  [[nodiscard]] Vec3 Sample(const Shell& shell, std::uint32_t i) const noexcept {
    const Vec3 p = shell.point(i);
    return offsets != nullptr ? Vec3(p + offsets->ShiftOf(shell, i)) : p;
  }
};

/** Takes coordinates of b's centred frame to a's. */
struct RelativePose {
  Mat3 R;
  Vec3 p;

  RelativePose(const Placed& a, const Placed& b)
      : R(a.R_WC.transpose() * b.R_WC), p(a.R_WC.transpose() * (b.p_WC - a.p_WC)) {}

  // Written out, as compilers leave the product of the library a function.
  [[nodiscard]] Vec3 operator*(const Vec3& q) const {
    return R.col(0) * q.x() + R.col(1) * q.y() + R.col(2) * q.z() + p;
  }

  [[nodiscard]] FloatPose Single() const;
};

/** The query of one held shape, body by body, into a workspace's reducer. Ends at the first contact
 below `stop_distance`. RT-safe. */
class BodyQuery {
 public:
  BodyQuery(const Placed& held, const QueryOptions& options, double margin, double stop_distance,
            const Kernel& kernel, QueryWorkspace::Data* work)
      : held_(held),
        options_(options),
        margin_(margin),
        stop_distance_(stop_distance),
        kernel_(kernel),
        work_(work) {}

  /** Notes what is near of a body. */
  void Collect(BodyId id, const Placed& scene) noexcept;
  /** Shares the budget out among what was collected. */
  void Share() noexcept;
  /** Finds the contacts with the i-th body collected. */
  void Body(std::size_t i, const Placed& scene) noexcept;
  void Ground(double z_W) noexcept;

  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

 private:
  [[nodiscard]] bool BoxesTouch(const RelativePose& X_SH, const Placed& scene) const noexcept;
  bool SetMasks(BodyId id, std::uint8_t keep) noexcept;
  /** Finds what is allowed with a body; null where nothing is. */
  [[nodiscard]] const Allowance* FindAllowance(BodyId id) const noexcept;
  template <bool kIsReverse>
  void CollectLeaves(const Placed& sampled, const Shell& shell, const Placed& field,
                     const ThreadSamples& left_out, NearBody* near) noexcept;
  [[nodiscard]] ThreadPair FindThreads(BodyId id, const Placed& scene) const noexcept;
  template <bool kIsReverse>
  void ThreadEdges(const Placed& sampled, const Helix& own, const Placed& field, const Helix& other,
                   BodyId body) noexcept;
  /** The margin for the field of the part as drawn in single precision. */
  [[nodiscard]] double Reach(const Placed& sampled, const Placed& field,
                             const RelativePose& X_FS) const noexcept;
  /** Thins leaves out to a number of points. */
  [[nodiscard]] static LeafChoice Thin(const LeafChoice& all, double points) noexcept;
  template <bool kIsReverse>
  void Samples(const Placed& sampled, const Shell& shell, const Placed& field, bool has_ignored,
               const NearBody& body) noexcept;
  /** Tests samples of the leaves of a shell near a body, as many as its share allows. Returns how
   they were chosen. */
  LeafChoice TestLeaves(const Placed& sampled, const Shell& shell, const Placed& field,
                        const RelativePose& X_FS, const LeafChoice& all, const BoundView& bounds,
                        HitBuffer* hits) noexcept;

  /** The samples of a shell near a body. */
  struct SampledShell {
    const Placed& placed;
    const Shell& shell;
    const Placed& field;
    Mat3 R_back;  ///< Takes a gradient of the field to the direction towards it from a sample.
    double deep;  ///< Distance at which something is wrong whatever way a sample looks [m].
  };

  /** One of them. */
  struct Sample {
    const SampleFaces& faces;
    Vec3 p_F;  ///< Position in the field's frame.
  };

  /** What is known of the samples of a shell near a body before they are looked at one by one. */
  struct ShellQuery {
    SampledShell samples;
    RelativePose X_FS;
    const NearBody& body;
    const BoundView& bounds;
    bool has_ignored;         ///< Faces of the other shape are left out.
    bool remembers;           ///< Bounds of the distance are kept from query to query.
    LeafChoice tested{};      ///< Leaves and points of the shell that were tested.
    HitBuffer hits{};         ///< Samples that may be near.
    std::uint32_t stride{1};  ///< One of so many undecided hits is refined.
    float sparsity{1};        ///< Samples that each tested one stands for.
  };

  /** Tests the samples of a shell, and chooses how many of the hits are refined. */
  void FindHits(std::uint32_t first, ShellQuery* query) noexcept;
  /** Adds a hit at the thread of the other shape, by the thread's own equation. False where the
   sample is not there. */
  template <bool kIsReverse>
  bool AddAtThread(const ShellQuery& query, const Helix& thread, const Hit& hit,
                   const Sample& sample, RawContact* contact) noexcept;
  /** Adds a hit, as it is where single precision decides it, or refined. */
  template <bool kIsReverse>
  void AddHit(const ShellQuery& query, const Hit& hit, const Sample& sample,
              const FaceFilter& filter, bool is_refined, RawContact* contact) noexcept;
  /** Keeps how far a sample is from the other shape, for the next queries. */
  void Remember(const ShellQuery& query, const Hit& hit, const Refined& r, double limit) noexcept;
  /** Finds how deep a sample may lie in a face of the other shape [m]. */
  template <bool kIsReverse>
  [[nodiscard]] double CalcAllowance(const SampleFaces& sample, std::uint32_t face) const noexcept;
  /** Whether a sample is allowed to be as deep as a hit says, whatever face of a list it meets. */
  template <bool kIsReverse>
  [[nodiscard]] bool IsAllowed(const SampledShell& sampled, const Hit& hit,
                               const Sample& sample) const noexcept;
  /** Adds a hit that one face decides as it is, to be refined if it is left of the reduction. False
   where single precision does not tell whether it is a contact. */
  template <bool kIsReverse>
  bool AddScreened(const SampledShell& sampled, const Hit& hit, const Sample& sample,
                   RawContact* contact) noexcept;
  /** Adds a hit by what refinement made of it, if it is a contact. */
  template <bool kIsReverse>
  void AddRefined(const SampledShell& sampled, const Hit& hit, const Sample& sample,
                  const Refined& r, RawContact* contact) noexcept;
  /** Finds of how many hits that are not decided at once one is refined. */
  [[nodiscard]] std::uint32_t CalcStride(std::span<const Hit> hits, std::uint32_t leaf_count,
                                         bool are_lists_screened,
                                         const Placed& field) const noexcept;
  /** Gives hits of lists that were too far away, and have not moved since as far, kKnownFar. */
  void MarkKnownFar(const BoundView& bounds, bool are_lists_screened,
                    HitBuffer* hits) const noexcept;
  void GroundLeaf(double z_W, std::size_t leaf) noexcept;
  void AddToLayer(double distance, const SampleFaces& faces, const Vec3& nhat_S,
                  const Vec3& p_S) noexcept;
  void Add(const RawContact& contact, const SampleFaces& faces, const Vec3& nhat_S,
           const Vec3& p_S) noexcept;

  const Placed& held_;
  const QueryOptions& options_;
  double margin_;
  double stop_distance_;
  Kernel kernel_;
  QueryWorkspace::Data* work_;
  const Allowance* allowance_{nullptr};  // Of the body at hand.
  ContactLayer layer_;                   // Of the body at hand, in its centred frame.
  double share_{0};                      // Points for each shell of each body.
  double points_per_leaf_{0};            // Of the budget, for each near leaf.
  bool is_stopped_{false};
};

/** Moves a contact's sample over the face or edge it lies on to where the distance to the other
 shape is least, as far as the next samples. Without this the answer would depend on where samples
 happen to be. RT-safe. */
void Slide(const Placed& sampled, const Shell& shell, const Placed& field,
           RawContact* contact) noexcept;
/** Finds contacts over the ground, a plane in the sampled shape's frame. */
void SlideOnPlane(const Placed& sampled, const Shell& shell, const spatial::Surface& plane,
                  RawContact* contact) noexcept;

}  // namespace hvas::contact
