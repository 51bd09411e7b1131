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
#include "studio/edit.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Opens a CAD file ready to assemble. */
using LoadFn = std::function<Result<product::Product>(
    const std::filesystem::path& file, const cad::ProgressFn& progress, std::stop_token stop,
    Diagnostics* diagnostics)>;

/** Makes scenes of files and of changes. One thread's. */
class SceneBuilder {
 public:
  struct Options {
    LoadFn load;
    std::shared_ptr<contact::ShapeCache> shape_cache;  ///< Null: shapes are always built.
    std::uint64_t seed{1};  ///< Any number: the actual sizes of the fits follow from it.
    /** Epochs begin behind it: pages of a program's start before know theirs from these. */
    std::uint32_t last_epoch{0};
  };

  explicit SceneBuilder(Options options)
      : options_(std::move(options)), last_epoch_(options_.last_epoch) {}

  /** @param name  As people call the file.
   Errors: of the file; kUnsupported where nothing of it has a mass; kCancelled. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Open(const std::filesystem::path& file,
                                                              const std::string& name,
                                                              const cad::ProgressFn& progress,
                                                              const std::stop_token& stop);

  /** What was opened, after edits as of OpenScene. Errors: of the first that cannot be made. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> MakeEdits(
      const OpenScene& opened, const std::vector<nlohmann::ordered_json>& edits,
      const cad::ProgressFn& progress);

  /** The same, as a scene of its own. */
  [[nodiscard]] std::shared_ptr<const OpenScene> Again(const OpenScene& before);

  /** The same product after a change; its pictures stay. Errors: of the change. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Change(const OpenScene& before,
                                                                const Edit& edit,
                                                                const cad::ProgressFn& progress);

 private:
  [[nodiscard]] Result<std::shared_ptr<const simulation::Model>> Compile(
      product::Product product, const std::string& name, const cad::ProgressFn& progress,
      Diagnostics* diagnostics) const;

  Options options_;
  std::uint32_t last_epoch_;
};

}  // namespace hvas::studio
