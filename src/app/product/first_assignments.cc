#include "app/product/first_assignments.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/product/product_json.h"
#include "base/units.h"
#include "mates/mate_kind.h"
#include "mates/side_file.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::Mate;
using product::Product;

/** Mates of equal parts and fits get equal keys, in the order of parts. */
auto GroupOf(const Product& product, const Mate& mate) {
  return std::tuple(product.occurrences[mate.a.occurrence.index()].part,
                    product.occurrences[mate.b.occurrence.index()].part, mate.hole_radius,
                    mate.shaft_radius, mate.id);
}

Json MakeEntry(const Product& product, const Mate& mate) {
  const auto path = [&product](const product::Connector& side) {
    return product.occurrences[side.occurrence.index()].path;
  };
  Json entry{{"mate", mate.key}};
  const product::Fit& fit = *mate.fit;
  entry["fit"] = fit.kind == product::FitKind::kThread ? "thread" : fit.code;
  entry.update(ConditionsToJson(mate));
  entry["note"] = fmt::format("{}{}, {:.6g} mm: {} <- {}{}", fit.is_proposed ? "proposed " : "",
                              ToString(fit.kind), units::ToMm(fit.nominal_diameter), path(mate.a),
                              path(mate.b), fit.reason.empty() ? "" : " (" + fit.reason + ")");
  return entry;
}

}  // namespace

Json MakeFirstAssignments(const Product& product) {
  std::vector<const Mate*> mates;
  for (const Mate& mate : product.mates) {
    const bool has_fit =
        mate.fit && (mate.fit->kind == product::FitKind::kThread || !mate.fit->code.empty());
    if (mates::HasFit(mate.kind) && has_fit) {
      mates.push_back(&mate);
    }
  }
  std::sort(mates.begin(), mates.end(), [&product](const Mate* first, const Mate* second) {
    return GroupOf(product, *first) < GroupOf(product, *second);
  });
  Json document{
      {"format", mates::kSideFileFormat},
      {"note", "Fits of " + product.source +
                   "; proposed fits are guesses from the drawn sizes and have to be checked."},
      {"fits", Json::array()}};
  for (const Mate* mate : mates) {
    document["fits"].push_back(MakeEntry(product, *mate));
  }
  return document;
}

}  // namespace hvas::app
