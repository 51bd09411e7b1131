#include "app/product/overlaps_report.h"

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/product/drawing_errors_report.h"
#include "base/crash_note.h"
#include "base/units.h"
#include "mates/drawn_volumes.h"
#include "mates/elastic_parts.h"
#include "product/flexible.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using mates::SharedVolume;
using product::ElasticPart;
using product::FlexiblePart;
using product::Product;
using units::ToMm;

std::vector<SharedVolume> ListShared(const Product& product, const Selection& selection,
                                     WorkWatch* watch) {
  NoteStage("overlaps as drawn");
  std::vector<SharedVolume> list = mates::ListSharedVolumes(product, watch);
  std::erase_if(list, [&](const SharedVolume& shared) {
    return !selection.Has(shared.a) && !selection.Has(shared.b);
  });
  return list;
}

ErrorFilter MakeFilter(const Selection& selection) {
  return [&selection](const product::DrawingError& error) {
    return selection.Has(error.a) || selection.Has(error.b);
  };
}

/** What is made of an overlap: "pin 3 mm in hole 2.9 mm: press fit as drawn, 100 um". */
std::string Describe(const Product& product, const SharedVolume& shared) {
  if (product::FindDrawingError(product, shared.a, shared.b) != nullptr) {
    return "an error of the drawing: no joint of this kind and size is as deep";
  }
  if (!shared.mate.is_valid()) {
    return "an overlap: what goes in last needs an allowance of this depth";
  }
  const product::Mate& mate = product.mates[shared.mate.index()];
  const bool is_thread = shared.cause == SharedVolume::Cause::kThread;
  return fmt::format("{} {:.4g} mm in hole {:.4g} mm: {} as drawn, {:.4g} um",
                     is_thread ? "thread" : "pin", ToMm(2 * mate.shaft_radius),
                     ToMm(2 * mate.hole_radius), is_thread ? "threaded joint" : "press fit",
                     2 * units::ToUm(shared.depth));
}

