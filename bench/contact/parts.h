#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "solid.h"

/** What the benchmark of contact queries is measured on. SI but for what `products` draws. */
namespace hvas::bench {

/** A concave part with its contact shape, built as the program builds it. */
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
  kHousing,     ///< Housing of the gear pump, with its bushings and gasket as one solid.
  kDriveGear,   ///< Drive gear shaft.
  kDrivenGear,  ///< Driven gear shaft.
  kCover,       ///< One solid with its bushings.
  kDowel,       ///< 5.98 mm for holes of 6 mm.
  kStud,        ///< Has rings for a thread.
  kHub,         ///< Filler, as the next two.
  kNippleBody,
  kSeal,
  kPartCount
};

/** Draws all parts; meshes and builds those that are wanted, by number. Shapes come from the cache
 of shapes where it is on. */
Result<std::vector<BenchPart>> MakeParts(const std::set<std::size_t>& wanted);

/** Triangles of a solid at a chord deflection [m]; 0: as the program imports a part. */
Result<contact::ShapeSource> MeshSolid(const products::Solid& solid, double deflection);

}  // namespace hvas::bench
