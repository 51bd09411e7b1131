#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/import.h"
#include "contact/shape_cache.h"
#include "product/product.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Opens a CAD file ready to assemble. */
using LoadFn = std::function<Result<product::Product>(
    const std::filesystem::path& file, const cad::ProgressFn& progress, std::stop_token stop,
    Diagnostics* diagnostics)>;

/** A change of a product. */
using ChangeFn = std::function<Result<void>(product::Product*)>;

/** Makes scenes of files and of changes. One thread's. */
class SceneBuilder {
 public:
  struct Options {
    LoadFn load;
    std::shared_ptr<contact::ShapeCache> shape_cache;  ///< Null: shapes are always built.
    std::uint64_t seed{1};
  };

  explicit SceneBuilder(Options options) : options_(std::move(options)) {}

  /** @param name  As people call the file.
   Errors: of the file; kUnsupported where nothing of it has a mass; kCancelled. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Open(const std::filesystem::path& file,
                                                              const std::string& name,
                                                              const cad::ProgressFn& progress,
                                                              const std::stop_token& stop);

  /** The same, as a scene of its own. */
  [[nodiscard]] std::shared_ptr<const OpenScene> Again(const OpenScene& before);

  /** The same product after a change; its pictures stay. Errors: of the change. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Change(const OpenScene& before,
                                                                const std::string& what,
                                                                const ChangeFn& change,
                                                                const cad::ProgressFn& progress);

 private:
  [[nodiscard]] Result<std::shared_ptr<const simulation::Model>> Compile(
      product::Product product, const std::string& name, const cad::ProgressFn& progress,
      Diagnostics* diagnostics) const;

  Options options_;
  std::uint32_t last_epoch_{0};
};

}  // namespace hvas::studio
