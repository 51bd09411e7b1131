#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "contact/shape_cache.h"
#include "product/product.h"

namespace hvas::simulation {

/** What a part's contact shape is made from. */
[[nodiscard]] contact::ShapeSource MakeShapeSource(const product::Part& part);

struct ShapesControl {
  contact::ShapeOptions shape;                    ///< Its `stop` ends the building of all.
  contact::ShapeCache* cache{nullptr};            ///< Null: shapes are always built.
  unsigned threads{0};                            ///< Threads that build shapes; 0: one a core.
  std::function<void(double fraction)> progress;  ///< Called on the calling thread; may be null.
};

/** Contact shapes of the parts of a product, by PartId. */
using PartShapes = std::vector<std::shared_ptr<const contact::Shape>>;

/** The shape of each part of a product: parts side by side, and blocks of a large part side by
 side. Errors: those of contact::Shape::Build, with the part; one fails all. */
[[nodiscard]] Result<PartShapes> BuildShapes(const product::Product& product,
                                             const ShapesControl& control);

/** Builds the shapes of some parts. Errors: as those of BuildShapes.
 @param parts  Those whose shape is not there.
 @param shapes  Of all parts, null where there is none. */
[[nodiscard]] Result<void> AddShapes(const product::Product& product,
                                     const std::vector<product::PartId>& parts,
                                     const ShapesControl& control, PartShapes* shapes);

/** The parts without a shape. */
[[nodiscard]] std::vector<product::PartId> ListWithoutShape(const PartShapes& shapes);

struct Model;

/** What the shapes of a model take, each once however often its part occurs. */
[[nodiscard]] contact::ShapeMemory CalcShapeMemory(const Model& model);

}  // namespace hvas::simulation
