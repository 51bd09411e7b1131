#include "app/product/load_product.h"

#include <cstdio>
#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command_watch.h"
#include "app/output/number_range.h"
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

/** Options that take the place of what the file states, or does not. */
void AddFileOptions(CLI::App* command, LoadOptions* options) {
  command
      ->add_option_function<std::string>(
          "--unit",
          [options](const std::string& name) { options->length_unit = LengthUnits().at(name); },
          "Length unit of the file, whatever it states: mm, cm, m, in or ft; default: what it "
          "states, and mm for OBJ and STL files, which state none")
      ->check(CLI::IsMember(&LengthUnits()))
      ->type_name("UNIT");
  command
      ->add_option("--encoding", options->encoding,
                   "Encoding of the names in a STEP file, as iconv names it, for example CP1251, "
                   "GBK or ISO-8859-2; default: UTF-8, or what the text looks like")
      ->type_name("NAME");
}

}  // namespace

void AddLoadOptions(CLI::App* command, LoadOptions* options, Limited limited) {
  command->add_flag("--strict", options->is_strict, "Treat warnings as errors");
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->add_flag("!--no-cache", options->is_cache_used,
                    "Do not use the caches on disk: read and prepare everything again");
  AddFileOptions(command, options);
  command->add_option("--apart", options->apart,
                      "Name or path of a unit, or of one of its bodies, that is not to be welded "
                      "into one body, or of copies of a part that are not to be left out; all: of "
                      "everything; may be repeated");
  command->add_option("--rigid", options->rigid,
                      "Name or path of a part that may not give on its way although its name, its "
                      "material or its form indicates that it is flexible; all: no part that is "
                      "not under \"compliant\" in the side file; may be repeated");
  const CLI::Option* time =
      command
          ->add_option("--time-limit", options->limits.time,
                       limited == Limited::kCommand
                           ? "Time limit for the command, to its last output [s]; without it, an "
                             "hour where the product is prepared, planned or run"
                           : "Time limit for opening a file [s]")
          ->check(Positive())
          ->capture_default_str();
  if (limited == Limited::kCommand) {
    command->parse_complete_callback([options, time] {
      CommandWatch::Get().Begin(options->file.filename().string(), options->limits, !time->empty());
    });
  }
  command
      ->add_option("--memory-limit", options->limits.memory,
                   "Memory limit for opening the file, for example 8GB; default: 4GB, or three "
                   "quarters of the machine's memory where that is less")
      ->transform(Bytes());
  command
      ->add_option("--max-parts", options->max_parts,
                   "Limit of parts in the file, each instance counted")
      ->check(CLI::Range(1, static_cast<int>(cad::kLargestMaxParts)))
      ->capture_default_str();
}

void AddFixtureOption(CLI::App* command, LoadOptions* options) {
  command->add_option("--fixture", options->fixtures,
                      "CAD file of a fixture, with its place: FILE, FILE@X,Y,Z or FILE@X,Y,Z,ANGLE "
                      "about z [mm, deg]; may be repeated");
}

void AddAccessoryOptions(CLI::App* command, LoadOptions* options) {
  command->add_option("--tool", options->tools,
                      "CAD file of a tool that lies on the table; may be repeated");
  AddFixtureOption(command, options);
  command->add_option("--bench", options->bench,
                      "CAD file of a fixture that stands on the table; may be repeated");
}

std::optional<std::filesystem::path> CacheDirectory(const LoadOptions& options) {
  return options.is_cache_used ? FileCache::DefaultDirectory() : std::nullopt;
}

namespace {

assembly::OpenOptions MakeOpenOptions(const LoadOptions& options) {
  assembly::OpenOptions open = static_cast<const assembly::OpenOptions&>(options);
  open.cache_directory = CacheDirectory(options);
  if (open.progress == nullptr) {
    open.progress = MakeProgress(options.is_quiet);
  }
  open.limits = CommandWatch::Get().LimitsOr(open.limits);
  if (!open.stop.stop_possible()) {
    open.stop = CommandWatch::Get().stop();
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

WorkWatch MakeWorkWatch(const LoadOptions& options) {
  const CommandWatch& command = CommandWatch::Get();
  return WorkWatch(command.LimitsOr(options.limits), command.stop());
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
