#include "app/product/load_product.h"

#include <cstdio>
#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/progress.h"
#include "base/file_cache.h"
#include "base/units.h"
#include "cad/import.h"

namespace hvas::app {

namespace {

/** Metres in the units that --unit knows. */
const std::map<std::string, double>& LengthUnits() {
  static const std::map<std::string, double> metres{{"mm", units::kMetresPerMillimetre},
                                                    {"cm", 1e-2},
                                                    {"m", 1.0},
                                                    {"in", units::kMetresPerInch},
                                                    {"ft", 12 * units::kMetresPerInch}};
  return metres;
}

void AddUnitOption(CLI::App* command, double* length_unit) {
  command
      ->add_option_function<std::string>(
          "--unit",
          [length_unit](const std::string& name) { *length_unit = LengthUnits().at(name); },
          "Length unit of OBJ and STL files, which state none: mm (when not given), cm, m, in or "
          "ft; all other formats state theirs, and it changes nothing for them")
      ->check(CLI::IsMember(&LengthUnits()))
      ->type_name("UNIT");
}

}  // namespace

void AddLoadOptions(CLI::App* command, LoadOptions* options) {
  command->add_flag("--strict", options->is_strict, "Take warnings for errors");
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->add_flag("!--no-cache", options->is_cache_used,
                    "Read and prepare everything anew, and keep nothing on disk");
  AddUnitOption(command, &options->length_unit);
  command
      ->add_option("--time-limit", options->limits.time,
                   "Longest time for opening the file with all that belongs to it, in seconds")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--memory-limit", options->limits.memory,
                   "Most memory for opening the file, as 8GB; when not given 4GB, or three "
                   "quarters of the machine's where that is less")
      ->transform(CLI::AsSizeValue(/*kb_is_1000=*/false));
  command
      ->add_option("--max-parts", options->max_parts,
                   "Most parts that the file may place, copies counted")
      ->check(CLI::Range(1, static_cast<int>(cad::kLargestMaxParts)))
      ->capture_default_str();
}

std::optional<std::filesystem::path> CacheDirectory(const LoadOptions& options) {
  return options.is_cache_used ? FileCache::DefaultDirectory() : std::nullopt;
}

namespace {

assembly::OpenOptions MakeOpenOptions(const LoadOptions& options) {
  assembly::OpenOptions open = options;
  open.cache_directory = CacheDirectory(options);
  if (open.progress == nullptr && !options.is_quiet && IsWatched()) {
    open.progress = ShowProgress;
  }
  return open;
}

}  // namespace

Result<product::Product> LoadInferred(const LoadOptions& options, Diagnostics* diagnostics) {
  return assembly::OpenInferred(MakeOpenOptions(options), diagnostics);
}

Result<product::Product> LoadProduct(const LoadOptions& options, Diagnostics* diagnostics) {
  auto product = assembly::OpenProduct(MakeOpenOptions(options), diagnostics);
  if (!product) {
    return product;
  }
  if (const auto strict = CheckStrict(options, *diagnostics); !strict) {
    return Unexpected(strict.error());
  }
  return product;
}

Result<void> CheckStrict(const LoadOptions& options, const Diagnostics& diagnostics) {
  const int warnings = diagnostics.Count(Severity::kWarning);
  if (!options.is_strict || warnings == 0) {
    return {};
  }
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.severity == Severity::kWarning) {
      fmt::print(stderr, "hvas: warning {} [{}]: {}{}\n", item.code, item.entity, item.message,
                 item.remedy.empty() ? "" : "; " + item.remedy);
    }
  }
  return Fail(
      ErrorCode::kInvalid,
      fmt::format("{} warning{}, and --strict takes none", warnings, warnings == 1 ? "" : "s"),
      options.file.filename().string(), "correct the file, or leave --strict out");
}

}  // namespace hvas::app
