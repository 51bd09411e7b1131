#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "contact/mesh.h"
#include "contact/pair.h"

namespace hvas::contact {

/** A triangle and a lower bound of its distance from some point. */
struct NearTriangle {
  std::uint32_t triangle;
  double distance;
};

/** Bounds of distances are widened by this factor against rounding. */
inline constexpr double kSlack = 1 + 1e-9;

/** Leaves new elements as they are, so that a list that is written anyway costs nothing to make
 longer. */
template <typename T>
struct UnsetAllocator : std::allocator<T> {
  UnsetAllocator() = default;

  template <typename U>
  explicit UnsetAllocator(const UnsetAllocator<U>& /*other*/) noexcept {}

  template <typename U, typename... Arguments>
  void construct(U* p, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      ::new (static_cast<void*>(p)) U;
    } else {
      ::new (static_cast<void*>(p)) U(std::forward<Arguments>(arguments)...);
    }
  }
};

template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

using NearList = UnsetVector<NearTriangle>;

/** An order of entries by distance; a type, so that sorting by it is one loop. */
struct IsNearer {
  [[nodiscard]] bool operator()(const NearTriangle& a, const NearTriangle& b) const {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  }
};

/** A list, and its entry of the least distance: the first one of several. */
struct NearSet {
  NearList list;
  NearTriangle least{kNoFace, 0};
};

/** A triangle of which no more is known than how far its box is from some point. */
struct BoxedTriangle {
  std::uint32_t triangle;
  float radius;    ///< That of a ball around it [m], to single precision.
  double squared;  ///< Square of the distance of its box [m^2].
};

using BoxedList = UnsetVector<BoxedTriangle>;

/** What may be left of a list in a ball: not looked at but for the triangles' boxes. */
struct BegunFilter {
  BoxedList list;                ///< Triangles, with distances from the ball's centre.
  double lowest{0};              ///< The least squared distance of them.
  std::uint32_t first{kNoFace};  ///< A triangle of it.
  double least{0};               ///< Its distance from the ball's centre.
};

/** The nodes of two by two by two cells at most: their coordinates along each axis. */
struct NodeGrid {
  static constexpr std::size_t kMost = 27;  // Three nodes along each of three axes.

  std::array<std::array<double, 3>, 3> at{};
  std::array<std::size_t, 3> count{};

  [[nodiscard]] Vec3 NodeAt(std::size_t i, std::size_t j, std::size_t k) const {
    return {at[0][i], at[1][j], at[2][k]};
  }
};

struct Nearest {
  double distance{0};  ///< Signed where so said.
  std::uint32_t triangle{kNoFace};
  TrianglePoint point;
};

/** Looks for the closest triangles of a mesh, which outlives it, in lists that are cut down from
 larger regions to smaller ones. Several threads may use one. */
class NearSearch {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  explicit NearSearch(const Mesh& mesh);

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

  [[nodiscard]] NearList MakeFullList() const;

  /** Keeps, of the triangles given, those that may be closest to some point within `radius` of c,
   with lower bounds of their distances from c. @pre the list is not empty. */
  void Filter(const NearList& list, const Vec3& c, double radius, NearList* out) const;

  /** Does so for the eight octants of a cube at once.
   @param low,high  The centres of the first and of the last octant.
   @param wanted  Bit k: octant k (x first) is wanted; the others become empty.
   @param begun  Room for what is in between. */
  void FilterOctants(const NearSet& set, const Vec3& low, const Vec3& high, double radius,
                     unsigned wanted, std::array<BegunFilter, 8>* begun,
                     std::array<NearSet, 8>* out) const;

  /** Begins to do so. */
  void BeginOctants(const NearSet& set, const Vec3& low, const Vec3& high, double radius,
                    unsigned wanted, std::array<BegunFilter, 8>* out) const;

  /** Finds what may be closest to each node of a small grid, x first.
   @param first  A triangle that is near.  @param out  Longer ones are as good. */
  void FilterNodes(const BoxedList& list, std::uint32_t first, const NodeGrid& grid,
                   std::array<BoxedList, NodeGrid::kMost>* out) const;

  /** The entry of the least distance that End would leave. */
  [[nodiscard]] NearTriangle FindLeast(const Vec3& c, double radius,
                                       const BegunFilter& begun) const;

  /** Ends a filter that was begun: what it leaves is what Filter would. */
  void End(const Vec3& c, double radius, const BegunFilter& begun, NearSet* out) const;

  /** The closest triangle to p, from a list with lower bounds of the distances to a point that p is
   `offset` away from (kAnywhere: unknown). Begins with the triangle `hint`. Not signed. */
  [[nodiscard]] Nearest Find(const NearList& list, const Vec3& p, double offset,
                             std::uint32_t hint) const;

  /** Does what Mesh::ClosestOn does, with what was made ready for it. */
  [[nodiscard]] TrianglePoint ClosestOn(std::uint32_t triangle, const Vec3& p) const {
    return CalcClosestOnTriangle(p, corners_[triangle]);
  }

  /** Up to eight triangles of which the closest points are found at once. */
  class EightTriangles {
   public:
    static constexpr int kMost = 8;  ///< What the kernel takes at once.

    explicit EightTriangles(const NearSearch& of) : of_(of) {}

    EightTriangles(const NearSearch& of, const Vec3& p) : of_(of) {
      for (int i = 0; i < kMost; ++i) {
        SetPoint(i, p);
      }
    }

    /** True where there are eight now. */
    bool Add(std::uint32_t triangle) {
      triangles_[count_++] = triangle;
      return count_ == kMost;
    }

    /** Adds a triangle with a point of its own. */
    bool Add(std::uint32_t triangle, const Vec3& p) {
      SetPoint(count_, p);
      return Add(triangle);
    }

