#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "product/contact_pair.h"
#include "product/drawing_error.h"
#include "product/elastic_part.h"
#include "product/flexible.h"
#include "product/identity.h"
#include "product/ids.h"
#include "product/mate.h"
#include "product/relation.h"
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

struct Color {
  float r{0.7F}, g{0.7F}, b{0.72F};
};

struct Material {
  std::string name;                ///< What the file calls it; empty where it names none.
  double density{7850};            ///< [kg/m^3]
  bool is_assumed{true};           ///< True where the file gave no density, or an absurd one.
  std::string standard;            ///< Its row in fits::Materials(), which the rest is from.
  bool is_standard_assumed{true};  ///< True where no name in the file led to `standard`.
  double youngs_modulus{210e9};    ///< [Pa]
  double poisson_ratio{0.3};
  double yield_strength{235e6};     ///< Re, or Rp0.2 [Pa].
  double thermal_expansion{12e-6};  ///< [1/K]
};

struct MassProperties {
  double volume{0};              ///< [m^3]
  double mass{0};                ///< [kg]
  Vec3 p_BoBcm_B{Vec3::Zero()};  ///< Centre of mass in the part frame B [m].
  Mat3 I_BBcm_B{Mat3::Zero()};   ///< Inertia about the centre of mass [kg m^2].
};

/** Layer J, with its polygons (layer M) as a range of Part::mesh.triangles. */
struct Face {
  Surface surface;            ///< Stands in B. It is recognised also where the file has a B-spline.
  bool is_recognised{false};  ///< True where the file's surface was not analytic itself.
  double area{0};             ///< [m^2]
  Box box_B;
  std::uint32_t first_triangle{0};
  std::uint32_t triangle_count{0};
  std::optional<Color> color;
  std::uint64_t entity{0};  ///< Number in the STEP file; 0 where that is not known.
  double residual{
      0};  ///< Largest distance of a surface that was fitted to triangles or splines [m].
  std::uint32_t first_display_triangle{0};  ///< Index into Part::display_mesh.
  std::uint32_t display_triangle_count{0};
};

/** Triangles of a part, outward orientation, grouped by face. Vertices are not shared by faces. */
struct Mesh {
  std::vector<Vec3> vertices;                           ///< Coordinates in B [m].
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
};

/** What a mate can hold on to. Inward and outward as seen from the material: a hole, a conical seat
 (countersink) and a socket face inwards; a shaft, a taper and a ball outwards. */
enum class FeatureKind { kHole, kShaft, kPlane, kConeSeat, kTaper, kSocket, kBall };

[[nodiscard]] constexpr bool IsCylinder(FeatureKind kind) {
  return kind == FeatureKind::kHole || kind == FeatureKind::kShaft;
}

[[nodiscard]] constexpr bool IsCone(FeatureKind kind) {
  return kind == FeatureKind::kConeSeat || kind == FeatureKind::kTaper;
}

[[nodiscard]] constexpr bool IsSphere(FeatureKind kind) {
  return kind == FeatureKind::kSocket || kind == FeatureKind::kBall;
}

enum class ThreadKind {
  kNone,
  kNominal,   ///< A plain cylinder that stands for a thread, by the part's name and shape.
  kModelled,  ///< Helical faces are there.
};

/** Layer T: faces that act together. For holes, shafts and cones the axis and the axial span; for
 planes the outward normal and a point; for spheres the centre. */
struct Feature {
  FeatureKind kind{FeatureKind::kPlane};
  std::vector<FaceId> faces;
  Vec3 origin_B{Vec3::Zero()};  ///< A point of the axis, or the plane's area centroid; cone:
                                ///< its apex; sphere: its centre.
  Vec3 axis_B{Vec3::UnitZ()};   ///< Axis direction; plane: outward normal; cone: from the apex into
                                ///< the nappe in use.
  double radius{0};      ///< Radius of cylinder or sphere; cone: the largest in use; plane: 0 [m].
  double half_angle{0};  ///< Half angle of a cone [rad].
  double span_low{0};    ///< Extent along axis_B relative to origin_B [m]; 0 for planes.
  double span_high{0};
  double coverage{0};  ///< Angle of the full turn that the faces cover [rad].
  double area{0};      ///< [m^2]
  ThreadKind thread{ThreadKind::kNone};
  double thread_pitch{0};  ///< [m]; 0 where it is not known.
};

enum class FormKind {
  kThroughHole,
  kBlindHole,
  kSteppedHole,       ///< Holes of several diameters on one axis that follow each other.
  kCounterboredHole,  ///< A stepped hole whose wide end is a flat-bottomed seat for a head.
  kCountersunkHole,   ///< A hole that opens in a cone wide enough to seat a head.
  kBoss,              ///< A shaft that stands on a face of its part.
  kShaft,             ///< Shafts on one axis that follow each other, where the part is turned.
  kGroove,            ///< Around a shaft or in a bore, between two walls.
  kSlot,              ///< Two half cylinders and the flats between them, or two facing flats, open.
  kPocket,            ///< Walls around a floor.
  kSeat,              ///< A plane that other parts can sit on.
  kFillet,
  kChamfer,      ///< Also the lead-in of a hole or shaft.
  kHolePattern,  ///< Equal parallel holes, on a circle, in a row or in a grid.
};

