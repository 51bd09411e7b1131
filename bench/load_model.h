#pragma once

#include <memory>
#include <string>
#include <utility>

#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "base/file_cache.h"

namespace hvas::bench {

/** The model of a product's file as `hvas assemble` has it, its diagnostics left out. Errors: those
 of assembly::OpenProduct and assembly::PrepareModel. */
inline Result<std::shared_ptr<const simulation::Model>> LoadModel(
    const std::string& file, const assembly::PrepareOptions& prepare = {}) {
  assembly::OpenOptions open;
  open.file = file;
  open.cache_directory = FileCache::DefaultDirectory();
  Diagnostics diagnostics;
  auto product = assembly::OpenProduct(open, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  return assembly::PrepareModel(std::move(*product), prepare, &diagnostics);
}

}  // namespace hvas::bench
