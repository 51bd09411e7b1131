#pragma once

#include <filesystem>
#include <optional>

#include "assembly/open_product.h"
#include "base/diagnostics.h"
#include "base/result.h"
#include "product/product.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** What every command that opens a CAD file asks for. `fits` are as given to --fit; LoadProduct
 sets the cache directory, and the progress where there is none. */
struct LoadOptions : assembly::OpenOptions {
  bool is_strict{false};     ///< Warnings are errors.
  bool is_quiet{false};      ///< No progress on stderr.
  bool is_cache_used{true};  ///< Keeps and takes what was read and prepared on disk.
};

/** What --time-limit and --memory-limit limit. */
enum class Limited {
  kCommand,  ///< All of the command (CommandWatch).
  kOpening,  ///< Each opening of a file: people work with what is opened.
};

/** Adds --strict, --quiet, --no-cache, --unit, --encoding, --apart, --rigid, --time-limit,
 --memory-limit and --max-parts to a command. */
void AddLoadOptions(CLI::App* command, LoadOptions* options, Limited limited = Limited::kCommand);

/** Adds --fixture to a command. */
void AddFixtureOption(CLI::App* command, LoadOptions* options);

/** Adds --tool, --fixture and --bench to a command that brings a product to the loops. */
void AddAccessoryOptions(CLI::App* command, LoadOptions* options);

/** The directory for what is kept between runs; none where the user wants none. */
[[nodiscard]] std::optional<std::filesystem::path> CacheDirectory(const LoadOptions& options);

/** Opens a CAD file as assembly::OpenInferred, with progress on a terminal. */
[[nodiscard]] Result<product::Product> LoadInferred(const LoadOptions& options,
                                                    Diagnostics* diagnostics);

/** Opens a CAD file ready to assemble as assembly::OpenProduct, with progress on a terminal. With
 --strict it ends as CheckStrict says. */
[[nodiscard]] Result<product::Product> LoadProduct(const LoadOptions& options,
                                                   Diagnostics* diagnostics);

/** Makes a watch for work on a product that has been opened, with the limits of the command. */
[[nodiscard]] WorkWatch MakeWorkWatch(const LoadOptions& options);

/** Ends what --strict was asked of when there are warnings: prints them on stderr and fails
 (kInvalid), so that the command can end with exit status 1. To be called again after steps that
 warn. */
[[nodiscard]] Result<void> CheckStrict(const LoadOptions& options, const Diagnostics& diagnostics);

}  // namespace hvas::app
