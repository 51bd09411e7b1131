#include "fits/joint_friction.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "fits/friction.h"

namespace hvas::fits {
namespace {

using Names = std::vector<std::string_view>;

/** Which rows of the table are a pair's. */
struct Rows {
  Names longitudinal, transverse, design;
};

Rows RowsOf(const Material& other) {
  const auto is_named = [&other](std::string_view word) {
    return other.name.find(word) != std::string_view::npos;
  };
  switch (SurfaceOf(other.group)) {
    case FrictionSurface::kSteel: {
      const Names grade = is_named("S235")              ? Names{"steel / S235"}
                          : other.group == "cast steel" ? Names{"steel / GE300"}
                                                        : Names{"steel / E335", "steel / S235"};
      return {grade, {"steel / steel"}, {"steel / steel"}};
    }
    case FrictionSurface::kCastIron:
      return {{is_named("GJL") ? "steel / EN-GJL-250" : "steel / EN-GJS-600-3"},
              {"steel / cast iron"},
              {"steel / grey iron"}};
    case FrictionSurface::kLightMetal:
      return {{"steel / AlSi12"}, {"steel / magnesium, aluminium"}, {"steel / aluminium"}};
    case FrictionSurface::kCopperAlloy:
      return {{"steel / G-CuPb10Sn"}, {"steel / brass"}, {"steel / copper alloy"}};
    case FrictionSurface::kPolymer:
    case FrictionSurface::kUnknown:
      break;
  }
  return {};
}

/** The lowest and the highest value of some rows. */
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{0};
  std::string_view pair, condition, source;  // Of the lowest.

  [[nodiscard]] bool is_empty() const { return !(high > 0); }
};

template <typename Fits>
Range Collect(const Names& pairs, const Fits& fits) {
  Range range;
  for (const JointFriction& row : JointFrictionTable()) {
    if (std::find(pairs.begin(), pairs.end(), row.pair) == pairs.end() || !fits(row)) {
      continue;
    }
    if (row.low < range.low) {
      range.low = row.low;
      range.pair = row.pair;
      range.condition = row.condition;
      range.source = row.source;
    }
    range.high = std::max(range.high, row.high);
  }
  return range;
}

bool HasWord(const JointFriction& row, std::string_view word) {
  return row.condition.find(word) != std::string_view::npos;
}

std::string SourceOf(const Range& range) {
  return fmt::format("{}, {}, {}", range.pair, range.condition, range.source);
}

PressFriction MakeAssumedFriction() {
  return {0.2, 0.05, 0.05,
          "assumed, because the table does not have this pair of materials; give --mu", true};
}

/** Of transverse fits; where a table has the normal state, not the degreased one. */
Range FindTransverse(const Rows& rows, bool is_oiled) {
  const auto is_transverse = [](const JointFriction& row) {
    return row.condition.starts_with("transverse");
  };
  const Range usual = Collect(rows.transverse, [&](const JointFriction& row) {
    return is_transverse(row) && (HasWord(row, "mineral oil") == is_oiled) &&
           !HasWord(row, "degreased");
  });
  return usual.is_empty() ? Collect(rows.transverse, is_transverse) : usual;
}

}  // namespace

PressFriction FindPressFriction(const Material& hub, const Material& shaft, const JoiningWay& way) {
  const bool is_hub_steel = SurfaceOf(hub.group) == FrictionSurface::kSteel;
  if (!is_hub_steel && SurfaceOf(shaft.group) != FrictionSurface::kSteel) {
    return MakeAssumedFriction();
  }
  // DIN names the hub beside a shaft of steel; of a hub of steel on another shaft that one counts.
  const Rows rows =
      RowsOf(is_hub_steel && SurfaceOf(shaft.group) != FrictionSurface::kSteel ? shaft : hub);
  const std::string_view state = way.is_oiled ? "oiled" : "dry";
  const auto pressed = [&](std::string_view symbol) {
    return Collect(rows.longitudinal, [&](const JointFriction& row) {
      return row.condition.starts_with("longitudinal") && HasWord(row, state) &&
             row.symbol == symbol;
    });
  };
  const Range design = Collect(rows.design, [&](const JointFriction& row) {
    return row.condition.starts_with("pressed") &&
           (HasWord(row, state) || (!HasWord(row, "dry") && !HasWord(row, "oiled")));
  });
  Range release = pressed("nu_ll");
  release = release.is_empty() ? design : release;
  if (release.is_empty()) {
    return MakeAssumedFriction();
  }
  const double in = std::max(release.high, design.high);
  if (way.is_shrunk) {
    const Range held = FindTransverse(rows, way.is_oiled);
    return {std::max(in, held.low), held.low, held.low, SourceOf(held)};
  }
  const Range slip = pressed("nu_rl");
  return {in, release.low, slip.is_empty() ? release.low : std::min(slip.low, release.low),
          SourceOf(release)};
}

}  // namespace hvas::fits
