#include "mates/unit_doubt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/threads.h"
#include "product/fastener_name.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::Part;

/** A screw or nut by its name or shape, with the diameter at which its thread is drawn. */
struct DrawnFastener {
  const Part* part;
  double drawn;   // [m]
  double stated;  // By the name; 0: it states none [m].
};

/** A factor by which a drawing is too large when its unit is wrong. */
struct UnitError {
  double factor;
  const char* words;
  const char* unit;  // The name of the right one, as --unit has it.
};

constexpr std::array kUnitErrors{UnitError{25.4, "inches in place of millimetres", "mm"},
                                 UnitError{1000, "metres in place of millimetres", "mm"},
                                 UnitError{10, "centimetres in place of millimetres", "mm"},
                                 UnitError{1 / 25.4, "millimetres in place of inches", "in"},
                                 UnitError{1e-3, "millimetres in place of metres", "m"},
                                 UnitError{0.1, "millimetres in place of centimetres", "cm"}};

std::vector<DrawnFastener> ListFasteners(const product::Product& product) {
  std::vector<DrawnFastener> fasteners;
  for (const Part& part : product.parts) {
    const auto thread = std::find_if(
        part.features.begin(), part.features.end(),
        [](const Feature& feature) { return feature.thread != product::ThreadKind::kNone; });
    if (thread != part.features.end()) {
      const auto stated = product::ParseThreadSize(part.name);
      fasteners.push_back({&part, 2 * thread->radius, stated ? stated->diameter : 0});
    }
  }
  return fasteners;
}

/** Whether a fastener, drawn `factor` times too large, is what its name says, or a usual size. */
bool IsPlausible(const DrawnFastener& fastener, double factor) {
  constexpr double kCore = 0.75;      // Threads may be drawn at their core.
  constexpr double kRounding = 1.03;  // Or a little above their diameter.
  const double diameter = fastener.drawn / factor;
  if (fastener.stated > 0) {
    return diameter > kCore * fastener.stated && diameter < kRounding * fastener.stated;
  }
  return fits::FindThread(diameter, 0) != nullptr;
}

/** Whether it may be drawn to scale: what states no size need not have one of the tables. */
bool MayBeToScale(const DrawnFastener& fastener) {
  constexpr double kSmallest = 1e-3;  // [m]: watchmakers' screws aside.
  constexpr double kLargest = 0.1;    // [m]: foundation bolts end there.
  return fastener.stated > 0 ? IsPlausible(fastener, 1)
                             : fastener.drawn > kSmallest && fastener.drawn < kLargest;
}

}  // namespace

void ReportDoubtfulUnit(const product::Product& product, Diagnostics* diagnostics) {
  const std::vector<DrawnFastener> fasteners = ListFasteners(product);
  const auto are_all_plausible = [&fasteners](double factor) {
    return std::all_of(fasteners.begin(), fasteners.end(), [factor](const DrawnFastener& fastener) {
      return IsPlausible(fastener, factor);
    });
  };
  if (fasteners.empty() || std::any_of(fasteners.begin(), fasteners.end(), MayBeToScale)) {
    return;
  }
  const auto error = std::find_if(kUnitErrors.begin(), kUnitErrors.end(),
                                  [&](const UnitError& e) { return are_all_plausible(e.factor); });
  if (error == kUnitErrors.end()) {
    return;
  }
  const DrawnFastener& first = fasteners.front();
  diagnostics->Warn(
      "unit-doubtful", first.part->name,
      fmt::format(
          "its thread is drawn with a diameter of {:.4g} mm: does the file state {}? With the "
          "other unit all {} different fasteners are usual ones, this one of {:.4g} mm",
          units::ToMm(first.drawn), error->words, fasteners.size(),
          units::ToMm(first.drawn / error->factor)),
      fmt::format("open it with --unit {}, or export the product again with the unit in which it "
                  "was drawn",
                  error->unit));
}

}  // namespace hvas::mates
