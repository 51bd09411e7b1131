#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace hvas::cad {

/** Called now and then with what is being done and the fraction of it that is done, 0..1. */
using ProgressFn = std::function<void(std::string_view stage, double fraction)>;

/** Called before a part is worked at, with its number in the order of the file and its name. */
using PartFn = std::function<void(std::uint32_t number, std::string_view name)>;

/** What is made of a file. */
struct ImportOptions {
  /** How finely parts are meshed. A part's chord deflection is relative to its own size, because
   files come a thousand times too large or too small. */
  double relative_deflection{2e-5};   ///< Of the diagonal of the part's box.
  double min_deflection{1e-6};        ///< No finer than this [m].
  double max_angle{0.1};              ///< Between the normals of neighbouring triangles [rad].
  std::size_t max_triangles{200000};  ///< A part with more is meshed again, coarser.
  bool with_tolerances{true};         ///< Reads dimensions, tolerances and fits.
  std::vector<std::uint32_t> skipped_parts;  ///< Left out, by their numbers as PartFn gets them.
};

}  // namespace hvas::cad
