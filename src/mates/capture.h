#pragma once

#include "product/mate.h"

/** Recognition of mates while moving (X8, W7): how far two sides of a mate are from each other, and
 whether that is near enough to be captured. All functions are RT-safe.

 An axis-hole mate is recognised in its drawn sense only: a shaft that comes with its other end
 first does not match. Where both senses are right the part has to be held the drawn way round. */
namespace hvas::mates {

/** What recognition needs to know of a mate, from the side that is held. */
struct CaptureMate {
  product::MateKind kind{product::MateKind::kFaceFace};
  double placed_low{0},
      placed_high{0};                ///< Span of the placed side along its way [m]; 0 for planes.
  double held_low{0}, held_high{0};  ///< Span of the held side along its way [m]; 0 for planes.
  double reach{0};  ///< Planes: radius of a disc as large as the drawn overlap; prismatic: the
                    ///< breadth of the contact [m].
};

/** The mate as seen with `held` in the hand: a hole may be held over its shaft, or a shaft in front
 of its hole. @pre held is one of its two occurrences. */
[[nodiscard]] CaptureMate MakeCaptureMate(const product::Mate& mate, product::OccurrenceId held);

/** Distances between the sides of a mate, all >= 0. */
struct MateDeviation {
  double angle{0};  ///< Angle of the axes, or of one normal and the other's opposite: X(7) [rad].
  double distance{0};  ///< Distance of the axes where they meet, X(8), or of the planes [m];
                       ///< prismatic: also that along y by which the walls miss each other.
  double gap{0};       ///< Gap of the spans along the axis, 0 when they overlap; or in the plane,
                       ///< 0 while the face's centre is within the reach of the other's [m].
};

/** @param X_WM  Connector of the placed side. @param X_WN  Connector of the held side. Axis-hole,
 cone seat and prismatic: both z axes point the same way when assembled; face-face: they oppose each
 other. The spans of axis-hole mates are along z, those of prismatic ones along x. A
 sphere seat has a distance only, that of the centres.

 The axes' distance is that of the held axis from the placed one, at the end of the held span that
 faces the placed span, or at the middle of what they share. */
[[nodiscard]] MateDeviation CalcDeviation(const CaptureMate& mate, const spatial::Pose& X_WM,
                                          const spatial::Pose& X_WN) noexcept;

/** When a mate is captured. Defaults: W7. */
struct CaptureThresholds {
  double angle{0.17453292519943295};  ///< 10 deg [rad].
  double axis_distance{5e-3};         ///< Also of centres [m].
  double axial_gap{30e-3};            ///< Gap before the shaft's end; the papers set no limit [m].
  double face_distance{3e-3};         ///< [m]
  double in_plane_gap{5e-3};          ///< [m]
  double release_ratio{1.5};  ///< A captured mate is released beyond this multiple of them, >= 1.
};

/** True where a mate with this deviation is captured, given whether it was until now: the larger
 limits of release keep it from flickering. */
[[nodiscard]] bool IsCaptured(product::MateKind kind, const MateDeviation& deviation,
                              bool was_captured, const CaptureThresholds& thresholds) noexcept;

/** How near a mate is, for choosing among several: the largest deviation as a part of its limit;
 captured at 1 or less. */
[[nodiscard]] double CalcCaptureRatio(product::MateKind kind, const MateDeviation& deviation,
                                      const CaptureThresholds& thresholds) noexcept;

}  // namespace hvas::mates
