#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "contact/helix.h"

namespace hvas::contact {

/** A point in the plane through the axis of a helix to which it is turned along the helix. */
struct HelixPlace {
  double z{0};       ///< Along the axis at azimuth zero, not reduced to a pitch [m].
  double r{0};       ///< Distance from the axis [m].
  double height{0};  ///< Along the axis where it is [m].
};

[[nodiscard]] HelixPlace PlaceOf(const Helix& helix, const Vec3& p);

/** A height along the profile, from 0 to less than a pitch [m]. */
[[nodiscard]] double ReducedToPitch(double z, double pitch);

/** The profile of a thread by heights in equal steps: what the edges of the mesh draw between two
 heights. Chords of a mesh are nearer to the axis than its vertices, so the furthest counts. */
class HelixProfile {
 public:
  explicit HelixProfile(double pitch);

  void AddEdge(const HelixPlace& a, const HelixPlace& b);

  /** False where the edges leave a part of the pitch out. */
  [[nodiscard]] bool is_whole() const;

  /** Makes the corners between which the profile is straight within a tolerance [m]. */
  [[nodiscard]] std::vector<HelixCorner> MakeCorners(double tolerance) const;

 private:
  using Vec2 = Eigen::Vector2d;  ///< Along the axis and away from it.

  static constexpr std::size_t kSteps = 512;  ///< A choice: 2.4 um of an M8.

  void Raise(long i, double r);
  [[nodiscard]] Vec2 At(std::size_t i) const;
  /** Douglas and Peucker's division; keeps the first one and what is between. */
  void Divide(std::size_t from, std::size_t to, double tolerance,
              std::vector<std::size_t>* kept) const;
  /** Takes the corner out that was where the division began, if it is none. */
  void DropStraight(std::size_t step, double tolerance, std::vector<std::size_t>* kept) const;
  /** Corners where the sides' best lines meet, rather than at one of the equal steps. */
  [[nodiscard]] std::vector<HelixCorner> Sharpen(const std::vector<std::size_t>& kept) const;
  [[nodiscard]] Vec2 Meet(std::size_t before, std::size_t corner, std::size_t behind) const;
  /** A point and the direction of the best line through steps. */
  [[nodiscard]] std::pair<Vec2, Vec2> FitLine(std::size_t from, std::size_t to) const;

  double pitch_;
  std::vector<double> radius_;
};

}  // namespace hvas::contact