    void Calc() {
      const auto calc = count_ > 1 ? of_.calc_closest_ : &CalcEightClosestScalar;
      calc(of_.corners_.data(), triangles_, count_, points_, &closest_);
    }

    void Clear() { count_ = 0; }

    [[nodiscard]] int count() const { return count_; }

    [[nodiscard]] std::uint32_t triangle(int i) const { return triangles_[i]; }

    /** The square of the distance. */
    [[nodiscard]] double squared(int i) const { return closest_.squared[i]; }

    [[nodiscard]] TrianglePoint PointOf(int i) const {
      return {{closest_.q.at[0][i], closest_.q.at[1][i], closest_.q.at[2][i]},
              static_cast<TriangleFeature>(closest_.features[i])};
    }

   private:
    void SetPoint(int i, const Vec3& p) {
      points_.at[0][i] = p.x();
      points_.at[1][i] = p.y();
      points_.at[2][i] = p.z();
    }

    const NearSearch& of_;
    int count_{0};
    std::uint32_t triangles_[kMost]{};  // Those that are not wanted exist, too.
    EightPoints points_{};
    EightClosest closest_;
  };

  /** False where the triangle's box is further from p than `distance`. */
  [[nodiscard]] bool MayReach(std::uint32_t triangle, const Vec3& p, double distance) const {
    return boxes_[triangle].CalcSquaredDistance(p) <= distance * distance;
  }

  /** The least limit with which some point within `radius` of c may have, of the triangle's face,
   its closest point in the triangle; infinite where that is more than `most`. With a limit, no
   point of the face is looked at that is further from c.
   @param point  The triangle's closest point to c. */
  [[nodiscard]] double CalcLeastLimit(std::uint32_t triangle, const TrianglePoint& point,
                                      const Vec3& c, double radius, double most) const;

  /** The distance with its sign: negative inside. */
  [[nodiscard]] Nearest FindSigned(const NearList& list, const Vec3& p, double offset,
                                   std::uint32_t hint) const;

  /** True inside; nothing where triangles that are as close as the closest one, as those of faces
   that coincide, say different things. @param offset  As of Find.
   @param hint  A triangle that is near. */
  [[nodiscard]] std::optional<bool> FindSide(const NearList& list, const Vec3& p, double offset,
                                             std::uint32_t hint) const;

  /** Finds the distance with its sign at the point that the list has distances from. */
  [[nodiscard]] Nearest FindSignedInBoxed(const BoxedList& list, const Vec3& p,
                                          std::uint32_t hint) const;

  /** Finds it in a list that is sorted by IsNearer. */
  [[nodiscard]] Nearest FindSignedInSorted(const NearList& list, const Vec3& p, double offset,
                                           std::uint32_t hint) const;

 private:
  class Search;

  template <bool is_sorted>
  [[nodiscard]] Nearest FindIn(const NearList& list, const Vec3& p, double offset,
                               std::uint32_t hint) const;
  [[nodiscard]] Nearest GiveSign(const Vec3& p, Nearest nearest) const;

  [[nodiscard]] double CalcDistance(std::uint32_t triangle, const Vec3& p) const {
    return (ClosestOn(triangle, p).q - p).norm();
  }

  // A box around a triangle: tells most that are too far away at a tenth of the exact distance's
  // cost. In a line of the cache of its own.
  struct alignas(64) TriangleBox {
    double centre[3];
    double half[3];
    double radius;  // Of a sphere around it.

    [[nodiscard, gnu::always_inline]] double CalcSquaredDistance(const Vec3& p) const {
      const double x = std::max(std::abs(p.x() - centre[0]) - half[0], 0.0);
      const double y = std::max(std::abs(p.y() - centre[1]) - half[1], 0.0);
      const double z = std::max(std::abs(p.z() - centre[2]) - half[2], 0.0);
      return x * x + y * y + z * z;
    }

    // Of another box.
    [[nodiscard, gnu::always_inline]] double CalcSquaredDistance(const TriangleBox& other) const {
      double sum = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double beyond = std::max(
            std::abs(other.centre[axis] - centre[axis]) - half[axis] - other.half[axis], 0.0);
        sum += beyond * beyond;
      }
      return sum;
    }

    // What one axis adds to that, at two places.
    [[nodiscard, gnu::always_inline]] Pair CalcSquaredAlong(std::size_t axis, Pair p) const {
      const Pair beyond = ((p - Pair(centre[axis])).Abs() - Pair(half[axis])).Positive();
      return beyond * beyond;
    }
  };

  // A little larger than the nodes' own. Its radius is not set.
  [[nodiscard]] static TriangleBox BoxAround(const NodeGrid& grid);

  // How a triangle goes on in its face.
  struct Surroundings {
    double bend;  // Tangent of the largest angle to those it touches there; infinite: unknown.
    std::uint8_t rims;  // Bit k: edge k is on the face's rim.
  };

  void FindSurroundings();
  void FindRimBends();
  [[nodiscard]] double CalcLeastLimitOfRim(std::uint32_t triangle, std::size_t k, const Vec3& c,
                                           double radius, double most) const;

  const Mesh& mesh_;
  std::vector<TriangleBox> boxes_;
  std::vector<TriangleCorners> corners_;
  CalcEightClosest calc_closest_{ChooseEightClosest()};
  std::vector<Surroundings> surroundings_;
  std::vector<double> rim_bend_;  // Of each vertex: tangent of a rim's turn; infinite: unknown.
};

/** The entry with the lowest bound. @pre the list is not empty. */
[[nodiscard]] NearTriangle LeastOf(const NearList& list);

}  // namespace hvas::contact
