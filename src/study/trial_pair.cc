#include "study/trial_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/iso286.h"
#include "mates/assignments.h"
#include "mates/mate_kind.h"
#include "sequence/fit_of_mate.h"
#include "study/schedule.h"
#include "study/simulated_participant.h"

namespace hvas::study {
namespace {

using product::FitConditions;
using product::Mate;
using product::MeasuredDiameter;

constexpr std::uint64_t kPairStream = 103;  // No other stream of random numbers has this number.
constexpr double kReading = 0.5e-6;         // [m] half the last digit of a size in micrometres

bool HasFit(const Mate& mate) {
  return mates::HasFit(mate.kind) && mate.fit && product::IsIsoFit(mate.fit->kind);
}

std::string Where(const Condition& condition, const Mate& mate) {
  return fmt::format("condition {}, mate {}", condition.id, mate.key);
}

/** Refuses measured diameters outside the limits of one side of a fit. */
Result<void> CheckDiameters(const std::vector<MeasuredDiameter>& measured, const char* side,
                            const fits::Limits& limits, const Condition& condition,
                            const Mate& mate) {
  const double low = mate.fit->nominal_diameter + limits.lower;
  const double high = mate.fit->nominal_diameter + limits.upper;
  for (const auto& [depth, diameter] : measured) {
    if (diameter < low - kReading || diameter > high + kReading) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("the measured diameter of the {}, {:.4f} mm, is outside {} ({:.4f} to "
                      "{:.4f} mm)",
                      side, units::ToMm(diameter), condition.fit, units::ToMm(low),
                      units::ToMm(high)),
          Where(condition, mate),
          "correct the size in the side file or the protocol, or omit the fit of the condition");
    }
  }
  return {};
}

Result<void> CheckSizes(const Condition& condition, const Mate& mate) {
  const auto fit = fits::ParseFit(condition.fit);
  const auto limits =
      fit ? fits::CalcFitLimits(*fit, mate.fit->nominal_diameter) : Unexpected(fit.error());
  if (!limits) {
    return Unexpected(limits.error());
  }
  auto checked =
      CheckDiameters(mate.conditions.hole_diameters, "hole", limits->hole, condition, mate);
  if (checked) {
    checked =
        CheckDiameters(mate.conditions.shaft_diameters, "shaft", limits->shaft, condition, mate);
  }
  return checked;
}

bool IsSame(double a, double b) {
  return a == b;
}

bool IsSame(const MeasuredDiameter& a, const MeasuredDiameter& b) {
  return a.depth == b.depth && a.diameter == b.diameter;
}

/** Sets on a mate what a condition states of one quantity, and refuses to change what is stated.
 @param from, to  Optional or vector; empty: not stated. */
template <typename T>
Result<void> Set(const char* name, const T& from, const Condition& condition, const Mate& mate,
                 T* to) {
  if (std::begin(from) == std::end(from)) {
    return {};
  }
  const bool is_stated = std::begin(*to) != std::end(*to);
  if (is_stated && !std::equal(std::begin(from), std::end(from), std::begin(*to), std::end(*to),
                               [](const auto& a, const auto& b) { return IsSame(a, b); })) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the condition and the product's side file state different values of "
                            "the {}",
                            name),
                Where(condition, mate), "remove the value from one of the two");
  }
  *to = from;
  return {};
}

/** An optional as a range of at most one value. */
std::vector<double> ListOf(const std::optional<double>& value) {
  return value ? std::vector<double>{*value} : std::vector<double>{};
}

Result<void> Set(const char* name, const std::optional<double>& from, const Condition& condition,
                 const Mate& mate, std::optional<double>* to) {
  std::vector<double> target = ListOf(*to);
  auto set = Set(name, ListOf(from), condition, mate, &target);
  if (set && from) {
    *to = from;
  }
  return set;
}

Result<void> ApplySizes(const Condition& condition, Mate* mate) {
  const FitConditions& from = condition.sizes;
  FitConditions* to = &mate->conditions;
  auto set = Set("hole's diameter", from.hole_diameters, condition, *mate, &to->hole_diameters);
  if (set) {
    set = Set("shaft's diameter", from.shaft_diameters, condition, *mate, &to->shaft_diameters);
  }
  if (set) {
    set = Set("hole's roughness", from.hole_roughness, condition, *mate, &to->hole_roughness);
  }
  if (set) {
    set = Set("shaft's roughness", from.shaft_roughness, condition, *mate, &to->shaft_roughness);
  }
  if (set) {
    set = Set("friction", from.friction, condition, *mate, &to->friction);
  }
  return set;
}

