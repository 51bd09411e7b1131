#pragma once

#include <span>
#include <string>

namespace hvas::fits {

/** A thread with a symmetric profile of 60 degrees: ISO metric (ISO 261, 262) or unified (ASME
 B1.1). All lengths in metres. */
struct Thread {
  std::string designation;   ///< "M8", "M8x1", "1/4-20 UNC".
  double diameter{0};        ///< d
  double pitch{0};           ///< P
  double tap_drill{0};       ///< ISO 2306; unified: 75 % of the thread.
  double clearance_fine{0};  ///< ISO 273, ASME B18.2.8; 0: none is given.
  double clearance_medium{0};
  double clearance_coarse{0};
  bool is_coarse{false};  ///< The coarse one of its size: coarse pitches of ISO 261, UNC.

  /** d2 = d - 0.649519 P (ISO 724). */
  [[nodiscard]] double pitch_diameter() const { return diameter - 0.649519 * pitch; }

  /** D1 = d - 1.082532 P (ISO 724): of the nut. */
  [[nodiscard]] double minor_diameter() const { return diameter - 1.082532 * pitch; }

  /** d3 = d - 1.226869 P (DIN 13-1): root of the screw. */
  [[nodiscard]] double core_diameter() const { return diameter - 1.226869 * pitch; }

  /** A_s = pi / 4 ((d2 + d3) / 2)^2 (ISO 898-1) [m^2]. */
  [[nodiscard]] double stress_area() const;
};

/** All threads: those of ISO 261, M1 to M68 coarse and M1 to M300 fine, and unified ones of #0 to
 1 1/2 in, coarse and fine. */
[[nodiscard]] std::span<const Thread> ListThreads();

/** The thread whose diameter lies within a fiftieth of a drawn one, and whose pitch is nearest to
 `pitch`, or the coarse one where `pitch` is 0 (none where the size has only fine ones); a metric
 one before a unified one that is as near. Null where there is none.
 @param diameter,pitch [m] */
[[nodiscard]] const Thread* FindThread(double diameter, double pitch);

/** The thread that a hole and a shaft are by their diameters: the shaft at its outer diameter, the
 hole at D1 (ISO 724), at the drill that leaves a pitch (d - P), at the tap drill (ISO 2306), or at
 the root of the screw, d3 (DIN 13-1); each within 20 um and 1.5 % of the pitch. The two diameters
 decide the pitch, so no name is needed. Of several the nearest; null where there is none.
 @param hole,shaft Drawn diameters [m]. */
[[nodiscard]] const Thread* FindThreadOfPair(double hole, double shaft);

/** What a hole is for a screw of a thread, by the diameter at which it is drawn. */
enum class ThreadHole {
  kUndersized,  ///< Below the core of the screw.
  kCore,        ///< Tapped, drawn at the core of the nut, or at its drill.
  kNominal,     ///< Tapped, drawn at the screw's diameter.
  kClearance,   ///< Lets the screw through (ISO 273, up to the coarse series).
  kWide,        ///< Has nothing to do with the screw.
};

/** @param hole Drawn diameter [m]. */
[[nodiscard]] ThreadHole ClassifyThreadHole(const Thread& thread, double hole);

/** Preload of a screw, and the torque that gives it. */
struct Tightening {
  double preload{0};  ///< [N]
  double torque{0};   ///< [N m]
};

/** Tightening to 90 % of the yield point by the short formula of VDI 2230-1:
 F_M = 0.9 R A_s / sqrt(1 + 3 (3/2 d2/d0 (P / (pi d2) + 1.155 mu_G))^2), d0 = (d2 + d3) / 2,
 M_A = F_M (0.16 P + 0.58 d2 mu_G + D_K / 2 mu_K).
 @param yield_stress R_p0.2 of the screw [Pa].
 @param mu_thread,mu_head Coefficients of friction in the thread and under the head.
 @param head_diameter D_K, mean diameter of the contact under the head [m]. */
[[nodiscard]] Tightening CalcTightening(const Thread& thread, double yield_stress, double mu_thread,
                                        double mu_head, double head_diameter);

/** Axial play between the flanks of a thread with tolerances 6H/6g in the middle of their zones
 [m]: the play of the pitch diameters times tan 30 deg. Tolerances by the formulas of ISO 965-1,
 with P and d in mm: es = -(15 + 11 P) um, T_d2(6) = 90 P^0.4 d^0.1 um, T_D2(6) = 1.32 T_d2(6).
 Unified threads of class 2A/2B have about the same. */
[[nodiscard]] double CalcMeanFlankPlay(const Thread& thread);

/** Stiffness along the axis of a steel screw together with what it clamps [N/m]. The screw by VDI
 2230-1: half a diameter of the head, all of the clamped length as threaded, half a diameter of the
 engaged thread and 0.4 of the nut. Clamped steel as two cones of 30 deg from a head of 1.5
 diameters (Shigley's Mechanical Engineering Design, equation 8-22):

   k = 0.5774 pi E d / (2 ln(5 (0.5774 l + 0.5 d) / (0.5774 l + 2.5 d))).

 @param clamped  l, from the head to the first turn that is engaged [m]; > 0. */
[[nodiscard]] double CalcJointStiffness(const Thread& thread, double clamped);

}  // namespace hvas::fits
