#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "cad/import.h"
#include "product/product.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** What every command that opens a CAD file asks for. */
struct LoadOptions {
  std::filesystem::path file;
  std::vector<std::string> fits;         ///< "AXIS=FIT", as given to --fit.
  bool is_strict{false};                 ///< Warnings are errors.
  bool is_quiet{false};                  ///< No progress on stderr.
  bool is_cache_used{true};              ///< Keeps and takes what was read and prepared on disk.
  double length_unit{1e-3};              ///< The unit of files that state none [m].
  double time_limit{WorkLimits().time};  ///< The longest that opening the file may take [s].
  std::uint64_t memory_limit{
      0};  ///< The most memory that it may take [bytes]; 0: DefaultMemoryLimit().
  int max_parts{cad::kDefaultMaxParts};  ///< That the file may place.
  cad::ProgressFn progress;              ///< Null: on the terminal, where there is one.
  std::stop_token stop;                  ///< Ends the reading.
};

/** Adds --strict, --quiet, --no-cache, --unit, --time-limit, --memory-limit and --max-parts to a
 command. */
void AddLoadOptions(CLI::App* command, LoadOptions* options);

/** The directory for what is kept between runs; none where the user wants none. */
[[nodiscard]] std::optional<std::filesystem::path> CacheDirectory(const LoadOptions& options);

/** Opens a CAD file: imported, mates inferred, and nothing of what its files state about mates. */
[[nodiscard]] Result<product::Product> LoadInferred(const LoadOptions& options,
                                                    Diagnostics* diagnostics);

/** Opens a CAD file ready to assemble: imported, mates inferred, the mates and fits of the side
 file NAME.hvas.json (if there is one) and then those of the command line assigned. Shows progress
 on a terminal. With --strict it ends as CheckStrict says. Errors: those of cad::Import, of the
 assignments and of CheckStrict. */
[[nodiscard]] Result<product::Product> LoadProduct(const LoadOptions& options,
                                                   Diagnostics* diagnostics);

/** Ends what --strict was asked of when there are warnings: prints them on stderr and fails
 (kInvalid), so that the command can end with exit status 1. To be called again after steps that
 warn. */
[[nodiscard]] Result<void> CheckStrict(const LoadOptions& options, const Diagnostics& diagnostics);

}  // namespace hvas::app
