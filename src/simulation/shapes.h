#pragma once

#include <atomic>
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
  contact::ShapeOptions shape;
  contact::ShapeCache* cache{nullptr};  ///< Null: shapes are always built.
  int threads{2};
};

/** The shape of each part of a product, by PartId: parts side by side on several threads. One error
 stops all. */
Result<std::vector<std::shared_ptr<const contact::Shape>>> BuildShapes(
    const product::Product& product, const ShapesControl& control);

}  // namespace hvas::simulation
