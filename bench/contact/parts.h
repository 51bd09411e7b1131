#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "solid.h"

/** What the benchmark of contact queries is measured on. SI but for what `products` draws. */
namespace hvas::bench {

/** A concave part with its contact shape, built from a mesh of 1 um deflection. */
struct BenchPart {
  std::string name;
  products::Solid solid;
  contact::ShapeSource source;
  std::shared_ptr<const contact::Shape> shape;
};

/** Numbers of the parts in the list of MakeParts. */
enum PartNumber : std::size_t {
  kShaft,
  kBushing,
  kHousing,     ///< Of the gear pump, with its bushings and gasket as one solid.
  kDriveGear,   ///< Drive gear shaft.
  kDrivenGear,  ///< Driven gear shaft.
  kCover,       ///< With its bushings as one solid.
  kDowel,       ///< 5.98 mm for holes of 6 mm.
  kStud,        ///< With rings for a thread.
  kHub,         ///< Filler, as the next two.
  kNippleBody,
  kSeal,
  kPartCount
};

/** Draws, meshes and builds all parts. Shapes come from the cache of shapes where it is on. */
Result<std::vector<BenchPart>> MakeParts();

/** Triangles of a solid at a chord deflection [m]. Normals of neighbours differ by at most 0.1 rad
 when `is_fine`, else by 0.5 rad. */
Result<contact::ShapeSource> MeshSolid(const products::Solid& solid, double deflection,
                                       bool is_fine);

}  // namespace hvas::bench
