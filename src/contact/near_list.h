#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "contact/mesh.h"

namespace hvas::contact {

/** A triangle and a lower bound of its distance from some point. */
struct NearTriangle {
  std::uint32_t triangle;
  double distance;
};

/** Bounds of distances are widened by this factor against rounding. */
inline constexpr double kSlack = 1 + 1e-9;

using NearList = std::vector<NearTriangle>;

/** An order of entries by distance. */
[[nodiscard]] inline bool IsNearer(const NearTriangle& a, const NearTriangle& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
}

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

  /** The closest triangle to p, from a list with lower bounds of the distances to a point that p is
   `offset` away from (kAnywhere: unknown). Begins with the triangle `hint`. Not signed. */
  [[nodiscard]] Nearest Find(const NearList& list, const Vec3& p, double offset,
                             std::uint32_t hint) const;

  /** False where the triangle's box is further from p than `distance`. */
  [[nodiscard]] bool MayReach(std::uint32_t triangle, const Vec3& p, double distance) const {
    return boxes_[triangle].CalcSquaredDistance(p) <= distance * distance;
  }

  /** False where no point within `radius` of c has, of the triangle's face, its closest point in
   the triangle. @param point  The triangle's closest point to c.
   @param limit  No point of the face that is further from c than this can be the closest. */
  [[nodiscard]] bool CanBeClosest(std::uint32_t triangle, const TrianglePoint& point, const Vec3& c,
                                  double radius, double limit) const;

  /** The distance with its sign: negative inside. */
  [[nodiscard]] Nearest FindSigned(const NearList& list, const Vec3& p, double offset,
                                   std::uint32_t hint) const;

  /** Finds that in a list that is sorted by IsNearer. */
  [[nodiscard]] Nearest FindSignedInSorted(const NearList& list, const Vec3& p, double offset,
                                           std::uint32_t hint) const;

 private:
  template <bool is_sorted>
  [[nodiscard]] Nearest FindIn(const NearList& list, const Vec3& p, double offset,
                               std::uint32_t hint) const;
  [[nodiscard]] Nearest GiveSign(const Vec3& p, Nearest nearest) const;

  // A box around a triangle: tells most that are too far away at a tenth of the exact distance's
  // cost.
  struct TriangleBox {
    double centre[3];
    double half[3];
    double radius;  // Of a sphere around it.

    [[nodiscard, gnu::always_inline]] double CalcSquaredDistance(const Vec3& p) const {
      const double x = std::max(std::abs(p.x() - centre[0]) - half[0], 0.0);
      const double y = std::max(std::abs(p.y() - centre[1]) - half[1], 0.0);
      const double z = std::max(std::abs(p.z() - centre[2]) - half[2], 0.0);
      return x * x + y * y + z * z;
    }
  };

  // How a triangle goes on in its face.
  struct Surroundings {
    double bend;  // Tangent of the largest angle to those it touches there; infinite: unknown.
    std::uint8_t rims;  // Bit k: edge k is on the face's rim.
  };

  void FindSurroundings();
  void FindRimBends();
  [[nodiscard]] bool CanRimBeClosest(std::uint32_t triangle, std::size_t k, const Vec3& c,
                                     double radius, double limit) const;

  const Mesh& mesh_;
  std::vector<TriangleBox> boxes_;
  std::vector<Surroundings> surroundings_;
  std::vector<double> rim_bend_;  // Of each vertex: tangent of a rim's turn; infinite: unknown.
};

/** The entry with the lowest bound. @pre the list is not empty. */
[[nodiscard]] NearTriangle LeastOf(const NearList& list);

}  // namespace hvas::contact
