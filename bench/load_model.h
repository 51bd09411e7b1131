#pragma once

#include <memory>
#include <string>
#include <utility>

#include "app/product/load_product.h"
#include "simulation/model.h"

namespace hvas::bench {

/** The model of a product's file, its diagnostics left out. Errors: of the import, or of
 simulation::Compile. */
inline Result<std::shared_ptr<const simulation::Model>> LoadModel(const std::string& file) {
  app::LoadOptions load;
  load.file = file;
  load.is_quiet = true;
  Diagnostics diagnostics;
  auto product = app::LoadProduct(load, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  return simulation::Compile(std::make_shared<product::Product>(std::move(*product)), {},
                             &diagnostics);
}

}  // namespace hvas::bench
