#include "assembly/open_product.h"

#include <cmath>
#include <cstddef>
#include <system_error>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/stated_fits.h"

namespace hvas::assembly {
namespace {

using product::Product;

Result<void> Check(const OpenOptions& options) {
  if (!(options.length_unit > 0) || !std::isfinite(options.length_unit)) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} m is no length unit", options.length_unit),
                options.file.filename().string(), "give a length above 0, as 0.001");
  }
  if (options.max_parts < 1 ||
      static_cast<std::size_t>(options.max_parts) > cad::kLargestMaxParts) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} parts cannot be a limit", options.max_parts),
                options.file.filename().string(),
                fmt::format("allow 1 to {} parts", cad::kLargestMaxParts));
  }
  return {};
}

Result<Product> OpenWithin(const OpenOptions& options, WorkWatch* watch, Diagnostics* diagnostics) {
  if (const auto checked = Check(options); !checked) {
    return Unexpected(checked.error());
  }
  cad::ImportControl control;
  control.limits.time = options.limits.time;
  control.limits.memory = options.limits.memory;
  control.cache_directory = options.cache_directory;
  control.stop = options.stop;
  control.progress = options.progress;
  cad::ImportOptions import;
  import.length_unit = options.length_unit;
  import.max_parts = static_cast<std::size_t>(options.max_parts);
  auto product = cad::Import(options.file, import, diagnostics, control);
  if (!product) {
    return product;
  }
  if (const auto inferred = mates::Infer(&*product, diagnostics, watch); !inferred) {
    return Unexpected(inferred.error());
  }
  return product;
}

/** What the files themselves state about mates. */
Result<void> ApplyStated(const OpenOptions& options, Product* product, WorkWatch* watch) {
  const std::filesystem::path side_file = mates::FindAssignmentFile(options.file);
  std::error_code error;
  // A link that leads nowhere is a mistake to be told, not a side file that is not there.
  if (std::filesystem::exists(std::filesystem::symlink_status(side_file, error))) {
    const auto applied = mates::ApplyAssignments(side_file, product, watch);
    return applied ? Result<void>() : Unexpected(applied.error());
  }
  mates::AssignStatedFits(product, watch);
  if (!watch->MayGoOn()) {
    return Unexpected(
        watch->Explain("assigning the stated fits", options.file.filename().string()));
  }
  return {};
}

WorkWatch MakeWatch(const OpenOptions& options) {
  return WorkWatch(options.limits, options.stop);
}

}  // namespace

Result<Product> OpenInferred(const OpenOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = MakeWatch(options);
  return OpenWithin(options, &watch, diagnostics);
}

Result<Product> OpenProduct(const OpenOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = MakeWatch(options);
  auto product = OpenWithin(options, &watch, diagnostics);
  if (!product) {
    return product;
  }
  if (const auto applied = ApplyStated(options, &*product, &watch); !applied) {
    return Unexpected(applied.error());
  }
  for (const std::string& fit : options.fits) {
    if (const auto assigned = mates::AssignFit(&*product, fit); !assigned) {
      return Unexpected(assigned.error());
    }
  }
  return product;
}

}  // namespace hvas::assembly
