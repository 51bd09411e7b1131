#pragma once

#include <numbers>

/** Conversions between SI and the units of files, tables and people. Nothing else converts. */
namespace hvas::units {

// All three are exact; the inch by the agreement of 1959.
inline constexpr double kMetresPerMillimetre = 1e-3;
inline constexpr double kMetresPerMicrometre = 1e-6;
inline constexpr double kMetresPerInch = 0.0254;

constexpr double FromMm(double length_mm) {
  return length_mm * kMetresPerMillimetre;
}

constexpr double ToMm(double length) {
  return length / kMetresPerMillimetre;
}

constexpr double FromUm(double length_um) {
  return length_um * kMetresPerMicrometre;
}

constexpr double ToUm(double length) {
  return length / kMetresPerMicrometre;
}

constexpr double ToMm3(double volume) {
  return volume * 1e9;
}

constexpr double FromMm3(double volume_mm3) {
  return volume_mm3 * 1e-9;
}

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< A full turn [rad].

constexpr double FromDeg(double angle_deg) {
  return angle_deg * std::numbers::pi / 180.0;
}

constexpr double ToDeg(double angle) {
  return angle * 180.0 / std::numbers::pi;
}

constexpr double FromGpa(double stress_gpa) {
  return stress_gpa * 1e9;
}

constexpr double FromMpa(double stress_mpa) {
  return stress_mpa * 1e6;
}

constexpr double ToMpa(double stress) {
  return stress * 1e-6;
}

}  // namespace hvas::units
