#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/id.h"

/** What a drawing or an AP242 file states about the sizes and forms of a part, in SI. */
namespace hvas::product {

using FaceId = Id<struct FaceTag>;  ///< Index into Part::faces; also in product.h.

enum class DimensionKind { kDiameter, kRadius, kLinear, kAngular, kOther };

/** A dimension with its limits. Lengths in metres, angles in radians. */
struct Dimension {
  DimensionKind kind{DimensionKind::kOther};
  std::string name;                ///< What the file calls it: "diameter", "linear distance", ...
  double nominal{0};               ///< [m], or [rad] for kAngular.
  std::optional<double> upper;     ///< Upper deviation from the nominal, signed.
  std::optional<double> lower;     ///< Lower deviation from the nominal, signed.
  std::optional<std::string> fit;  ///< ISO 286: "G6" (capitals: hole), "g6", or "H7/g6".
  std::vector<FaceId> faces;       ///< Faces of the part that has the dimension; may be empty.
  std::string entity;              ///< Where it stands in the file: "#123".
};

enum class GeometricToleranceKind {
  kAngularity,
  kCircularRunout,
  kCoaxiality,
  kConcentricity,
  kCylindricity,
  kFlatness,
  kLineProfile,
  kParallelism,
  kPerpendicularity,
  kPosition,
  kRoundness,
  kStraightness,
  kSurfaceProfile,
  kSymmetry,
  kTotalRunout,
  kOther,
};

/** A tolerance of form, orientation, place or run-out. */
struct GeometricTolerance {
  GeometricToleranceKind kind{GeometricToleranceKind::kOther};
  std::string name;                 ///< What the file calls it.
  double magnitude{0};              ///< Width or diameter of the zone [m].
  std::vector<std::string> datums;  ///< Datums in order of precedence; "A-B" is a common datum.
  std::vector<FaceId> faces;        ///< Faces of the part that has the tolerance; may be empty.
  std::string entity;               ///< Where it stands in the file: "#123".
};

}  // namespace hvas::product
