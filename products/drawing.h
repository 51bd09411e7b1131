#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "solid.h"

/** An example product as drawn: definitions, their places, and what is known about it by design. */
namespace hvas::products {

struct Material {
  std::string name;
  double density_kg_m3{0};
};

struct Rgb {
  double r{0}, g{0}, b{0};  ///< 0 to 1, linear.
};

struct PartDefinition {
  std::string name;
  Solid solid;
  Material material;
  Rgb color;
};

/** A list of placed parts and subassemblies, itself placed any number of times. */
struct AssemblyDefinition {
  struct Child {
    std::string name;
    const PartDefinition* part{nullptr};  ///< Exactly one of the two is given.
    const AssemblyDefinition* assembly{nullptr};
    gp_Trsf X_AC;  ///< Child in this assembly.
  };

  std::string name;
  std::vector<Child> children;

  void Add(const std::string& child_name, const PartDefinition& part, const gp_Trsf& X_AC = {}) {
    children.push_back({child_name, &part, nullptr, X_AC});
  }

  void Add(const std::string& child_name, const AssemblyDefinition& assembly,
           const gp_Trsf& X_AC = {}) {
    children.push_back({child_name, nullptr, &assembly, X_AC});
  }
};

/** A fit given by design. Names are those of the occurrences; in a product with repeated
 subassemblies the pair of names stands for every such pair that mates. */
struct DrawnFit {
  std::string hole;
  std::string shaft;
  double diameter_mm{0};
  std::string code;  ///< ISO 286, or "thread".
};

/** One step of the order that the designer has in mind: the part comes along `direction`. */
struct AssemblyStep {
  std::string occurrence;
  std::array<int, 3> direction{0, 0, -1};
};

/** A surface of a placed part, given in the part. */
struct DrawnSurface {
  std::string occurrence;
  std::array<double, 3> point_mm{};  ///< A point of the plane, or of the axis beside the face.
  std::array<double, 3> axis{};      ///< Outward normal of a plane.
  double diameter_mm{0};             ///< 0: a plane.
};

/** A mate that the side file states. */
struct DrawnUserMate {
  DrawnSurface a, b;
  std::string fit;  ///< ISO 286, "thread", or empty.
};

struct Drawing {
  std::string name;
  std::deque<PartDefinition> parts;           ///< Deques, for references that stay.
  std::deque<AssemblyDefinition> assemblies;  ///< The first is the product.
  std::vector<DrawnFit> fits;
  std::vector<AssemblyStep> order;   ///< Empty: no order by name given.
  std::vector<DrawnUserMate> mates;  ///< Where the file says nothing about places.
  std::vector<gp_Trsf> assembled;    ///< Then places by design, of the children of a flat product.

  PartDefinition& AddPart(const std::string& part_name, const Solid& solid,
                          const Material& material, const Rgb& color) {
    return parts.emplace_back(PartDefinition{part_name, solid, material, color});
  }

  AssemblyDefinition& AddAssembly(const std::string& assembly_name) {
    return assemblies.emplace_back(AssemblyDefinition{assembly_name, {}});
  }
};

/** A part at its place in the product. */
struct PlacedPart {
  std::string name;
  std::string path;  ///< Names below the root, joined by '/'.
  const PartDefinition* part{nullptr};
  gp_Trsf X_WB;
};

/** All leaves of the tree, depth first in the order drawn. */
[[nodiscard]] std::vector<PlacedPart> Flatten(const Drawing& drawing);

/** Levels of subassemblies above the deepest part, the product included: a flat product has 1. */
[[nodiscard]] int CalcDepth(const Drawing& drawing);

/** Writes AP242 STEP in millimetres: names, colours, materials. The same drawing gives the same
 bytes. Throws std::runtime_error when the file cannot be written. */
void WriteStep(const Drawing& drawing, const std::string& path);

[[nodiscard]] Drawing DrawBushing();
/** Three sets of shaft and bushing, all of steel, side by side in one block with three seats. */
[[nodiscard]] Drawing DrawFitRig();
[[nodiscard]] Drawing DrawGearPump();
[[nodiscard]] Drawing DrawFrame500();
/** Twelve parts in arbitrary poses, with mates that say how they go together. */
[[nodiscard]] Drawing DrawLooseTwelve();
/** Parts that give: an O-ring, a retaining ring and a cover with two snap hooks. */
[[nodiscard]] Drawing DrawSnapJoint();
/** A block with a blind bore of 20 mm, and a peg: what policies that learn begin with. */
[[nodiscard]] Drawing DrawPegHole();
/** A screw of 8 mm in a plate, and its nut. */
[[nodiscard]] Drawing DrawNutBolt();

namespace materials {
inline const Material kSteel{"Steel C45", 7850};
inline const Material kCaseSteel{"Steel 16MnCr5", 7850};
inline const Material kBoltSteel{"Steel 8.8", 7850};
inline const Material kSpringSteel{"Spring steel", 7850};
inline const Material kCastIron{"Cast iron EN-GJL-250", 7200};
inline const Material kBronze{"Bronze CuSn8", 8800};
inline const Material kBrass{"Brass CuZn39Pb3", 8470};
inline const Material kCopper{"Copper", 8960};
inline const Material kRubber{"NBR", 1200};
inline const Material kAbs{"ABS", 1050};
inline const Material kAluminium{"Aluminium EN AW-6082", 2700};
}  // namespace materials

namespace colors {
inline const Rgb kSteel{0.62, 0.64, 0.68};
inline const Rgb kDarkSteel{0.20, 0.20, 0.22};
inline const Rgb kCastIron{0.25, 0.38, 0.48};
inline const Rgb kCover{0.33, 0.47, 0.57};
inline const Rgb kBronze{0.72, 0.45, 0.20};
inline const Rgb kBrass{0.80, 0.66, 0.27};
inline const Rgb kCopper{0.78, 0.40, 0.25};
inline const Rgb kRubber{0.08, 0.08, 0.08};
inline const Rgb kGear{0.55, 0.57, 0.52};
inline const Rgb kAluminium{0.80, 0.82, 0.84};
inline const Rgb kRed{0.70, 0.13, 0.10};
}  // namespace colors

}  // namespace hvas::products
