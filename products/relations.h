#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Bnd_Box.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax1.hxx>
#include <gp_Pln.hxx>

#include "drawing.h"

namespace hvas::products {

/** How two placed parts touch, from their exact faces (no meshes): the truth for mate inference. */
struct DrawnMate {
  enum class Kind { kAxisHole, kFaceFace };

  Kind kind{Kind::kFaceFace};
  bool a_is_hole{true};      ///< Axis-hole: which of the two has the hole.
  double hole_diameter{0};   ///< Axis-hole.
  double shaft_diameter{0};  ///< Axis-hole.
  double overlap_length{0};  ///< Axis-hole: engaged length.
  double overlap_area{0};    ///< Face-face: area of the common face.
};

/** Answers for pairs of placed parts; the same pair of definitions in the same relative place is
 worked out once. Not for use by several threads. */
class Relations {
 public:
  /** Concentric cylinders of opposite sense (radial clearance 0 to 0.6 mm, engaged over 0.5 mm or
   more, going round by 200 degrees or more; one for each axis, the tightest), and coplanar opposed
   faces (1 mm^2 of common area or more; one for each plane). */
  const std::vector<DrawnMate>& FindMates(const PlacedPart& a, const PlacedPart& b);

  /** Volume that both fill [mm^3]. */
  double CalcCommonVolume(const PlacedPart& a, const PlacedPart& b);

  /** True where the exact boxes around both, as placed, share more than a face. */
  bool BoxesOverlap(const PlacedPart& a, const PlacedPart& b, double margin);

 private:
  struct CylinderFeature {
    gp_Ax1 axis;  ///< Location: the foot of the part's origin; direction: first sign positive.
    double radius{0};
    bool is_hole{false};
    double low{0}, high{0};
    std::vector<bool> turn;  ///< Degrees of the turn that the faces cover.
  };

  struct PlaneFeature {
    gp_Pln plane;  ///< Axis: outward normal.
    TopoDS_Face face;
    Bnd_Box box;
  };

  struct Features {
    std::vector<CylinderFeature> cylinders;
    std::vector<PlaneFeature> planes;
    Bnd_Box box;
  };

  const Features& FeaturesOf(const PartDefinition& part);
  static void AddCylinder(const TopoDS_Face& face, std::vector<CylinderFeature>& cylinders);
  /** Finds the mate of two cylinders on one line that engage; none where they do not. */
  static std::optional<DrawnMate> MatchPair(const CylinderFeature& ca, const CylinderFeature& cb,
                                            const gp_Trsf& X_AB);
  static std::vector<DrawnMate> MatchCylinders(const Features& a, const Features& b,
                                               const gp_Trsf& X_AB);
  static std::vector<DrawnMate> MatchPlanes(const Features& a, const Features& b,
                                            const gp_Trsf& X_AB);
  using Key = std::pair<std::pair<const PartDefinition*, const PartDefinition*>, std::string>;
  static Key MakeKey(const PlacedPart& a, const PlacedPart& b);

  std::map<const PartDefinition*, Features> features_;  // Looked up only, never walked.
  std::map<Key, std::vector<DrawnMate>> mates_;
  std::map<Key, double> common_volumes_;
};

}  // namespace hvas::products