void PrintShared(const Product& product, const std::vector<SharedVolume>& list, bool is_all) {
  fmt::print("\nOverlaps as drawn\n");
  TextTable table({"parts", "depth\nmm", "volume\nmm3"}, 1);
  ListLimit limit(is_all);
  for (const SharedVolume& shared : list) {
    if (limit.Next()) {
      table.Add({fmt::format("{}, {}", Shorten(product.occurrences[shared.a.index()].path, 24),
                             Shorten(product.occurrences[shared.b.index()].path, 24)),
                 fmt::format("{:.3f}", ToMm(shared.depth)),
                 fmt::format("{:.3g}", units::ToMm3(shared.volume))},
                Describe(product, shared));
    }
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

void PrintFlexible(const Product& product, const std::vector<FlexiblePart>& parts, bool is_all) {
  fmt::print("\nParts that may give on a way, each by as much as it says\n");
  TextTable table({"part", "mm", "kind", "by"}, 1);
  ListLimit limit(is_all);
  for (const FlexiblePart& part : parts) {
    if (limit.Next()) {
      table.Add({Shorten(product.occurrences[part.occurrence.index()].path, 36),
                 fmt::format("{:.2f}", ToMm(part.allowance)), ToString(part.kind),
                 Shorten(part.reason, 24)});
    }
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

void PrintElastic(const Product& product, const std::vector<ElasticPart>& parts, bool is_all) {
  fmt::print("\nParts that push back, with the sizes of their force\n");
  TextTable table({"part", "kind", "by"}, 1);
  ListLimit limit(is_all);
  for (const ElasticPart& part : parts) {
    if (limit.Next()) {
      table.Add({Shorten(product.occurrences[part.occurrence.index()].path, 36),
                 ToString(part.kind), Shorten(part.reason, 28)},
                mates::DescribeElastic(part));
    }
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

std::vector<ElasticPart> ListElastic(const Product& product, const Selection& selection) {
  std::vector<ElasticPart> parts = product.elastic;
  std::erase_if(parts, [&](const ElasticPart& part) { return !selection.Has(part.occurrence); });
  return parts;
}

Json RateOf(const ElasticPart& part, const std::optional<fits::PressedPart>& pressed) {
  if (part.kind == product::ElasticKind::kLipSeal && mates::FindMissingSize(part).empty()) {
    return mates::CalcLipStiffness(part);
  }
  return pressed ? Json(fits::CalcPressRate(*pressed)) : Json();
}

Json ToJson(const ElasticPart& part) {
  const auto pressed = mates::MakePressedPart(part);
  const double compression = mates::CalcCompression(part);
  return {{"occurrence", part.occurrence.value()},
          {"kind", ToString(part.kind)},
          {"length_mm", ToMm(part.length)},
          {"outer_mm", ToMm(part.outer)},
          {"inner_mm", ToMm(part.inner)},
          {"thickness_mm", ToMm(part.thickness)},
          {"lip_length_mm", ToMm(part.lip_length())},
          {"active_coils", part.coils},
          {"area_mm2", part.area / (units::kMetresPerMillimetre * units::kMetresPerMillimetre)},
          {"free_size_mm", ToMm(part.free_size)},
          {"youngs_modulus_pa", part.modulus},
          {"stiffness_n_per_m", RateOf(part, pressed)},
          {"compression_mm", ToMm(compression)},
          {"force_n", pressed ? Json(fits::CalcPressForce(*pressed, compression)) : Json()},
          {"reason", part.reason},
          {"description", mates::DescribeElastic(part)}};
}

std::vector<FlexiblePart> ListFlexible(const Product& product, const Selection& selection) {
  std::vector<FlexiblePart> parts = product.flexible;
  std::erase_if(parts, [&](const FlexiblePart& part) {
    return part.allowance == 0 || !selection.Has(part.occurrence);
  });
  return parts;
}

}  // namespace

void AddOverlaps(const Product& product, const Selection& selection, WorkWatch* watch, Json* json) {
  (*json)["drawing_errors"] = MakeDrawingErrorsJson(product, MakeFilter(selection));
  Json& overlaps = (*json)["overlaps"] = Json::array();
  for (const SharedVolume& shared : ListShared(product, selection, watch)) {
    overlaps.push_back({{"a", shared.a.value()},
                        {"b", shared.b.value()},
                        {"depth_mm", ToMm(shared.depth)},
                        {"volume_mm3", units::ToMm3(shared.volume)},
                        {"cause", ToString(shared.cause)},
                        {"mate", shared.mate.is_valid() ? Json(shared.mate.value()) : Json()},
                        {"description", Describe(product, shared)}});
  }
  Json& flexible = (*json)["flexible_parts"] = Json::array();
  for (const FlexiblePart& part : ListFlexible(product, selection)) {
    flexible.push_back({{"occurrence", part.occurrence.value()},
                        {"kind", ToString(part.kind)},
                        {"allowance_mm", ToMm(part.allowance)},
                        {"reason", part.reason}});
  }
  Json& elastic = (*json)["elastic_parts"] = Json::array();
  for (const ElasticPart& part : ListElastic(product, selection)) {
    elastic.push_back(ToJson(part));
  }
}

void PrintOverlaps(const Product& product, const Selection& selection, bool is_all,
                   WorkWatch* watch) {
  PrintDrawingErrors(product, is_all, MakeFilter(selection));
  const std::vector<SharedVolume> shared = ListShared(product, selection, watch);
  if (!shared.empty()) {
    PrintShared(product, shared, is_all);
  }
  const std::vector<FlexiblePart> flexible = ListFlexible(product, selection);
  if (!flexible.empty()) {
    PrintFlexible(product, flexible, is_all);
  }
  const std::vector<ElasticPart> elastic = ListElastic(product, selection);
  if (!elastic.empty()) {
    PrintElastic(product, elastic, is_all);
  }
}

}  // namespace hvas::app
