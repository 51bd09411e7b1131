#include "app/product/mate.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/json_flag.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/product/load_product.h"
#include "app/product/product_json.h"
#include "app/product/product_text.h"
#include "app/product/side_document.h"
#include "base/shell_words.h"
#include "mates/assignments.h"
#include "mates/user_mate.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using nlohmann::ordered_json;
using product::Mate;
using product::Product;

struct MateOptions {
  LoadOptions load;
  std::string a, b;                ///< "OCCURRENCE:FACE", of add.
  std::string fit;                 ///< Of add.
  std::vector<std::string> mates;  ///< Of remove and restore.
  bool is_json{false};             ///< Of list.
};

/** A product with and without its side file. */
struct Opened {
  Product inferred;
  SideDocument document;
  Product product;
  mates::MateChanges changes;
};

Result<Opened> Open(const MateOptions& options) {
  // The side file first: reading it takes no time.
  Result<SideDocument> document = SideDocument::Open(mates::FindAssignmentFile(options.load.file));
  if (!document) {
    return Unexpected(document.error());
  }
  Diagnostics diagnostics;
  Result<Product> inferred = LoadInferred(options.load, &diagnostics);
  if (!inferred) {
    return Unexpected(inferred.error());
  }
  Opened opened{*std::move(inferred), *std::move(document), {}, {}};
  opened.product = opened.inferred;
  WorkWatch watch = MakeWorkWatch(options.load);
  Result<mates::MateChanges> changes =
      mates::ApplySideFile(opened.document.contents(), &opened.product, &watch);
  if (!changes) {
    return Unexpected(changes.error());
  }
  opened.changes = *std::move(changes);
  return opened;
}

/** The last mate of a file must not contradict those before it. */
Result<void> CheckLast(const Product& product, const mates::MateChanges& changes) {
  const std::string& key = product.mates[changes.added.back().index()].key;
  for (const mates::MateContradiction& contradiction : changes.contradictions) {
    if (contradiction.mate == key) {
      return Fail(ErrorCode::kInvalid, contradiction.message, product.source,
                  "remove those mates first, or choose other surfaces");
    }
  }
  return {};
}

/** Writes the side file if a product with it is whole, and puts that into `opened`.
 @param is_checked  Whether the last mate must not contradict the others. */
Result<void> Commit(Opened* opened, bool is_checked = false) {
  Product product = opened->inferred;
  Result<mates::MateChanges> changes = mates::ApplySideFile(opened->document.contents(), &product);
  if (!changes) {
    Error error = changes.error();
    // Its lines are those of a file that is not to be.
    error.where = opened->document.contents().path.string();
    return Unexpected(std::move(error));
  }
  if (is_checked) {
    if (auto agrees = CheckLast(product, *changes); !agrees) {
      return agrees;
    }
  }
  opened->product = std::move(product);
  opened->changes = *std::move(changes);
  return opened->document.Write();
}

std::string Describe(const Product& product, const Mate& mate) {
  std::string kind = ToString(mate.kind);
  std::replace(kind.begin(), kind.end(), '_', ' ');
  return fmt::format("{} {}: {} <- {}", mate.key, kind,
                     product.occurrences[mate.a.occurrence.index()].path,
                     product.occurrences[mate.b.occurrence.index()].path);
}

/** "housing:12", "housing:face12" or "housing:feature3". */
Result<ordered_json> ReadSide(const Product& product, const std::string& text,
                              const std::string& option) {
  const std::size_t colon = text.rfind(':');
  std::string_view number = std::string_view(text).substr(std::min(colon, text.size() - 1) + 1);
  const char* key = "face";
  for (const char* prefix : {"face", "feature"}) {
    if (number.starts_with(prefix)) {
      key = prefix;
      number.remove_prefix(std::string_view(prefix).size());
      break;
    }
  }
  std::uint32_t index = 0;
  const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (colon == std::string::npos || colon == 0 || code != std::errc() ||
      end != number.data() + number.size()) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" does not identify a surface", text),
                option,
                "write OCCURRENCE:12 with the number of a face, or OCCURRENCE:feature3; hvas "
                "inspect --only faces,features lists them");
  }
  const auto occurrence = mates::FindOccurrence(product, text.substr(0, colon));
  if (!occurrence) {
    Error error = occurrence.error();
    error.where = option;
    return Unexpected(std::move(error));
  }
  // The path, which stays unique whatever else gets a name.
  return ordered_json{{"occurrence", product.occurrences[occurrence->index()].path}, {key, index}};
}

