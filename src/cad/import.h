#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "cad/limits.h"
#include "product/product.h"

namespace hvas::cad {

/** Called now and then with what is being done and the fraction of it that is done, 0..1. */
using ProgressFn = std::function<void(std::string_view stage, double fraction)>;

/** Called before a part is worked at, with its number in the order of the file and its name; by
 several threads where parts are worked at at a time. */
using PartFn = std::function<void(std::uint32_t number, std::string_view name)>;

/** What is made of a file. */
struct ImportOptions {
  /** How finely parts are meshed. A part's chord deflection is relative to its own size, because
   files come a thousand times too large or too small. */
  double relative_deflection{4e-5};  ///< Part of the diagonal of the part's box.
  double min_deflection{2e-6};       ///< No finer than this [m].
  double max_angle{0.2};  ///< Largest angle between the normals of neighbouring triangles [rad].
  std::size_t max_triangles{200000};  ///< A part with more is meshed again, coarser.
  /** The unit of length of the file, whatever it states [m]; none: what it states, or millimetres
   where it states none (OBJ, STL). */
  std::optional<double> length_unit;
  /** Encoding of names in STEP files, as IsEncoding() knows it; empty: GuessEncoding(). */
  std::string encoding;
  bool with_tolerances{true};                ///< Reads dimensions, tolerances and fits.
  std::vector<std::uint32_t> skipped_parts;  ///< Left out, by their numbers as PartFn gets them.
  std::size_t max_parts{kDefaultMaxParts};   ///< That the file may place, copies counted.
  unsigned threads{0};  ///< That work at parts at a time; 0: one a core; 1: alone, also in a part.
  std::uint64_t max_bytes{std::uint64_t{1} << 30U};  ///< The most that may be made of the file.
};

/** What an import may take. */
struct ImportLimits {
  double time{WorkLimits().time};  ///< All attempts together [s].
  std::int64_t begin_ns{0};        ///< When the time begins, by MonotonicNs(); 0: with the import.
  double part_time{0};             ///< One part, or the tolerances [s]; 0: a fifth of `time`.
  std::uint64_t memory{0};  ///< [bytes]; 0: DefaultMemoryLimit(). A quarter is for the product.
};

struct ImportControl {
  ImportLimits limits;
  ProgressFn progress;
  std::stop_token stop;  ///< Ends the import at once when a stop is asked for.
  std::optional<std::filesystem::path> cache_directory;  ///< None: nothing is kept.
};

/** Reads a CAD file in a process of its own (`hvas-cad`; what it makes of the file is with ReadCad
 in cad/read_cad.h), so that neither a crash nor a hang nor a lack of memory of the libraries that
 know the formats is one of this program. No OpenCASCADE in the program that calls it.

 When that process dies, or takes longer than it may, another one does without what was at fault:
 first without the tolerances, if it died over them; then one part after the other, and without the
 part that it died over, up to a few parts. Each such step becomes a warning. Files that were read
 before come from the cache when neither they, nor the files that they refer to, nor the program
 have changed.

 Errors: those of ReadCad; kOutOfResource (a limit), kUnreadable (the process died), kNotFound
 (`hvas-cad` is not installed), kCancelled. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> Import(const std::filesystem::path& file,
                                              const ImportOptions& options,
                                              Diagnostics* diagnostics,
                                              const ImportControl& control = {});

}  // namespace hvas::cad
