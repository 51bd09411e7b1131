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
#include "contact/quad.h"

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

  /** The first triangle of the least distance. @pre the list is not empty. */
  [[nodiscard]] std::uint32_t FindLowest() const {
    return std::find_if(list.begin(), list.end(),
                        [this](const BoxedTriangle& entry) { return entry.squared == lowest; })
        ->triangle;
  }
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

/** Triangles near the nodes of a grid, and how far they are from its middle. */
struct NodeRoom {
  /** Eight triangles' distances [m] and their gradients. */
  struct Slopes {
    float distance[8];
    float gradient[3][8];

    [[nodiscard]] std::array<float*, 3> gradient_rows(std::size_t i) {
      return {&gradient[0][i], &gradient[1][i], &gradient[2][i]};
    }
  };

  UnsetVector<std::uint32_t> triangles;
  UnsetVector<Slopes> slopes;
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

  /** Finds the distance with its sign at each node of a small grid, x first.
   @param list  A BoxedList or a NearList, whose distances are not looked at.
   @param first  A triangle that is near.  @param room  For what is in between. */
  template <typename List>
  void FindSignedAtNodes(const List& list, std::uint32_t first, const NodeGrid& grid,
                         NodeRoom* room, std::array<Nearest, NodeGrid::kMost>* out) const;

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

    [[nodiscard]] const EightClosest& closest() const { return closest_; }

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
  [[nodiscard]] Nearest FindSignedInBoxed(const BegunFilter& begun, const Vec3& p) const;

 private:
  class Search;
  class NodeSearch;

  [[nodiscard]] Nearest GiveSign(const Vec3& p, Nearest nearest) const;

  [[nodiscard]] double CalcDistance(std::uint32_t triangle, const Vec3& p) const {
    return (ClosestOn(triangle, p).q - p).norm();
  }

  // A box around a triangle: tells most that are too far away at a tenth of the exact distance's
  // cost. In a line of the cache of its own; without branches, which would be guessed wrongly.
  struct alignas(64) TriangleBox {
    double centre[4];  // And zero.
    double half[4];    // And the radius of a sphere around it.

    [[nodiscard]] double radius() const { return half[3]; }

    [[nodiscard, gnu::always_inline]] double CalcSquaredDistance(const Vec3& p) const {
      return SumOfSquares((Pair(p.x(), p.y()) - Pair(centre)).Abs() - Pair(half),
                          (Pair(p.z(), 0) - Pair(centre + 2)).Abs() - Pair(half + 2));
    }

    // Of another box.
    [[nodiscard, gnu::always_inline]] double CalcSquaredDistance(const TriangleBox& other) const {
      return SumOfSquares((Pair(other.centre) - Pair(centre)).Abs() - Pair(half) - Pair(other.half),
                          (Pair(other.centre + 2) - Pair(centre + 2)).Abs() - Pair(half + 2) -
                              Pair(other.half + 2));
    }

    // Of what is beyond along x and y, and along z; a radius stands below zero beside it.
    [[nodiscard, gnu::always_inline]] static double SumOfSquares(Pair xy, Pair z) {
      const Pair xxyy = xy.Positive() * xy.Positive();
      const double beyond = z.Positive().low();
      return xxyy.low() + xxyy.high() + beyond * beyond;
    }

    // What one axis adds to that, at two places.
    [[nodiscard, gnu::always_inline]] Pair CalcSquaredAlong(std::size_t axis, Pair p) const {
      const Pair beyond = ((p - Pair(centre[axis])).Abs() - Pair(half[axis])).Positive();
      return beyond * beyond;
    }
  };

  // Finds how far the room's triangles are from a point; the closest one, kNoFace where none is.
  std::uint32_t FindSlopes(const Vec3& middle, NodeRoom* room) const;

  // A little larger than the nodes' own. Its radius is no less than that of a sphere around it.
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
  CalcEightClosest calc_closest_{ChooseClosestKernels().eight};
  std::vector<Surroundings> surroundings_;
  std::vector<double> rim_bend_;  // Of each vertex: tangent of a rim's turn; infinite: unknown.
};

/** The entry with the lowest bound. @pre the list is not empty. */
[[nodiscard]] NearTriangle LeastOf(const NearList& list);

}  // namespace hvas::contact
