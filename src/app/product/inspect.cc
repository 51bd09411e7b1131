#include "app/product/inspect.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/json_flag.h"
#include "app/output/report_failure.h"
#include "app/product/first_assignments.h"
#include "app/product/product_json.h"
#include "app/product/product_text.h"
#include "base/atomic_file.h"
#include "base/crash_note.h"
#include "base/parse_json.h"
#include "mates/relations.h"
#include "mates/side_file.h"

namespace hvas::app {
namespace {

using product::Product;

/** What a side file that is to be replaced says about mates that were added and removed stays. */
Result<void> KeepLists(const std::filesystem::path& file, nlohmann::ordered_json* document) {
  if (!std::filesystem::exists(file)) {
    return {};
  }
  const auto text = mates::ReadSideText(file);
  if (const auto read = text ? mates::ParseSideFile(*text, file) : Unexpected(text.error());
      !read) {
    return Unexpected(read.error());
  }
  const auto old = ParseJson<nlohmann::ordered_json>(*text);
  for (const char* list :
       {"mates", "removed", "relations", "contacts", "apart", "compliant", "flexible", "elastic"}) {
    if (old.is_object() && old.contains(list)) {
      (*document)[list] = old[list];
    }
  }
  return {};
}

Result<void> WriteAssignments(const InspectOptions& options, const Product& product) {
  const std::filesystem::path file = options.write_assignments->empty()
                                         ? mates::FindAssignmentFile(options.load.file)
                                         : std::filesystem::path(*options.write_assignments);
  if (!options.is_forced && std::filesystem::exists(std::filesystem::symlink_status(file))) {
    return Fail(ErrorCode::kInvalid, "the file exists already", file.string(),
                "choose another name, or replace it with --force");
  }
  nlohmann::ordered_json document = MakeFirstAssignments(product);
  if (auto kept = KeepLists(file, &document); !kept) {
    return kept;
  }
  if (const auto written = WriteAtomically(file, mates::FormatSideFile(document)); !written) {
    return Unexpected(written.error());
  }
  fmt::print("{}: {} fits for the mates of {}\n", file.string(), document["fits"].size(),
             product.source);
  return {};
}

Result<void> Inspect(const InspectOptions& options) {
  Diagnostics diagnostics;
  Result<Product> product = LoadProduct(options.load, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  if (options.write_assignments) {
    return WriteAssignments(options, *product);
  }
  const Result<Selection> selection = Selection::Make(*product, options.selection);
  if (!selection) {
    return Unexpected(selection.error());
  }
  WorkWatch watch = MakeWorkWatch(options.load);
  if (selection->Has(Section::kRelations)) {
    NoteStage("relations of parts");
    product->relations = mates::ListRelations(*product, &diagnostics, &watch);
  }
  nlohmann::ordered_json json;
  if (options.is_json) {
    json = ToJson(*product, diagnostics, *selection, &watch);
  } else {
    PrintText(*product, diagnostics, *selection, options.is_all, &watch);
  }
  if (!watch.MayGoOn()) {
    return Unexpected(watch.Explain("comparing the parts as drawn", product->source));
  }
  if (options.is_json) {
    NoteStage("output");
    // Names that are no UTF-8 in the file must not cost the whole answer.
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
  return {};
}

}  // namespace

int RunInspect(const InspectOptions& options) {
  const Result<void> inspected = Inspect(options);
  return inspected ? 0 : ReportFailure(inspected.error());
}

void AddInspect(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("inspect", "Show a CAD file: tree, parts, features, mates, fits");
  const auto options = std::make_shared<InspectOptions>();
  SelectionOptions& selection = options->selection;
  command->add_option("file", options->load.file, "CAD file")->required();
  AddJsonFlag(command, &options->is_json, "inspect");
  command
      ->add_option(
          "--only", selection.only,
          fmt::format("Sections to show, separated by commas: {}", fmt::join(kSectionNames, ", ")))
      ->delimiter(',');
  command->add_option("--part", selection.parts, "Only this part: name or id (p3)");
  command->add_option("--occurrence", selection.occurrences,
                      "Only this occurrence or subassembly: name, path or end of the path");
  command->add_option("--mate", selection.mates, "Only this mate: id (m12) or key");
  command->add_option("--kind", selection.kinds, "Only mates of this kind: " + ListMateKinds())
      ->delimiter(',');
  command->add_flag("--all", options->is_all, "Do not shorten long lists");
  command
      ->add_option_function<std::string>(
          "--write-assignments",
          [options](const std::string& file) { options->write_assignments = file; },
          "Write a side file with the present fits (NAME.hvas.json when no FILE is given)")
      ->expected(0, 1)
      ->type_name("FILE");
  command->add_flag("--force", options->is_forced, "Allow --write-assignments to replace a file");
  AddLoadOptions(command, &options->load);
  command->footer(
      "Examples:\n"
      "  hvas inspect pump.step\n"
      "  hvas inspect pump.step --only mates,fits --occurrence housing --all\n"
      "  hvas inspect pump.step --only faces --part bracket\n"
      "  hvas inspect pump.step --only identity,relations,surfaces\n"
      "  hvas inspect pump.step --json | jq .summary\n"
      "  hvas inspect pump.step --write-assignments");
  command->callback([options, status] { *status = RunInspect(*options); });
}

}  // namespace hvas::app
