#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

#include "base/diagnostics.h"
#include "base/result.h"
#include "product/product.h"

namespace hvas::cad {

/** Called now and then with what is being done and the fraction of it that is done, 0..1. */
using ProgressFn = std::function<void(std::string_view stage, double fraction)>;

/** How finely parts are meshed. A part's chord deflection is relative to its own size, because
 files come a thousand times too large or too small. */
struct ImportOptions {
  double relative_deflection{2e-5};   ///< Of the diagonal of the part's box.
  double min_deflection{1e-6};        ///< No finer than this [m].
  double max_angle{0.1};              ///< Between the normals of neighbouring triangles [rad].
  std::size_t max_triangles{200000};  ///< A part with more is meshed again, coarser.
};

/** Reads a STEP assembly (AP203, AP214, AP242) with the files that it refers to.

 The result has structure, names (UTF-8), colours (sRGB), materials, mass, faces as analytic
 surfaces, the mesh and the features of every part, in SI, and no mates. What is odd about the file
 goes to `diagnostics` and does not stop the import. Parts without a face are left out; parts
 without a solid have no mass. The density of a part that states none, or an absurd one, is assumed.

 Errors: kNotFound (no such file), kUnreadable (not STEP, damaged, or without a solid),
 kOutOfResource. Not re-entrant inside: concurrent calls wait for each other. Deterministic.
 @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> ImportStep(const std::filesystem::path& file,
                                                  const ImportOptions& options,
                                                  Diagnostics* diagnostics,
                                                  const ProgressFn& progress = {});

}  // namespace hvas::cad