Result<void> Add(const MateOptions& options) {
  Result<Opened> opened = Open(options);
  if (!opened) {
    return Unexpected(opened.error());
  }
  const Result<ordered_json> a = ReadSide(opened->product, options.a, "--a");
  const Result<ordered_json> b = ReadSide(opened->product, options.b, "--b");
  if (!a || !b) {
    return Unexpected(a ? b.error() : a.error());
  }
  const std::size_t before = opened->product.mates.size();
  ordered_json entry{{"a", *a}, {"b", *b}};
  if (!options.fit.empty()) {
    entry["fit"] = options.fit;
  }
  opened->document.Append("mates", entry);
  if (auto written = Commit(&*opened, /*is_checked=*/true); !written) {
    return written;
  }
  const Mate& mate = opened->product.mates[opened->changes.added.back().index()];
  fmt::print(
      "{} m{} {}\n  in {}; undo: hvas mate remove {} {}\n",
      opened->product.mates.size() > before ? "added"
                                            : "was inferred already, now marked as the user's:",
      mate.id.value(), Describe(opened->product, mate), opened->document.contents().path.string(),
      QuoteWord(options.load.file.string()), mate.key);
  return {};
}

/** How to bring back an entry of "mates". */
std::string DescribeUndo(const ordered_json& entry, const std::string& file) {
  const auto side = [](const ordered_json& json) {
    const bool is_face = json.contains("face");
    return QuoteWord(fmt::format("{}:{}{}", json["occurrence"].get<std::string>(),
                                 is_face ? "face" : "feature",
                                 json[is_face ? "face" : "feature"].get<std::uint32_t>()));
  };
  return fmt::format("hvas mate add {} --a {} --b {}{}", file, side(entry["a"]), side(entry["b"]),
                     entry.contains("fit") ? " --fit " + entry["fit"].get<std::string>() : "");
}

/** Takes one mate out of what the side file makes of the product. @returns what to tell. */
Result<std::string> RemoveOne(const std::string& key, const std::string& file, Opened* opened) {
  const auto mate = mates::FindMate(opened->product, key);
  if (!mate) {
    return Unexpected(mate.error());
  }
  std::string undo = fmt::format("hvas mate restore {} {}", file, key);
  const std::string what = Describe(opened->product, opened->product.mates[mate->index()]);
  const std::string note = what.substr(std::min(what.size(), key.size() + 1));
  auto& added = opened->changes.added;
  const bool is_added = std::find(added.begin(), added.end(), *mate) != added.end();
  if (const auto mine = std::find(added.begin(), added.end(), *mate); mine != added.end()) {
    undo = DescribeUndo(
        opened->document.Take("mates", static_cast<std::size_t>(mine - added.begin())), file);
    added.erase(mine);
  }
  const auto is_it = [&key](const Mate& other) { return other.key == key; };
  // Where mates of the user have put the parts, inference finds others than in the drawn poses.
  const bool is_inferred =
      !is_added || std::any_of(opened->inferred.mates.begin(), opened->inferred.mates.end(), is_it);
  const bool is_removed =
      std::any_of(opened->changes.removed.begin(), opened->changes.removed.end(), is_it);
  if (is_inferred && !is_removed) {
    opened->document.Append("removed", {{"mate", key}, {"note", note}});
  }
  return fmt::format("removed {}\n  undo: {}\n", what, undo);
}

Result<void> Remove(const MateOptions& options) {
  Result<Opened> opened = Open(options);
  if (!opened) {
    return Unexpected(opened.error());
  }
  std::vector<std::string> keys;  // Numbers mean what they mean before any is removed.
  for (const std::string& name : options.mates) {
    const auto& removed = opened->changes.removed;
    if (std::any_of(removed.begin(), removed.end(),
                    [&name](const Mate& mate) { return mate.key == name; })) {
      return Fail(ErrorCode::kInvalid, fmt::format("mate {} is removed already", name),
                  opened->document.contents().path.string(), "hvas mate restore restores it");
    }
    const auto mate = mates::FindMate(opened->product, name);
    if (!mate) {
      return Unexpected(mate.error());
    }
    const std::string& key = opened->product.mates[mate->index()].key;
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      keys.push_back(key);
    }
  }
  std::string told;
  for (const std::string& key : keys) {
    const auto removed = RemoveOne(key, QuoteWord(options.load.file.string()), &*opened);
    if (!removed) {
      return Unexpected(removed.error());
    }
    told += *removed;
  }
  auto written = Commit(&*opened);
  if (written) {
    fmt::print("{}", told);
  }
  return written;
}

