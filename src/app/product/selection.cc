#include "app/product/selection.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/side_file.h"
#include "mates/user_mate.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using product::Mate;
using product::Occurrence;
using product::Product;

Unexpected FailToFind(const std::string& what, const std::string& name,
                      const std::vector<std::string>& candidates, const std::string& option) {
  const std::string nearest = mates::FindNearest(name, candidates);
  return Fail(ErrorCode::kNotFound, fmt::format("there is no {} \"{}\"", what, name), option,
              nearest.empty() ? "see hvas inspect for what the file contains"
                              : fmt::format("did you mean \"{}\"?", nearest));
}

/** The occurrence itself, or any below a subassembly that is called so. */
bool IsAt(const Product& product, const Occurrence& occurrence, const std::string& name) {
  if (mates::IsCalled(product, occurrence.id, name)) {
    return true;
  }
  const std::string path = "/" + occurrence.path;
  return path.find("/" + name + "/") != std::string::npos;
}

Result<std::vector<bool>> SelectOccurrences(const Product& product,
                                            const std::vector<std::string>& names) {
  std::vector<bool> selected(product.occurrences.size(), names.empty());
  for (const std::string& name : names) {
    bool is_found = false;
    std::vector<std::string> candidates;
    for (const Occurrence& occurrence : product.occurrences) {
      candidates.push_back(occurrence.name);
      candidates.push_back(occurrence.path);
      if (IsAt(product, occurrence, name)) {
        selected[occurrence.id.index()] = is_found = true;
      }
    }
    for (const product::Subassembly& subassembly : product.subassemblies) {
      candidates.push_back(subassembly.name);
    }
    if (!is_found) {
      return FailToFind("occurrence", name, candidates, "--occurrence");
    }
  }
  return selected;
}

Result<std::vector<bool>> SelectParts(const Product& product,
                                      const std::vector<std::string>& names) {
  std::vector<bool> selected(product.parts.size(), names.empty());
  for (const std::string& name : names) {
    bool is_found = false;
    std::vector<std::string> candidates;
    for (const product::Part& part : product.parts) {
      candidates.push_back(part.name);
      if (part.name == name || name == fmt::format("p{}", part.id.value())) {
        selected[part.id.index()] = is_found = true;
      }
    }
    if (!is_found) {
      return FailToFind("part", name, candidates, "--part");
    }
  }
  return selected;
}

/** Kinds of mates as people write them, "axis-hole" or "axis_hole". */
Result<std::vector<bool>> SelectKinds(const std::vector<std::string>& names) {
  const auto& kinds = product::kMateKinds;
  std::vector<bool> selected(kinds.size(), names.empty());
  for (std::string name : names) {
    std::replace(name.begin(), name.end(), '-', '_');
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](auto k) { return name == ToString(k); });
    if (kind == kinds.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("there is no kind of mate \"{}\"", name),
                  "--kind", "write " + ListMateKinds(" or "));
    }
    selected[static_cast<std::size_t>(kind - kinds.begin())] = true;
  }
  return selected;
}

}  // namespace

std::string ListMateKinds(std::string_view before_last) {
  std::string list;
  for (const product::MateKind kind : product::kMateKinds) {
    const bool is_last = kind == product::kMateKinds.back();
    list += list.empty() ? "" : is_last ? before_last : std::string_view(", ");
    list += ToString(kind);
  }
  std::replace(list.begin(), list.end(), '_', '-');
  return list;
}

Selection::Selection(const Product& product)
    : parts_(product.parts.size(), true),
      occurrences_(product.occurrences.size(), true),
      mates_(product.mates.size(), true) {
  std::fill(sections_.begin(), sections_.begin() + static_cast<int>(Section::kIdentity), true);
}

Result<Selection> Selection::Make(const Product& product, const SelectionOptions& options) {
  Selection selection(product);
  if (!options.only.empty()) {
    selection.is_chosen_ = true;
    selection.sections_.fill(false);
  }
  for (const std::string& name : options.only) {
    const auto section = std::find(kSectionNames.begin(), kSectionNames.end(), name);
    if (section == kSectionNames.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("there is no section \"{}\"", name), "--only",
                  fmt::format("the sections are {}", fmt::join(kSectionNames, ", ")));
    }
    selection.sections_[static_cast<std::size_t>(section - kSectionNames.begin())] = true;
  }
  const auto occurrences = SelectOccurrences(product, options.occurrences);
  const auto parts = SelectParts(product, options.parts);
  const auto kinds = SelectKinds(options.kinds);
  for (const auto* result : {&occurrences, &parts, &kinds}) {
    if (!*result) {
      return Unexpected(result->error());
    }
  }
  std::vector<bool> named(product.mates.size(), options.mates.empty());
  for (const std::string& name : options.mates) {
    const Result<product::MateId> mate = mates::FindMate(product, name);
    if (!mate) {
      return Unexpected(mate.error());
    }
    named[mate->index()] = true;
  }
  std::vector<bool> at_mates(product.occurrences.size(), options.mates.empty());
  const auto is_selected = [&](product::OccurrenceId id) {
    return (*occurrences)[id.index()] && (*parts)[product.occurrences[id.index()].part.index()];
  };
  for (const Mate& mate : product.mates) {
    selection.mates_[mate.id.index()] =
        named[mate.id.index()] && (*kinds)[static_cast<std::size_t>(mate.kind)] &&
        (is_selected(mate.a.occurrence) || is_selected(mate.b.occurrence));
    if (named[mate.id.index()]) {
      at_mates[mate.a.occurrence.index()] = at_mates[mate.b.occurrence.index()] = true;
    }
  }
  std::fill(selection.parts_.begin(), selection.parts_.end(), false);
  for (const Occurrence& occurrence : product.occurrences) {
    const bool is_in = is_selected(occurrence.id) && at_mates[occurrence.id.index()];
    selection.occurrences_[occurrence.id.index()] = is_in;
    selection.parts_[occurrence.part.index()] = selection.parts_[occurrence.part.index()] || is_in;
  }
  selection.is_filtered_ = !options.parts.empty() || !options.occurrences.empty() ||
                           !options.mates.empty() || !options.kinds.empty();
  return selection;
}

}  // namespace hvas::app
