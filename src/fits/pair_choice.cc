#include "fits/pair_choice.h"

#include <algorithm>

#include "fits/actual_size.h"

namespace hvas::fits {
namespace {

// Shares of the length with S < 0 between which a force has stairs that can be told from a slope
// and from nothing: a choice.
constexpr double kLeastShare = 0.2;
constexpr double kMostShare = 0.8;

/** Share of an interval in which a linear function with these ends is negative. */
double CalcNegativeShare(double a, double b) noexcept {
  if (a < 0 && b < 0) {
    return 1;
  }
  if (a >= 0 && b >= 0) {
    return 0;
  }
  return std::min(a, b) / (std::min(a, b) - std::max(a, b));
}

double DrawDiameter(const SideToDraw& side, const PairToDraw& pair, double nominal,
                    Random* random) {
  if (!side.zone) {
    return side.drawn * side.expansion;
  }
  const double by_chance = DrawDeviation(*side.zone, random);
  const double middle =
      pair.kind == FitKind::kTransition ? 0 : 0.5 * (side.zone->lower + side.zone->upper);
  return (nominal + (pair.choice == PairChoice::kOnePair ? middle : by_chance)) * side.expansion;
}

}  // namespace

ClearanceShape CalcClearanceShape(std::span<const double> clearances) noexcept {
  ClearanceShape shape;
  if (clearances.empty()) {
    return shape;
  }
  shape.rises = clearances.front() < 0 ? 1 : 0;
  for (std::size_t j = 1; j < clearances.size(); ++j) {
    shape.interference_share += CalcNegativeShare(clearances[j - 1], clearances[j]);
    shape.rises += clearances[j - 1] >= 0 && clearances[j] < 0 ? 1 : 0;
  }
  shape.interference_share /= static_cast<double>(std::max<std::size_t>(1, clearances.size() - 1));
  return shape;
}

bool ShowsKind(std::span<const double> clearances, FitKind kind) noexcept {
  const auto is_clear = [](double s) { return s > 0; };
  const auto is_tight = [](double s) { return s < 0; };
  switch (kind) {
    case FitKind::kClearance:
      return std::all_of(clearances.begin(), clearances.end(), is_clear);
    case FitKind::kInterference:
      return std::all_of(clearances.begin(), clearances.end(), is_tight);
    case FitKind::kTransition:
      break;
  }
  const ClearanceShape shape = CalcClearanceShape(clearances);
  return shape.rises >= 2 && shape.interference_share >= kLeastShare &&
         shape.interference_share <= kMostShare;
}

bool DrawPair(const PairToDraw& pair, Random* random, FitForceParameters* parameters) {
  const double nominal = parameters->nominal_diameter;
  for (int tries = 0; tries < kMostPairsDrawn; ++tries) {
    parameters->hole_diameter = DrawDiameter(pair.hole, pair, nominal, random);
    parameters->shaft_diameter = DrawDiameter(pair.shaft, pair, nominal, random);
    parameters->seed = random->NextBits();
    if (pair.choice == PairChoice::kAny || ShowsKind(DrawClearances(*parameters), pair.kind)) {
      return true;
    }
  }
  return false;
}

}  // namespace hvas::fits
