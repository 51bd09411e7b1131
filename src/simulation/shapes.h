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

/** The shape of each part of a product, by PartId: parts side by side, and blocks of a large part
 side by side. Errors: those of contact::Shape::Build, with the part; one fails all. */
Result<std::vector<std::shared_ptr<const contact::Shape>>> BuildShapes(
    const product::Product& product, const ShapesControl& control);

struct Model;

/** What the shapes of a model take, each once however often its part occurs. */
[[nodiscard]] contact::ShapeMemory CalcShapeMemory(const Model& model);

}  // namespace hvas::simulation
