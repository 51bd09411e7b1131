#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/id.h"
#include "product/tolerance.h"
#include "spatial/box.h"
#include "spatial/pose.h"
#include "spatial/surface.h"

/** The hierarchical constraint-based data model of paper X (section 3, X2): product Z, subassembly
 B, part L, feature T, surface J, polygon M, as immutable values in SI.

 Elements of neighbouring layers are tied by membership (the mappings H); elements of one layer by
 constraints C: inner ones hold a part's shape, external ones (mates) are the assembly relations. */
namespace hvas::product {

using spatial::Box;
using spatial::Pose;
using spatial::Surface;
using spatial::SurfaceKind;

using SubassemblyId = Id<struct SubassemblyTag>;
using PartId = Id<struct PartTag>;              ///< A shape; shared by its occurrences.
using OccurrenceId = Id<struct OccurrenceTag>;  ///< A part at a place.
using FeatureId = Id<struct FeatureTag>;        ///< Index into Part::features.
using FaceId = Id<struct FaceTag>;              ///< Index into Part::faces (layer J).
using MateId = Id<struct MateTag>;

struct Color {
  float r{0.7F}, g{0.7F}, b{0.72F};
};

struct Material {
  std::string name;
  double density{7850};   ///< [kg/m^3]
  bool is_assumed{true};  ///< True where the file gave none, or an absurd one.
};

struct MassProperties {
  double volume{0};              ///< [m^3]
  double mass{0};                ///< [kg]
  Vec3 p_BoBcm_B{Vec3::Zero()};  ///< Centre of mass in the part frame B [m].
  Mat3 I_BBcm_B{Mat3::Zero()};   ///< Inertia about the centre of mass [kg m^2].
};

/** Layer J, with its polygons (layer M) as a range of Part::mesh.triangles. */
struct Face {
  Surface surface;            ///< In B. Recognised also where the file has a B-spline.
  bool is_recognised{false};  ///< True where the file's surface was not analytic itself.
  double area{0};             ///< [m^2]
  Box box_B;
  std::uint32_t first_triangle{0};
  std::uint32_t triangle_count{0};
  std::optional<Color> color;
  std::uint64_t entity{0};  ///< Number in the STEP file; 0 where that is not known.
};

/** Triangles of a part, outward orientation, grouped by face. Vertices are not shared by faces. */
struct Mesh {
  std::vector<Vec3> vertices;                           ///< In B [m].
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

enum class FeatureKind { kHole, kShaft, kPlane };

/** Layer T: faces that act together. For holes and shafts the axis and the axial span; for planes
 the outward normal and a point. */
struct Feature {
  FeatureKind kind{FeatureKind::kPlane};
  std::vector<FaceId> faces;
  Vec3 origin_B{Vec3::Zero()};  ///< On the axis (any point), or on the plane (area centroid).
  Vec3 axis_B{Vec3::UnitZ()};   ///< Axis direction, or outward normal.
  double radius{0};             ///< [m]; 0 for planes.
  double span_low{0};           ///< Extent along axis_B relative to origin_B [m]; 0 for planes.
  double span_high{0};
  double coverage{0};  ///< Angle of the full turn that the faces cover [rad].
  double area{0};      ///< [m^2]
};

enum class InnerConstraintKind { kParallel, kPerpendicular, kCoaxial, kCoplanar };

/** Constraint between two features of one part; holds the part's shape (X2). */
struct InnerConstraint {
  InnerConstraintKind kind{InnerConstraintKind::kParallel};
  FeatureId a;
  FeatureId b;
};

struct Part {
  PartId id;
  std::string name;  ///< UTF-8.
  Color color;
  Material material;
  MassProperties mass;
  int solid_count{0};
  Box box_B;
  Mesh mesh;
  std::vector<Face> faces;
  std::vector<Feature> features;
  std::vector<InnerConstraint> inner_constraints;
  std::vector<Dimension> dimensions;                     ///< Where the file states any.
  std::vector<GeometricTolerance> geometric_tolerances;  ///< Where the file states any.
  std::string shape_hash;  ///< Of faces and mesh; equal for equal geometry.
};

/** A node of the tree: the product itself (the root), or a subassembly. */
struct Subassembly {
  SubassemblyId id;
  SubassemblyId parent;  ///< Invalid for the root.
  std::string name;
  std::vector<SubassemblyId> subassemblies;
  std::vector<OccurrenceId> occurrences;  ///< Its direct parts.
};

struct Occurrence {
  OccurrenceId id;
  PartId part;
  SubassemblyId parent;
  std::string name;  ///< UTF-8; not unique in general.
  std::string path;  ///< Names from the root, joined by '/', made unique by '#2', '#3', ...
  Pose X_WB;         ///< The assembled pose, as drawn.
};

enum class MateKind { kAxisHole, kFaceFace };

/** How the faces of an axis-hole mate answer to each other. */
enum class FitKind { kClearance, kTransition, kInterference, kThread };

/** A fit on an axis-hole mate. `code` is an ISO 286 code such as "H7/g6"; empty for threads. */
struct Fit {
  FitKind kind{FitKind::kClearance};
  std::string code;
  double nominal_diameter{0};  ///< [m]
  bool is_proposed{true};      ///< False where the file, a side file or the user says so.
  std::string reason;          ///< Why this fit, in a few words.
};

/** One side of a mate: the feature and its frame in the part. z is the axis direction (holes and
 shafts; both sides point the same way in the assembled pose) or the outward normal (planes; the two
 sides oppose each other). */
struct Connector {
  OccurrenceId occurrence;
  FeatureId feature;
  Pose X_BM;
};

/** An external constraint between two parts (X2), found in the assembled pose or given by the user.

 Axis-hole: `a` is the hole, `b` the shaft; both frames have their origin at the same world point
 on the axis in the assembled pose, and spans along z from there. Face-face: both frames have
 their origin at the centre of the overlap. */
struct Mate {
  MateId id;
  MateKind kind{MateKind::kFaceFace};
  Connector a;
  Connector b;
  double hole_low{0}, hole_high{0};    ///< Axial span of the hole [m]; 0 for planes.
  double shaft_low{0}, shaft_high{0};  ///< Axial span of the shaft, assembled [m].
  double hole_radius{0}, shaft_radius{0};
  double overlap{0};       ///< Engaged length [m], or overlapping area [m^2].
  std::optional<Fit> fit;  ///< Axis-hole only.
};

struct Product {
  std::string name;
  std::string source;  ///< File name without directories.
  std::vector<Part> parts;
  std::vector<Subassembly> subassemblies;  ///< [0] is the product.
  std::vector<Occurrence> occurrences;
  std::vector<Mate> mates;  ///< External constraints; empty until inferred.
  Box box_W;

  [[nodiscard]] const Part& part_of(OccurrenceId id) const {
    return parts[occurrences[id.index()].part.index()];
  }

  /** Levels of subassemblies above the deepest part, the product included: a flat product has 1. */
  [[nodiscard]] int depth() const;
  [[nodiscard]] double volume() const;  ///< Of all occurrences [m^3].
  [[nodiscard]] double mass() const;    ///< Of all occurrences [kg].
};

}  // namespace hvas::product