/** What a machinist has a word for: features and faces of layer T that make a form together. */
struct Form {
  FormKind kind{FormKind::kSeat};
  std::vector<FeatureId> features;  ///< Which it is made of; hole patterns: the holes.
  std::vector<FaceId> faces;        ///< All of its faces.
  Vec3 origin_B{Vec3::Zero()};      ///< The axis's point at the entry; else the centre.
  Vec3 axis_B{Vec3::UnitZ()};       ///< Into the material for holes, slots, pockets; outward for
                                    ///< bosses and seats; patterns: along the holes.
  double diameter{
      0};  ///< Diameter of hole, boss or bolt circle; width of slot, fillet radius x 2 [m].
  double depth{0};    ///< Distance from the entry [m].
  double angle{0};    ///< Included, of countersink or chamfer [rad].
  int count{1};       ///< Steps of a stepped hole, holes of a pattern.
  double lead_in{0};  ///< Radial width of the chamfer or fillet at the entry [m]; 0: sharp.
};

enum class InnerConstraintKind { kParallel, kPerpendicular, kCoaxial, kCoplanar, kConcentric };

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
  bool has_brep{true};  ///< False where the file has triangles only.
  Box box_B;
  Mesh mesh;
  std::vector<Face> faces;
  Mesh display_mesh;  ///< Lighter, for the eye; grouped by face like `mesh`.
  std::vector<Feature> features;
  std::vector<Form> forms;
  std::vector<InnerConstraint> inner_constraints;
  std::vector<Dimension> dimensions;                     ///< Where the file states any.
  std::vector<GeometricTolerance> geometric_tolerances;  ///< Where the file states any.
  std::string shape_hash;  ///< Hash of faces and mesh; equal for equal geometry.
  Identity identity{};     ///< Where the file states any.
};

/** A node of the tree: the product itself (the root), or a subassembly. */
struct Subassembly {
  SubassemblyId id;
  SubassemblyId parent;  ///< Invalid for the root.
  std::string name;
  std::vector<SubassemblyId> subassemblies;
  std::vector<OccurrenceId> occurrences;  ///< Its direct parts.
  Identity identity{};                    ///< Where the file states any.
};

struct Occurrence {
  OccurrenceId id;
  PartId part;
  SubassemblyId parent;
  std::string name;  ///< UTF-8; not unique in general.
  std::string path;  ///< Names from the root, joined by '/', made unique by '#2', '#3', ...
  Pose X_WB;         ///< The assembled pose: as drawn, or where mates of the user put it.
  /** Paths that the bodies in it have in the file, where it is several (product/welded_units.h);
   else empty. */
  std::vector<std::string> bodies{};
};

/** All that ties two parts (X2, layer L): their mates, and what they leave free. */
struct Joint {
  OccurrenceId a;
  OccurrenceId b;
  std::vector<MateId> mates;
  int free_translations{0};  ///< Directions in which b can still move on a: 0..3.
  int free_rotations{0};     ///< 0..3
  /** Equal parallel axis-hole mates in it (a bolt circle, dowels); 0 where there is no such
   * pattern. */
  int pattern_count{0};
};

/** Two holes on one axis with nothing through both: a bolt is missing or hidden. No mate, a hint.
 */
struct Alignment {
  Connector a;
  Connector b;
};

/** What mates of the user have made of the drawn poses (X12, mates/place_by_mates.h). */
struct MatePlacement {
  std::vector<Pose> drawn_poses;  ///< Indexed by OccurrenceId; empty: all stay as drawn.
  Diagnostics diagnostics;        ///< What is found in the assembled poses in place of the drawn.
};

struct Product {
  std::string name;
  std::string source;  ///< File name without directories.
  std::vector<Part> parts;
  std::vector<Subassembly> subassemblies;  ///< [0] is the product.
  std::vector<Occurrence> occurrences;
  std::vector<Mate> mates;    ///< External constraints; empty until inferred.
  std::vector<Joint> joints;  ///< The mates by pairs of parts.
  std::vector<Alignment> alignments;
  Box box_W;
  std::vector<std::string> removed_mates;    ///< Keys that inference leaves out; not serialised.
  MatePlacement placement;                   ///< Not serialised: what is read is as drawn.
  FileHeader header{};                       ///< Where the file has one.
  std::vector<Relation> relations{};         ///< Stated by the user (docs/side-file.md).
  std::vector<ContactPair> contact_pairs{};  ///< Stated by the user.
  std::vector<FlexiblePart>
      flexible{};  ///< Parts that may give, or are stated to be rigid; not serialised.
  std::vector<ElasticPart> elastic{};          ///< Parts that push back; not serialised.
  std::vector<DrawingError> drawing_errors{};  ///< The largest volume first; not serialised.

  [[nodiscard]] const Part& part_of(OccurrenceId id) const {
    return parts[occurrences[id.index()].part.index()];
  }

  /** Levels of subassemblies above the deepest part, the product included: a flat product has 1. */
  [[nodiscard]] int depth() const;
  [[nodiscard]] double volume() const;  ///< Volume of all occurrences [m^3].
  [[nodiscard]] double mass() const;    ///< Mass of all occurrences [kg].
};

/** The faces of a side of a mate: those of its feature, and of the opposite one where it has one.
 */
[[nodiscard]] std::vector<FaceId> FacesOf(const Product& product, const Connector& side);

}  // namespace hvas::product
