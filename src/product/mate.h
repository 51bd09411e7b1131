#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "product/ids.h"
#include "spatial/pose.h"

/** Mates: the external constraints between two parts (X2), with their fits. */
namespace hvas::product {

using spatial::Pose;

enum class MateKind { kAxisHole, kFaceFace, kConeSeat, kSphereSeat, kPrismatic };

/** All kinds of mates, in the order of their numbers. */
inline constexpr std::array kMateKinds{MateKind::kAxisHole, MateKind::kFaceFace,
                                       MateKind::kConeSeat, MateKind::kSphereSeat,
                                       MateKind::kPrismatic};

/** How the faces of an axis-hole or prismatic mate answer to each other. */
enum class FitKind {
  kClearance,
  kTransition,
  kInterference,
  kThread,
  kInsert,   ///< Melted, pressed or drawn in, or held by its spring: no fit of ISO 286.
  kPassage,  ///< A shaft that goes through with more play than any fit of ISO 286 has.
};

/** Whether ISO 286 has fits of this kind. */
[[nodiscard]] constexpr bool IsIsoFit(FitKind kind) {
  return kind <= FitKind::kInterference;
}

/** A fit on an axis-hole or prismatic mate. `code` is an ISO 286 code such as "H7/g6"; empty for
 other kinds. */
struct Fit {
  FitKind kind{FitKind::kClearance};
  std::string code;
  double nominal_diameter{0};  ///< Diameter, or width of a prismatic mate [m].
  bool is_proposed{true};      ///< False where the file, a side file or the user says so.
  std::string reason;          ///< Why this fit, in a few words.
};

/** A diameter, or width of a prismatic mate, that was measured at one place along a mate. */
struct MeasuredDiameter {
  double depth{0};     ///< Depth from the mouth of the hole, parts in their place [m].
  double diameter{0};  ///< Diameter or width [m].
};

/** What somebody measured or knows about one mate, over what the fit would have drawn or looked up.
 */
struct FitConditions {
  /** Diameters measured at 20 C, by ascending depth; empty: not measured. One stands for the whole
   length. */
  std::vector<MeasuredDiameter> hole_diameters, shaft_diameters;
  std::optional<double> hole_roughness, shaft_roughness;          ///< Rz [m].
  std::optional<double> friction;                                 ///< Coulomb coefficient.
  std::optional<double> hole_temperature_c, shaft_temperature_c;  ///< [deg C]
};

/** One side of a mate: the feature and its frame in the part. z is the axis direction (holes and
 shafts; both sides point the same way in the assembled pose) or the outward normal (planes; the two
 sides oppose each other). */
struct Connector {
  OccurrenceId occurrence;
  FeatureId feature;
  Pose X_BM;
  FeatureId opposite{};  ///< Prismatic: the plane that opposes `feature`; else invalid.
};

enum class SurfaceConstraintKind { kCoaxial, kCoplanar, kSameCone, kConcentric };

/** What a mate asks of two faces (X2, layer J). */
struct SurfaceConstraint {
  SurfaceConstraintKind kind{SurfaceConstraintKind::kCoplanar};
  FaceId a;  ///< A face of the part of Mate::a.
  FaceId b;
};

enum class MateOrigin { kInferred, kUser };

/** An external constraint between two parts (X2), found in the assembled pose or given by the user.

 Axis-hole: `a` is the hole, `b` the shaft; both frames have their origin at the same world point
 on the axis in the assembled pose, and spans along z from there. Face-face: both frames have
 their origin at the centre of the overlap. Cone seat: `a` is the seat, `b` the taper; frames at the
 middle of the contact, on the axis. Sphere seat: `a` is the socket; frames at the centre.
 Prismatic: `a` has the slot, `b` the tongue between its walls; both frames have their origin in the
 middle of the slot, z across from the first wall to the opposite one, x the way out of the tongue,
 and spans along x from there. */
struct Mate {
  MateId id;        ///< Its index in Product::mates.
  std::string key;  ///< 10 hex digits of what it ties; the same however many other mates there are.
  MateKind kind{MateKind::kFaceFace};
  Connector a;
  Connector b;
  double hole_low{0}, hole_high{0};        ///< Axial span of the hole or slot [m]; 0 for planes.
  double shaft_low{0}, shaft_high{0};      ///< Axial span of the shaft or tongue, assembled [m].
  double hole_radius{0}, shaft_radius{0};  ///< Prismatic: half the widths of slot and tongue [m].
  double overlap{0};                       ///< Engaged length [m], or overlapping area [m^2].
  double breadth{0};       ///< Prismatic: extent of the contact across the way, in the wall [m].
  std::optional<Fit> fit;  ///< Axis-hole and prismatic only.
  FitConditions conditions;
  std::vector<SurfaceConstraint> surfaces;
  MateOrigin origin{MateOrigin::kInferred};
  double confidence{1};  ///< 0..1; how sure it is that this pair is meant to be mated.
  std::string evidence;  ///< What it was inferred from, in a few words.

  [[nodiscard]] bool Joins(OccurrenceId x, OccurrenceId y) const {
    return (a.occurrence == x && b.occurrence == y) || (a.occurrence == y && b.occurrence == x);
  }
};

}  // namespace hvas::product
