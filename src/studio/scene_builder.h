#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "assembly/prepare_model.h"
#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/import.h"
#include "contact/shape_cache.h"
#include "orders/order_rules.h"
#include "product/product.h"
#include "studio/edit.h"
#include "studio/json.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Imports a CAD file and infers its mates. */
using LoadFn = std::function<Result<product::Product>(
    const std::filesystem::path& file, const cad::ProgressFn& progress, std::stop_token stop,
    Diagnostics* diagnostics)>;

/** Makes scenes from files and from edits of scenes. For one thread. */
class SceneBuilder {
 public:
  struct Options {
    LoadFn load;
    std::shared_ptr<contact::ShapeCache> shape_cache;  ///< Null: shapes are always built.
    std::uint64_t seed{1};  ///< Any number: the actual sizes of the fits follow from it.
    /** The least gain for which first parts are shown, as simulation::CompileOptions has it. */
    std::chrono::duration<double> least_gain{simulation::CompileOptions().least_gain};
    /** New epochs are larger, so that they differ from those of the program's previous start. */
    std::uint32_t last_epoch{0};
  };

  explicit SceneBuilder(Options options)
      : options_(std::move(options)), last_epoch_(options_.last_epoch) {}

  using SceneFn = std::function<void(const std::shared_ptr<const OpenScene>& scene)>;

  /** Opens a file.
   @param name  Display name of the file.
   @param on_first_parts  Gets a scene in which only the first parts are ready, where the others
   take long; may be null.
   Errors: those of the import; kUnsupported where no part has a mass; kCancelled. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Open(const std::filesystem::path& file,
                                                              const std::string& name,
                                                              const cad::ProgressFn& progress,
                                                              const std::stop_token& stop,
                                                              const SceneFn& on_first_parts);

  /** Applies edits of OpenScene to a scene. Errors: those of the first edit that fails, and of an
   order that is not possible any more. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> ApplyEdits(
      const OpenScene& opened, const std::vector<Json>& edits, const cad::ProgressFn& progress);

  /** Copies a scene under a new epoch, with another model of the same product. */
  [[nodiscard]] std::shared_ptr<const OpenScene> MakeCopy(
      const OpenScene& before, std::shared_ptr<const simulation::Model> model);

  /** Applies an edit to the product of a scene; the meshes stay. Errors: those of the edit, and of
   compiling the model. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> Change(const OpenScene& before,
                                                                const Edit& edit,
                                                                const cad::ProgressFn& progress);

  /** Changes the order of assembly of a scene. Where the scene's product is changed later, its
   order is found anew. Errors: those of assembly::CheckOrder; kInvalid for an order that is not
   possible.
   @param rules  Those of the scene's model.
   @param occurrences  As of the command "set_order". */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> ChangeOrder(
      const OpenScene& before, const orders::OrderRules& rules,
      const std::vector<product::OccurrenceId>& occurrences, const std::stop_token& stop);

 private:
  [[nodiscard]] assembly::PrepareOptions MakeOptions(const std::string& name,
                                                     const cad::ProgressFn& progress) const;

  Options options_;
  std::uint32_t last_epoch_;
};

}  // namespace hvas::studio
