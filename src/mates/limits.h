#pragma once

#include <algorithm>

namespace hvas::mates {

/** Limits of the search. Lengths hold for parts between 5 mm and 1 m; for smaller and larger ones
 they scale with the smaller part of the pair, so a model drawn in wrong units still has its mates.
 */
struct InferenceLimits {
  double angle{1.745329252e-3};  ///< Deviation of axes and normals from parallel (0.1 deg) [rad].
  double axis_distance{20e-6};   ///< Distance of two axes or centres that are taken as one [m].
  double radius_difference{0.6e-3};  ///< Difference of hole and shaft, socket and ball [m], or the
                                     ///< second of the next ones, if more.
  double least_radius_share{0.5};    ///< What the difference above may be of a small radius.
  double radius_ratio{0.3};          ///< Difference of any radii, as a part of the radius.
  double axial_overlap{50e-6};       ///< Least engaged length [m].
  double coverage{3.4906585};        ///< Least turn that one face of a hole covers (200 deg) [rad].
  double plane_gap{10e-6};           ///< Gap of faces that touch, also as overlap [m].
  double area_ratio{0.01};           ///< Least overlap as a part of the smaller face.
  double area{0.05e-6};              ///< Least overlap [m^2].
  double cone_angle{1.745329252e-2};  ///< Difference of the half angles of two cones (1 deg) [rad].
  double cone_gap{0.25e-3};           ///< Gap of cones, normal to them, also as overlap [m].
  double wall_gap{0.3e-3};       ///< Gap of faces that hold a part between them, on one side [m].
  double wall_area_ratio{0.05};  ///< Least overlap of these, as a part of the smaller face.
  double near_gap{0.12e-3};  ///< Faces that nearly touch, or overlap, are reported this far [m].
  bool reuse_equal_pairs{true};  ///< Look only once at pairs of equal parts that lie equally.
};

/** What the lengths are multiplied by for a part of this size: one between 5 mm and 1 m. */
[[nodiscard]] inline double CalcLengthScale(double size) {
  // The limits were measured on parts between these sizes [m] (docs/algorithms/mates.md).
  constexpr double kSmall = 5e-3;
  constexpr double kLarge = 1.0;
  return size < kSmall ? size / kSmall : std::max(1.0, size / kLarge);
}

/** The largest difference of radii of hole and shaft, or socket and ball. Screws of 1 mm and more
 in coarse clearance holes of ISO 273 have less; a pin of 1 mm in a hole of 2 mm has more. */
[[nodiscard]] inline double CalcLargestPlay(const InferenceLimits& limits, double scale,
                                            double smaller_radius) {
  return std::max(
      std::min(limits.radius_difference * scale, limits.least_radius_share * smaller_radius),
      limits.radius_ratio * smaller_radius);
}

}  // namespace hvas::mates