std::string FormatDiameters(const std::vector<MeasuredDiameter>& measured) {
  std::string text;
  for (const auto& [depth, diameter] : measured) {
    text += fmt::format("{}:{};", depth, diameter);
  }
  return text;
}

std::string FormatValue(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "-";
}

}  // namespace

Result<void> ApplyFit(const Condition& condition, const std::string& part,
                      product::Product* product) {
  if (!condition.fit.empty()) {
    if (auto assigned = mates::AssignFit(product, part + "=" + condition.fit); !assigned) {
      return assigned;
    }
  }
  const auto id = mates::FindOccurrence(*product, part);
  if (!id) {
    return Unexpected(id.error());
  }
  for (Mate& mate : product->mates) {
    if (!HasFit(mate) || (mate.a.occurrence != *id && mate.b.occurrence != *id)) {
      continue;
    }
    auto applied = ApplySizes(condition, &mate);
    if (applied && !condition.fit.empty()) {
      applied = CheckSizes(condition, mate);
    }
    if (!applied) {
      return applied;
    }
  }
  return {};
}

std::string MakeFitKey(const Condition& condition, const std::string& part) {
  const FitConditions& sizes = condition.sizes;
  return fmt::format("{}|{}|{}|{}|{}|{}|{}", part, condition.fit,
                     FormatDiameters(sizes.hole_diameters), FormatDiameters(sizes.shaft_diameters),
                     FormatValue(sizes.hole_roughness), FormatValue(sizes.shaft_roughness),
                     FormatValue(sizes.friction));
}

std::uint64_t CalcPairSeed(std::uint64_t study_seed, int participant, std::size_t trial) {
  return MixSeed(MixSeed(study_seed, kPairStream, static_cast<std::uint64_t>(participant)),
                 kPairStream, trial);
}

Result<std::shared_ptr<const simulation::Model>> DrawPair(const simulation::Model& model,
                                                          std::size_t step,
                                                          const Condition& condition,
                                                          std::uint64_t seed) {
  Diagnostics diagnostics;
  auto drawn = simulation::DrawSizes(model, seed, condition.pairs, &diagnostics);
  const auto mate = FindFittedMate(*drawn, step);
  const auto& items = diagnostics.items();
  const auto missed = std::find_if(items.begin(), items.end(), [&](const Diagnostic& item) {
    return item.code == sequence::kFitNotShown && mate &&
           item.entity == fmt::format("mate m{}", mate->value());
  });
  if (missed != items.end() && !condition.fit.empty()) {
    return Fail(ErrorCode::kUnsupported, missed->message, "condition " + condition.id,
                missed->remedy);
  }
  return drawn;
}

std::optional<product::MateId> FindFittedMate(const simulation::Model& model, std::size_t step) {
  std::optional<product::MateId> longest;
  for (const product::MateId id : ListConstraints(model, step)) {
    const bool has_force = model.mates[id.index()].fit != nullptr;
    if (has_force && (!longest || model.product->mates[id.index()].overlap >
                                      model.product->mates[longest->index()].overlap)) {
      longest = id;
    }
  }
  return longest;
}

ShownPair FindShownPair(const simulation::Model& model, std::size_t step) {
  const std::size_t i = FindFittedMate(model, step)->index();
  return {model.mates[i].fit, sequence::ToFitsKind(model.product->mates[i].fit->kind)};
}

PairSource MakePairSource(std::shared_ptr<const simulation::Model> model, std::size_t step,
                          const Condition& condition) {
  const product::Mate& mate = model->product->mates[FindFittedMate(*model, step)->index()];
  return [model = std::move(model), &mate, pairs = condition.pairs](std::uint64_t seed) {
    Diagnostics ignored;
    return ShownPair{sequence::MakeFitForce(*model->product, mate, seed, pairs, &ignored),
                     sequence::ToFitsKind(mate.fit->kind)};
  };
}

std::optional<TrialPair> DescribePair(const simulation::Model& model, std::size_t step) {
  const auto mate = FindFittedMate(model, step);
  if (!mate) {
    return std::nullopt;
  }
  const fits::FitForce& fit = *model.mates[mate->index()].fit;
  TrialPair pair;
  pair.shaft_diameter = fit.shaft_diameter();
  pair.hole_diameter = fit.shaft_diameter() + 2 * fit.mean_clearance();
  pair.clearances.assign(fit.clearances().begin(), fit.clearances().end());
  return pair;
}

}  // namespace hvas::study
