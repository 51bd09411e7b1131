#include "product/names.h"

#include <array>
#include <cstddef>

#include "base/check.h"

namespace hvas {
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

namespace spatial {

const char* ToString(SurfaceKind kind) {
  constexpr std::array kNames{"plane", "cylinder", "cone", "sphere", "torus", "freeform"};
  return NameOf(kNames, kind);
}

}  // namespace spatial

namespace product {

const char* ToString(FeatureKind kind) {
  constexpr std::array kNames{"hole", "shaft", "plane", "cone_seat", "taper", "socket", "ball"};
  return NameOf(kNames, kind);
}

const char* ToString(FormKind kind) {
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

const char* ToString(ThreadKind kind) {
  constexpr std::array kNames{"none", "nominal", "modelled"};
  return NameOf(kNames, kind);
}

const char* ToString(InnerConstraintKind kind) {
  constexpr std::array kNames{"parallel", "perpendicular", "coaxial", "coplanar", "concentric"};
  return NameOf(kNames, kind);
}

namespace {

/** A null pointer for a number that is no kind. */
constexpr const char* FindMateKindName(MateKind kind) {
  switch (kind) {
    case MateKind::kAxisHole:
      return "axis_hole";
    case MateKind::kFaceFace:
      return "face_face";
    case MateKind::kConeSeat:
      return "cone_seat";
    case MateKind::kSphereSeat:
      return "sphere_seat";
    case MateKind::kPrismatic:
      return "prismatic";
  }
  return nullptr;
}

static_assert(FindMateKindName(kMateKinds.back()) != nullptr &&
                  FindMateKindName(static_cast<MateKind>(kMateKinds.size())) == nullptr,
              "kMateKinds has to list every kind of mate");

}  // namespace

const char* ToString(MateKind kind) {
  const char* const name = FindMateKindName(kind);
  HVAS_DEMAND(name != nullptr);
  return name;
}

const char* ToString(MateOrigin origin) {
  constexpr std::array kNames{"inferred", "user"};
  return NameOf(kNames, origin);
}

const char* ToString(SurfaceConstraintKind kind) {
  constexpr std::array kNames{"coaxial", "coplanar", "same_cone", "concentric"};
  return NameOf(kNames, kind);
}

const char* ToString(FitKind kind) {
  constexpr std::array kNames{"clearance", "transition", "interference",
                              "thread",    "insert",     "passage"};
  return NameOf(kNames, kind);
}

const char* ToString(DimensionKind kind) {
  constexpr std::array kNames{"diameter", "radius", "linear", "angular", "other"};
  return NameOf(kNames, kind);
}

const char* ToString(GeometricToleranceKind kind) {
  constexpr std::array kNames{
      "angularity",       "circular_runout", "coaxiality",   "concentricity",
      "cylindricity",     "flatness",        "line_profile", "parallelism",
      "perpendicularity", "position",        "roundness",    "straightness",
      "surface_profile",  "symmetry",        "total_runout", "other"};
  return NameOf(kNames, kind);
}

}  // namespace product
}  // namespace hvas
