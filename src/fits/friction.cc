#include "fits/friction.h"

#include <array>
#include <cmath>

namespace hvas::fits {
namespace {

constexpr std::string_view kDin =
    "DIN 7190-1, 5.3, as quoted in FVA's help on interference fits: transverse fits";
constexpr std::string_view kDin53 = "DIN 7190-1, 5.3, as quoted in FVA's help";
constexpr std::string_view kDin52 = "DIN 7190-1, 5.2";
constexpr std::string_view kQuoted = "quoted twice";
constexpr std::string_view kSeen = "quoted in FVA's help";
constexpr std::string_view kUnverified = "unverified: from memory of the standard";
constexpr std::string_view kTwoEnds = "quoted twice; the two ends of the range for dry joints";

// The standards state what holds a joint, and not how it starts to slide. Parts that are put
// together by hand are neither degreased nor oiled on purpose: static is the value for dry joints,
// kinetic the one with mineral oil where there is one; else the two ends of the range.
constexpr std::array<FrictionEntry, 4> kTable{{
    {FrictionSurface::kSteel, FrictionSurface::kSteel, 0.15, 0.12, kDin,
     "quoted twice; shrunk, and with mineral oil; an older edition has 0.14 for the former"},
    {FrictionSurface::kSteel, FrictionSurface::kCastIron, 0.16, 0.10, kDin,
     "quoted twice; degreased, and with mineral oil"},
    {FrictionSurface::kSteel, FrictionSurface::kLightMetal, 0.15, 0.10, kDin, kTwoEnds},
    {FrictionSurface::kSteel, FrictionSurface::kCopperAlloy, 0.25, 0.17, kDin, kTwoEnds},
}};

constexpr std::array<JointFriction, 45> kJoints{{
    {"steel / steel", "transverse, oil pressed in, mineral oil", "nu_rl = nu_ru", 0.12, 0.12,
     kDin53, kQuoted},
    {"steel / steel", "transverse, oil pressed in, degreased, joined with glycerine",
     "nu_rl = nu_ru", 0.18, 0.18, kDin53, kQuoted},
    {"steel / steel", "transverse, hub heated up to 300 C", "nu_rl = nu_ru", 0.15, 0.15, kDin53,
     "quoted twice; an older edition has 0.14"},
    {"steel / steel", "transverse, hub heated up to 300 C, degreased", "nu_rl = nu_ru", 0.20, 0.20,
     kDin53, kQuoted},
    {"steel / cast iron", "transverse, oil pressed in, mineral oil", "nu_rl = nu_ru", 0.10, 0.10,
     kDin53, kQuoted},
    {"steel / cast iron", "transverse, degreased", "nu_rl = nu_ru", 0.16, 0.16, kDin53, kQuoted},
    {"steel / magnesium, aluminium", "transverse, dry", "nu_rl = nu_ru", 0.10, 0.15, kDin53,
     kQuoted},
    {"steel / brass", "transverse, dry", "nu_rl = nu_ru", 0.17, 0.25, kDin53, kQuoted},
    {"steel / E335", "longitudinal, dry", "nu_ll", 0.11, 0.11, kDin52, kSeen},
    {"steel / E335", "longitudinal, dry", "nu_rl", 0.08, 0.08, kDin52, kSeen},
    {"steel / E335", "longitudinal, oiled", "nu_ll", 0.08, 0.08, kDin52, kSeen},
    {"steel / E335", "longitudinal, oiled", "nu_rl", 0.07, 0.07, kDin52,
     "seen in part: the last digit is cut off"},
    {"steel / GE300", "longitudinal, dry", "nu_ll", 0.11, 0.11, kDin52, kUnverified},
    {"steel / GE300", "longitudinal, dry", "nu_rl", 0.08, 0.08, kDin52, kUnverified},
    {"steel / GE300", "longitudinal, oiled", "nu_ll", 0.08, 0.08, kDin52, kUnverified},
    {"steel / GE300", "longitudinal, oiled", "nu_rl", 0.07, 0.07, kDin52, kUnverified},
    {"steel / S235", "longitudinal, dry", "nu_ll", 0.10, 0.10, kDin52, kUnverified},
    {"steel / S235", "longitudinal, dry", "nu_rl", 0.09, 0.09, kDin52, kUnverified},
    {"steel / S235", "longitudinal, oiled", "nu_ll", 0.07, 0.07, kDin52, kUnverified},
    {"steel / S235", "longitudinal, oiled", "nu_rl", 0.06, 0.06, kDin52, kUnverified},
    {"steel / EN-GJL-250", "longitudinal, dry", "nu_ll", 0.12, 0.12, kDin52, kUnverified},
    {"steel / EN-GJL-250", "longitudinal, dry", "nu_rl", 0.11, 0.11, kDin52, kUnverified},
    {"steel / EN-GJL-250", "longitudinal, oiled", "nu_ll", 0.06, 0.06, kDin52, kUnverified},
    {"steel / EN-GJL-250", "longitudinal, oiled", "nu_rl", 0.05, 0.05, kDin52, kUnverified},
    {"steel / EN-GJS-600-3", "longitudinal, dry", "nu_ll", 0.10, 0.10, kDin52, kUnverified},
    {"steel / EN-GJS-600-3", "longitudinal, dry", "nu_rl", 0.09, 0.09, kDin52, kUnverified},
    {"steel / EN-GJS-600-3", "longitudinal, oiled", "nu_ll", 0.06, 0.06, kDin52, kUnverified},
    {"steel / EN-GJS-600-3", "longitudinal, oiled", "nu_rl", 0.05, 0.05, kDin52, kUnverified},
    {"steel / AlSi12", "longitudinal, dry", "nu_ll", 0.07, 0.07, kDin52, kUnverified},
    {"steel / AlSi12", "longitudinal, dry", "nu_rl", 0.06, 0.06, kDin52, kUnverified},
    {"steel / AlSi12", "longitudinal, oiled", "nu_ll", 0.05, 0.05, kDin52, kUnverified},
    {"steel / AlSi12", "longitudinal, oiled", "nu_rl", 0.04, 0.04, kDin52, kUnverified},
    {"steel / G-CuPb10Sn", "longitudinal, dry", "nu_ll", 0.07, 0.07, kDin52, kUnverified},
    {"steel / G-CuPb10Sn", "longitudinal, dry", "nu_rl", 0.06, 0.06, kDin52, kUnverified},
    {"steel / TiAl6V4", "longitudinal, oiled", "nu_ll", 0.05, 0.05, kDin52, kUnverified},
    {"steel / steel", "pressed, dry, design value 0.14", "mu", 0.10, 0.20,
     "DTPPress, design values", "one source"},
    {"steel / steel", "pressed, oiled, design value 0.08", "mu", 0.05, 0.12,
     "DTPPress, design values", "one source"},
    {"steel / grey iron", "pressed, dry, design value 0.10", "mu", 0.08, 0.12,
     "DTPPress, design values", "one source"},
    {"steel / grey iron", "pressed, oiled, design value 0.06", "mu", 0.04, 0.08,
     "DTPPress, design values", "one source"},
    {"steel / aluminium", "pressed, design value 0.05", "mu", 0.03, 0.07, "DTPPress, design values",
     "one source"},
    {"steel / copper alloy", "pressed, design value 0.06", "mu", 0.05, 0.10,
     "DTPPress, design values", "one source"},
    {"steel / steel", "force rendering of fits", "mu", 0.15, 0.15, "paper W, section 4.2.3",
     "as printed; that of a shrink fit in DIN 7190-1"},
    {"steel / steel", "example of a press fit", "mu", 0.15, 0.15, "eAssistant", "an assumed input"},
    {"steel / steel", "plain surfaces at rest, dry", "mu", 0.45, 0.80, "handbook charts",
     "not for press fits; wide range"},
    {"steel / steel", "plain surfaces, lubricated", "mu", 0.10, 0.10, "handbook charts",
     "not for press fits"},
}};

}  // namespace

double FrictionLaw::CalcCoefficient(double v) const noexcept {
  const double s = v / stribeck_speed;
  return kinetic_coefficient + (static_coefficient - kinetic_coefficient) * std::exp(-s * s) +
         viscous * v;
}

std::span<const FrictionEntry> FrictionTable() noexcept {
  return kTable;
}

std::span<const JointFriction> JointFrictionTable() noexcept {
  return kJoints;
}

const FrictionEntry* FindFrictionEntry(FrictionSurface a, FrictionSurface b) noexcept {
  for (const FrictionEntry& entry : kTable) {
    if ((entry.a == a && entry.b == b) || (entry.a == b && entry.b == a)) {
      return &entry;
    }
  }
  return nullptr;
}

FrictionLaw FindFriction(FrictionSurface a, FrictionSurface b,
                         const FrictionLaw& otherwise) noexcept {
  FrictionLaw law = otherwise;
  if (const FrictionEntry* entry = FindFrictionEntry(a, b)) {
    law.static_coefficient = entry->static_coefficient;
    law.kinetic_coefficient = entry->kinetic_coefficient;
  }
  return law;
}

FrictionSurface SurfaceOf(std::string_view group) noexcept {
  const auto has = [group](std::string_view word) {
    return group.find(word) != std::string_view::npos;
  };
  if (has("steel")) {
    return FrictionSurface::kSteel;
  }
  if (has("iron")) {
    return FrictionSurface::kCastIron;
  }
  if (has("bronze") || has("brass") || has("copper")) {
    return FrictionSurface::kCopperAlloy;
  }
  if (has("aluminium") || has("magnesium")) {
    return FrictionSurface::kLightMetal;
  }
  return has("polymer") ? FrictionSurface::kPolymer : FrictionSurface::kUnknown;
}

}  // namespace hvas::fits
