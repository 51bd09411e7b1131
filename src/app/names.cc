#include "app/names.h"

#include <array>
#include <cstddef>

#include "mates/side_file.h"

namespace hvas::app {
namespace {

/** Names in the order of the enumerators. */
template <std::size_t kCount, typename Kind>
const char* NameOf(const std::array<const char*, kCount>& names, Kind kind) {
  return names.at(static_cast<std::size_t>(kind));
}

}  // namespace

const char* ToString(Severity severity) {
  constexpr std::array kNames{"note", "warning", "error"};
  return NameOf(kNames, severity);
}

const char* ToString(spatial::SurfaceKind kind) {
  constexpr std::array kNames{"plane", "cylinder", "cone", "sphere", "torus", "freeform"};
  return NameOf(kNames, kind);
}

const char* ToString(product::FeatureKind kind) {
  constexpr std::array kNames{"hole", "shaft", "plane", "cone_seat", "taper", "socket", "ball"};
  return NameOf(kNames, kind);
}

const char* ToString(product::FormKind kind) {
  constexpr std::array kNames{"through_hole",
                              "blind_hole",
                              "stepped_hole",
                              "counterbored_hole",
                              "countersunk_hole",
                              "boss",
                              "shaft",
                              "groove",
                              "slot",
                              "pocket",
                              "seat",
                              "fillet",
                              "chamfer",
                              "hole_pattern"};
  return NameOf(kNames, kind);
}

const char* ToString(product::ThreadKind kind) {
  constexpr std::array kNames{"none", "nominal", "modelled"};
  return NameOf(kNames, kind);
}

const char* ToString(product::InnerConstraintKind kind) {
  constexpr std::array kNames{"parallel", "perpendicular", "coaxial", "coplanar", "concentric"};
  return NameOf(kNames, kind);
}

const char* ToString(product::MateKind kind) {
  return mates::ToString(kind);
}

const char* ToString(product::MateOrigin origin) {
  constexpr std::array kNames{"inferred", "user"};
  return NameOf(kNames, origin);
}

const char* ToString(product::SurfaceConstraintKind kind) {
  constexpr std::array kNames{"coaxial", "coplanar", "same_cone", "concentric"};
  return NameOf(kNames, kind);
}

const char* ToString(product::FitKind kind) {
  constexpr std::array kNames{"clearance", "transition", "interference", "thread"};
  return NameOf(kNames, kind);
}

const char* ToString(product::DimensionKind kind) {
  constexpr std::array kNames{"diameter", "radius", "linear", "angular", "other"};
  return NameOf(kNames, kind);
}

const char* ToString(product::GeometricToleranceKind kind) {
  constexpr std::array kNames{
      "angularity",       "circular_runout", "coaxiality",   "concentricity",
      "cylindricity",     "flatness",        "line_profile", "parallelism",
      "perpendicularity", "position",        "roundness",    "straightness",
      "surface_profile",  "symmetry",        "total_runout", "other"};
  return NameOf(kNames, kind);
}

}  // namespace hvas::app
