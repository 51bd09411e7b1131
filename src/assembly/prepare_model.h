#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/import.h"
#include "contact/shape_cache.h"
#include "fits/pair_choice.h"
#include "product/product.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** Options of the preparation. */
struct PrepareOptions {
  std::uint64_t seed{1};  ///< Draws the actual sizes of the fits.
  fits::PairChoice pairs{fits::PairChoice::kOfKind};
  std::vector<std::string> first_parts;  ///< Names, paths or ids ("o12"); the others follow.
  std::string base;         ///< The part that stays in the fixture, likewise; empty: it is found.
  bool is_thorough{false};  ///< Searches sequence::kThoroughness times as long for ways out.
  std::vector<sequence::SequenceStep> steps;  ///< The whole order, of a plan; empty: it is found.
  std::shared_ptr<contact::ShapeCache> shape_cache;  ///< Null: contact shapes are always built.
  cad::ProgressFn progress;                          ///< Called by the calling thread; may be null.
  /** Called as simulation::CompileOptions has it; may be null. */
  std::function<void(const std::shared_ptr<const simulation::Model>& model)> on_first_parts;
  std::chrono::duration<double> least_gain{simulation::CompileOptions().least_gain};
  std::stop_token stop;  ///< Ends the preparation.
  std::string name;      ///< Name of the product in errors; empty: Product::source.
};

/** Makes the cache of contact shapes in a directory; null without a directory. */
[[nodiscard]] std::shared_ptr<contact::ShapeCache> MakeShapeCache(
    const std::optional<std::filesystem::path>& directory);

/** Makes options for simulation::Compile, and for session::LoadModel, which prepares the model of a
 record. */
[[nodiscard]] simulation::CompileOptions MakeCompileOptions(const PrepareOptions& options);

/** Prepares a product for assembly: contact shapes, fits with sizes drawn by the seed, the order of
 assembly, and the layout of the parts on the table. The same product, seed and order give the same
 model. Shapes that cannot be kept are a warning ("shape-cache").
 Errors: kUnsupported where no part has a mass; those of simulation::Compile, kCancelled after a
 stop among them.
 @param product  As OpenProduct gives it. @pre diagnostics != nullptr. */
[[nodiscard]] Result<std::shared_ptr<const simulation::Model>> PrepareModel(
    product::Product product, const PrepareOptions& options, Diagnostics* diagnostics);

}  // namespace hvas::assembly
