#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "product/product.h"

namespace hvas::simulation {

/** Parts whose contact shapes are made before those of all others, so that somebody can begin. */
struct FirstParts {
  std::vector<product::PartId> parts;  ///< Empty: all are made together.
  product::OccurrenceId base;          ///< What stays in the fixture, as far as mates tell.
  double share{0};                     ///< What they take, of the triangles of all parts.
};

/** Chooses the base, by the mates, and the parts joined to it whose meshes are small: at most a
 quarter of the triangles of all others. */
[[nodiscard]] FirstParts ChooseFirstParts(const product::Product& product);

/** Makes what stands for the contact shape of a part as long as that is not there: its box. Nothing
 may meet it. Errors: those of contact::Shape::Build. */
[[nodiscard]] Result<std::shared_ptr<const contact::Shape>> MakeBoxShape(const product::Part& part);

}  // namespace hvas::simulation
