#include "app/product/load_product.h"

#include <cstdio>
#include <map>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/progress.h"
#include "base/file_cache.h"
#include "base/units.h"
#include "base/work_watch.h"
#include "cad/import.h"
#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/stated_fits.h"

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
          "Length unit of OBJ and STL files, which do not state one: mm (default), cm, m, in or "
          "ft; it has no effect on other formats")
      ->check(CLI::IsMember(&LengthUnits()))
      ->type_name("UNIT");
}

}  // namespace

void AddLoadOptions(CLI::App* command, LoadOptions* options) {
  command->add_flag("--strict", options->is_strict, "Treat warnings as errors");
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->add_flag("!--no-cache", options->is_cache_used,
                    "Do not use the caches on disk: read and prepare everything again");
  AddUnitOption(command, &options->length_unit);
  command
      ->add_option("--time-limit", options->time_limit,
                   "Time limit for opening and preparing the file [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--memory-limit", options->memory_limit,
                   "Memory limit for opening the file, for example 8GB; default: 4GB, or three "
                   "quarters of the machine's memory where that is less")
      ->transform(CLI::AsSizeValue(/*kb_is_1000=*/false));
  command
      ->add_option("--max-parts", options->max_parts,
                   "Limit of parts in the file, each instance counted")
      ->check(CLI::Range(1, static_cast<int>(cad::kLargestMaxParts)))
      ->capture_default_str();
}

std::optional<std::filesystem::path> CacheDirectory(const LoadOptions& options) {
  return options.is_cache_used ? FileCache::DefaultDirectory() : std::nullopt;
}

namespace {

Result<product::Product> LoadInferredWithin(const LoadOptions& options, WorkWatch* watch,
                                            Diagnostics* diagnostics) {
  cad::ImportControl control;
  control.limits.time = options.time_limit;
  control.limits.memory = options.memory_limit;
  control.cache_directory = CacheDirectory(options);
  control.stop = options.stop;
  control.progress = options.progress;
  if (control.progress == nullptr && !options.is_quiet && IsWatched()) {
    control.progress = ShowProgress;
  }
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

WorkWatch Watch(const LoadOptions& options) {
  return WorkWatch({options.time_limit, options.memory_limit}, options.stop);
}

}  // namespace

Result<product::Product> LoadInferred(const LoadOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = Watch(options);
  return LoadInferredWithin(options, &watch, diagnostics);
}

Result<product::Product> LoadProduct(const LoadOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = Watch(options);
  auto product = LoadInferredWithin(options, &watch, diagnostics);
  if (!product) {
    return product;
  }
  const std::filesystem::path side_file = mates::FindAssignmentFile(options.file);
  std::error_code error;
  // A link that leads nowhere is a mistake to be told, not a side file that is not there.
  if (std::filesystem::exists(std::filesystem::symlink_status(side_file, error))) {
    if (const auto applied = mates::ApplyAssignments(side_file, &*product, &watch); !applied) {
      return Unexpected(applied.error());
    }
  } else {
    mates::AssignStatedFits(&*product, &watch);
    if (!watch.MayGoOn()) {
      return Unexpected(
          watch.Explain("assigning the stated fits", options.file.filename().string()));
    }
  }
  for (const std::string& fit : options.fits) {
    if (const auto assigned = mates::AssignFit(&*product, fit); !assigned) {
      return Unexpected(assigned.error());
    }
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
  return Fail(ErrorCode::kInvalid,
              fmt::format("{} warning{}, which --strict treats as errors", warnings,
                          warnings == 1 ? "" : "s"),
              options.file.filename().string(), "correct the file, or omit --strict");
}

}  // namespace hvas::app