/** Needs no product, so that it also mends a side file that fits it no more. */
Result<void> Restore(const MateOptions& options) {
  Result<SideDocument> document = SideDocument::Open(mates::FindAssignmentFile(options.load.file));
  if (!document) {
    return Unexpected(document.error());
  }
  std::string told;
  for (const std::string& key : options.mates) {
    const auto& removed = document->contents().removed;
    const auto found =
        std::find_if(removed.begin(), removed.end(),
                     [&key](const mates::RemovedMate& entry) { return entry.mate == key; });
    if (found == removed.end()) {
      std::vector<std::string> keys;
      std::transform(removed.begin(), removed.end(), std::back_inserter(keys),
                     [](const mates::RemovedMate& entry) { return entry.mate; });
      return Fail(ErrorCode::kNotFound, fmt::format("mate \"{}\" is not removed", key),
                  document->contents().path.string(),
                  keys.empty() ? "no mate is removed"
                               : fmt::format("removed are {}", fmt::join(keys, ", ")));
    }
    document->Take("removed", static_cast<std::size_t>(found - removed.begin()));
    told += fmt::format("restored {}\n  undo: hvas mate remove {} {}\n", key,
                        QuoteWord(options.load.file.string()), key);
  }
  auto written = document->Write();
  if (written) {
    fmt::print("{}", told);
  }
  return written;
}

Result<void> List(const MateOptions& options) {
  const Result<Opened> opened = Open(options);
  if (!opened) {
    return Unexpected(opened.error());
  }
  if (options.is_json) {
    ordered_json json{{"format", "hvas-mates-1"},
                      {"source", opened->product.source},
                      {"mates", MatesToJson(opened->product.mates)},
                      {"removed", MatesToJson(opened->changes.removed)}};
    fmt::print("{}\n", json.dump(2, ' ', false, ordered_json::error_handler_t::replace));
    return {};
  }
  for (const Mate& mate : opened->product.mates) {
    PrintMate(opened->product, mate, /*with_evidence=*/false);
  }
  for (const Mate& mate : opened->changes.removed) {
    fmt::print("{}", Fold("removed " + Describe(opened->product, mate)));
  }
  fmt::print("{} mates, {} by the user; {} removed\n", opened->product.mates.size(),
             opened->changes.added.size(), opened->changes.removed.size());
  return {};
}

/** A subcommand that does `run` with options of its own. */
CLI::App* AddCommand(CLI::App* parent, const char* name, const char* help,
                     const std::shared_ptr<MateOptions>& options, int* status,
                     Result<void> (*run)(const MateOptions&)) {
  CLI::App* command = parent->add_subcommand(name, help);
  command
      ->add_option("file", options->load.file,
                   "CAD file; the command edits NAME.hvas.json beside it")
      ->required();
  command->callback([options, status, run] {
    const Result<void> done = run(*options);
    *status = done ? 0 : ReportFailure(done.error());
  });
  return command;
}

}  // namespace

void AddMate(CLI::App* app, int* status) {
  CLI::App* mate = app->add_subcommand("mate", "Add, remove, restore and list mates of a CAD file");
  mate->require_subcommand(1);
  mate->footer(
      "Examples:\n"
      "  hvas mate list pump.step\n"
      "  hvas mate add pump.step --a housing:12 --b 'dowel pin 1:3' --fit H7/k6\n"
      "  hvas mate remove pump.step m12 3f2a01bc9d\n"
      "  hvas mate restore pump.step 3f2a01bc9d");

  auto options = std::make_shared<MateOptions>();
  CLI::App* add = AddCommand(mate, "add", "Mate two surfaces", options, status, Add);
  add->add_option("--a", options->a,
                  "A surface: OCCURRENCE:12 with the number of a face, or OCCURRENCE:feature3")
      ->required();
  add->add_option("--b", options->b, "The other surface")->required();
  add->add_option("--fit", options->fit, "ISO 286 fit of a hole and a shaft, or thread");
  AddLoadOptions(add, &options->load);
  add->footer(
      "hvas inspect FILE --only faces,features --part NAME lists the surfaces.\n"
      "Examples:\n"
      "  hvas mate add pump.step --a housing:12 --b 'dowel pin 1:3' --fit H7/k6\n"
      "  hvas mate add pump.step --a 'pump/cover:feature0' --b 'pump/gasket:feature1'");

  options = std::make_shared<MateOptions>();
  CLI::App* remove =
      AddCommand(mate, "remove", "Remove mates, inferred or added ones", options, status, Remove);
  remove->add_option("mates", options->mates, "Ids (m12) or keys of mates")->required();
  AddLoadOptions(remove, &options->load);
  remove->footer("Example:\n  hvas mate remove pump.step m12 3f2a01bc9d");

  options = std::make_shared<MateOptions>();
  CLI::App* restore =
      AddCommand(mate, "restore", "Restore removed mates", options, status, Restore);
  restore->add_option("mates", options->mates, "Keys of mates (hvas mate list)")->required();
  restore->footer("Example:\n  hvas mate restore pump.step 3f2a01bc9d");

  options = std::make_shared<MateOptions>();
  CLI::App* list =
      AddCommand(mate, "list", "List the mates and the removed mates", options, status, List);
  AddJsonFlag(list, &options->is_json, "mate_list");
  AddLoadOptions(list, &options->load);
  list->footer("Example:\n  hvas mate list pump.step --json | jq '.mates[].key'");
}

}  // namespace hvas::app
