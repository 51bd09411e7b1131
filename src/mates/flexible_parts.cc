#include "mates/flexible_parts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/assignments.h"
#include "product/flexible.h"
#include "product/yielding_forms.h"

namespace hvas::mates {
namespace {

using product::FlexiblePart;
using product::OccurrenceId;
using product::PartId;
using product::Product;

constexpr std::string_view kAll = "all";

/** All occurrences of a name. Fails where there is none. */
Result<std::vector<OccurrenceId>> ListCalled(const Product& product, const std::string& name,
                                             const std::string& where) {
  std::vector<OccurrenceId> called;
  for (const product::Occurrence& occurrence : product.occurrences) {
    if (IsCalled(product, occurrence.id, name)) {
      called.push_back(occurrence.id);
    }
  }
  if (called.empty()) {
    return Fail(ErrorCode::kNotFound, fmt::format("nothing in the product is called \"{}\"", name),
                where.empty() ? product.source : where, "hvas inspect lists names and paths");
  }
  return called;
}

FlexiblePart MakeRigid(OccurrenceId id) {
  return {id, product::FlexibleKind::kStated, 0, "stated"};
}

void Note(const Product& product, const std::map<OccurrenceId, FlexiblePart>& parts,
          Diagnostics* diagnostics) {
  std::map<PartId, std::pair<const FlexiblePart*, int>> by_part;
  for (const auto& [id, part] : parts) {
    auto& [first, count] = by_part[product.occurrences[id.index()].part];
    first = first == nullptr ? &part : first;
    ++count;
  }
  for (const auto& [id, entry] : by_part) {
    const auto& [part, count] = entry;
    diagnostics->Note(
        "flexible-part", product.occurrences[part->occurrence.index()].path,
        fmt::format("may give {:.2f} mm where a way needs it ({}, by {}){}",
                    units::ToMm(part->allowance), product::ToString(part->kind), part->reason,
                    count > 1 ? fmt::format(", and {} more of this part", count - 1) : ""),
        "state another allowance under \"compliant\" in the side file, or name it with --rigid");
  }
}

/** Classifies each part, unless all of them are rigid. */
std::map<OccurrenceId, FlexiblePart> RecogniseFlexible(const Product& product, bool is_all_rigid,
                                                       WorkWatch* watch) {
  std::map<OccurrenceId, FlexiblePart> parts;
  if (is_all_rigid) {
    for (const product::Occurrence& occurrence : product.occurrences) {
      parts[occurrence.id] = MakeRigid(occurrence.id);
    }
    return parts;
  }

  struct Recognised {
    std::optional<FlexiblePart> by_form;
    std::optional<FlexiblePart> by_words;
  };

  std::map<PartId, Recognised> recognised;
  std::map<OccurrenceId, FlexiblePart> in_place;
  for (FlexiblePart& part : product::ListYieldingInPlace(product, watch)) {
    in_place.emplace(part.occurrence, std::move(part));
  }
  for (const product::Occurrence& occurrence : product.occurrences) {
    const product::Part& drawn = product.part_of(occurrence.id);
    const auto [entry, is_new] = recognised.try_emplace(occurrence.part);
    if (is_new) {
      entry->second = {product::ClassifyFlexibleByForm(drawn),
                       product::ClassifyFlexibleByWords(drawn)};
    }
    std::optional<FlexiblePart> part = entry->second.by_form;
    if (const auto found = in_place.find(occurrence.id); !part && found != in_place.end()) {
      part = found->second;
    }
    part = part ? part : entry->second.by_words;
    if (part) {
      part->occurrence = occurrence.id;
      parts[occurrence.id] = std::move(*part);
    }
  }
  return parts;
}

}  // namespace

Result<void> SetFlexibleParts(const std::vector<StatedFlexible>& stated,
                              const std::vector<std::string>& rigid, Product* product,
                              Diagnostics* diagnostics, WorkWatch* watch) {
  const bool is_all_rigid = std::find(rigid.begin(), rigid.end(), kAll) != rigid.end();
  std::map<OccurrenceId, FlexiblePart> parts = RecogniseFlexible(*product, is_all_rigid, watch);
  for (const std::string& name : rigid) {
    if (name == kAll) {
      continue;
    }
    const auto called = ListCalled(*product, name, {});
    if (!called) {
      return Unexpected(called.error());
    }
    for (const OccurrenceId id : *called) {
      parts[id] = MakeRigid(id);
    }
  }
  std::map<OccurrenceId, FlexiblePart> noted = parts;
  std::erase_if(noted, [](const auto& entry) { return entry.second.allowance == 0; });
  for (const StatedFlexible& entry : stated) {
    const auto called = ListCalled(*product, entry.part, entry.where);
    if (!called) {
      return Unexpected(called.error());
    }
    for (const OccurrenceId id : *called) {
      noted.erase(id);
      const auto kind = parts.count(id) > 0 ? parts[id].kind : product::FlexibleKind::kStated;
      parts[id] = entry.allowance > 0 ? FlexiblePart{id, kind, entry.allowance, "the side file"}
                                      : MakeRigid(id);
    }
  }
  Note(*product, noted, diagnostics);
  product->flexible.clear();
  for (auto& [id, part] : parts) {
    product->flexible.push_back(std::move(part));
  }
  return {};
}

}  // namespace hvas::mates
