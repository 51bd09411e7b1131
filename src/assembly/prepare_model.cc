#include "assembly/prepare_model.h"

#include <utility>

namespace hvas::assembly {

std::shared_ptr<contact::ShapeCache> MakeShapeCache(
    const std::optional<std::filesystem::path>& directory) {
  return directory ? std::make_shared<contact::ShapeCache>(*directory) : nullptr;
}

simulation::CompileOptions MakeCompileOptions(const PrepareOptions& options) {
  simulation::CompileOptions compile;
  compile.seed = options.seed;
  compile.pairs = options.pairs;
  compile.search_queries *= options.is_thorough ? sequence::kThoroughness : 1;
  compile.first_parts = options.first_parts;
  compile.base = options.base;
  compile.steps = options.steps;
  compile.shape_cache = options.shape_cache;
  compile.progress = options.progress;
  compile.on_first_parts = options.on_first_parts;
  compile.least_gain = options.least_gain;
  compile.shape.stop = options.stop;
  return compile;
}

Result<std::shared_ptr<const simulation::Model>> PrepareModel(product::Product product,
                                                              const PrepareOptions& options,
                                                              Diagnostics* diagnostics) {
  if (!(product.mass() > 0)) {
    return Fail(ErrorCode::kUnsupported,
                "no part of the product has a mass, so there is nothing to assemble",
                options.name.empty() ? product.source : options.name,
                "export the product with solids, not as surfaces");
  }
  return simulation::Compile(std::make_shared<product::Product>(std::move(product)),
                             MakeCompileOptions(options), diagnostics);
}

}  // namespace hvas::assembly
