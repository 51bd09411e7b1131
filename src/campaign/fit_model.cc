#include "campaign/fit_model.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"

namespace hvas::campaign {
namespace {

/** Uniform in [0, 1), as Random::Uniform() makes it of its bits. */
double ToUniform(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/** A deviation of a distribution for 64 random bits [m]. */
double CalcDeviation(const fits::SizeDistribution& sizes, std::uint64_t bits, Spread spread) {
  // A normal distribution has no quantile at 0; half a step further is in the open interval.
  constexpr double kHalfStep = 0x1.0p-54;
  return sizes.Quantile(ToUniform(bits) + (spread == Spread::kCapability ? kHalfStep : 0));
}

double CalcWithin(const UniformRange& range, std::uint64_t bits) {
  return range.low + ToUniform(bits) * (range.high - range.low);
}

Result<std::optional<fits::SizeDistribution>> MakeDistribution(
    const std::optional<fits::Limits>& zone, const SizeVariant& sizes, bool is_hole) {
  using Spreading = Result<fits::SizeDistribution>;
  if (!zone) {
    return std::optional<fits::SizeDistribution>();
  }
  const Spreading made = [&]() -> Spreading {
    switch (sizes.spread) {
      case Spread::kCapability:
        // The worse side for pressing in: small holes, thick shafts; as `hvas fit` has it.
        return fits::SizeDistribution::FromCapability(*zone, sizes.cp, sizes.cpk, !is_hole);
      case Spread::kUniform:
        return fits::SizeDistribution::Uniform(*zone);
      case Spread::kMeasured:
        return fits::SizeDistribution::FromMeasured(is_hole ? sizes.hole_deviations
                                                            : sizes.shaft_deviations);
      case Spread::kZone:
        break;
    }
    return fits::SizeDistribution::FromZone(*zone);
  }();
  if (!made) {
    return Unexpected(made.error());
  }
  return std::optional(*made);
}

/** The values of one fit, in the order in which they are drawn. */
class Values {
 public:
  Values(const FittedMate& mate, std::span<const std::uint64_t> values)
      : next_(values.subspan(mate.first_factor)) {}

  std::uint64_t Take() {
    const std::uint64_t value = next_.front();
    next_ = next_.subspan(1);
    return value;
  }

 private:
  std::span<const std::uint64_t> next_;
};

/** What one seed makes of a fit, at 20 C. */
struct Drawn {
  std::optional<double> hole, shaft;  ///< Deviations [m].
  std::uint64_t surface{0};           ///< Seed of B.
  std::optional<double> friction;
  std::optional<double> roughness;  ///< Rz [m].
};

Drawn DrawFit(const FittedMate& mate, const SizeVariant& sizes,
              std::span<const std::uint64_t> values) {
  Values next(mate, values);
  Drawn drawn;
  if (mate.hole) {
    drawn.hole = CalcDeviation(*mate.hole, next.Take(), sizes.spread);
  }
  if (mate.shaft) {
    drawn.shaft = CalcDeviation(*mate.shaft, next.Take(), sizes.spread);
  }
  drawn.surface = next.Take();
  if (sizes.friction) {
    drawn.friction = CalcWithin(*sizes.friction, next.Take());
  }
  if (sizes.roughness) {
    drawn.roughness = CalcWithin(*sizes.roughness, next.Take());
  }
  return drawn;
}

double CalcDiameter(const fits::SideToDraw& side, const std::optional<double>& deviation,
                    double nominal) {
  return (deviation ? nominal + *deviation : side.drawn) * side.expansion;
}

}  // namespace

Result<FitModel> FitModel::Make(const product::Product& product, const SizeVariant& sizes,
                                Diagnostics* diagnostics) {
  FitModel model;
  model.sizes_ = sizes;
  for (const product::Mate& mate : product.mates) {
    if (const auto added = model.AddMate(product, mate, diagnostics); !added) {
      return Unexpected(added.error());
    }
  }
  // A fit that cannot be calculated is found here, and not in the middle of a shard.
  std::vector<std::uint64_t> values(model.factors_.size());
  model.DrawFactors(0, values);
  for (std::size_t i = 0; i < model.mates_.size(); ++i) {
    if (const auto made = fits::FitForce::Make(model.DrawParameters(i, values)); !made) {
      Error error = made.error();
      error.where = fmt::format("{}, mate {}", product.source, model.mates_[i].name);
      return Unexpected(std::move(error));
    }
  }
  return model;
}

Result<void> FitModel::AddMate(const product::Product& product, const product::Mate& mate,
                               Diagnostics* diagnostics) {
  const auto fit = sequence::MakeFitToDraw(product, mate, fits::PairChoice::kAny);
  if (!fit) {
    diagnostics->Warn("fit-undefined", fmt::format("mate m{}", mate.id.value()),
                      fit.error().message, "assign another fit in the plan");
    return {};
  }
  if (!*fit) {
    return {};
  }
  FittedMate one;
  one.id = mate.id;
  one.fit = **fit;
  const std::string& hub = product.occurrences[mate.a.occurrence.index()].name;
  const std::string& shaft = product.occurrences[mate.b.occurrence.index()].name;
  one.name = fmt::format("m{} {} {}/{}", mate.id.value(), mate.fit->code, hub, shaft);
  auto holes = MakeDistribution(one.fit.pair.hole.zone, sizes_, true);
  auto shafts = MakeDistribution(one.fit.pair.shaft.zone, sizes_, false);
  if (!holes || !shafts) {
    return Unexpected((holes ? shafts : holes).error());
  }
  one.hole = *std::move(holes);
  one.shaft = *std::move(shafts);
  const auto same = std::find_if(mates_.begin(), mates_.end(), [&](const FittedMate& other) {
    return product.mates[other.id.index()].Joins(mate.a.occurrence, mate.b.occurrence);
  });
  one.joint = same == mates_.end() ? joint_count_++ : same->joint;
  one.first_factor = factors_.size();
  const auto add = [&](bool is_drawn, FactorKind kind, const char* word) {
    if (is_drawn) {
      factors_.push_back({mates_.size(), kind, fmt::format("m{} {}", mate.id.value(), word)});
    }
  };
  add(one.hole.has_value(), FactorKind::kHole, "hole");
  add(one.shaft.has_value(), FactorKind::kShaft, "shaft");
  add(true, FactorKind::kSurface, "surface");
  add(sizes_.friction.has_value(), FactorKind::kFriction, "friction");
  add(sizes_.roughness.has_value(), FactorKind::kRoughness, "roughness");
  mates_.push_back(std::move(one));
  return {};
}

void FitModel::DrawFactors(std::uint64_t seed, std::span<std::uint64_t> values) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < mates_.size(); ++i) {
    const std::size_t end = i + 1 < mates_.size() ? mates_[i + 1].first_factor : factors_.size();
    Random random(sequence::CalcFitSeed(seed, mates_[i].id));
    for (; next < end; ++next) {
      values[next] = random.NextBits();
    }
  }
}

fits::FitForceParameters FitModel::DrawParameters(std::size_t mate,
                                                  std::span<const std::uint64_t> values) const {
  const FittedMate& one = mates_[mate];
  const Drawn drawn = DrawFit(one, sizes_, values);
  fits::FitForceParameters parameters = one.fit.parameters;
  const double nominal = parameters.nominal_diameter;
  parameters.hole_diameter = CalcDiameter(one.fit.pair.hole, drawn.hole, nominal);
  parameters.shaft_diameter = CalcDiameter(one.fit.pair.shaft, drawn.shaft, nominal);
  parameters.seed = drawn.surface;
  parameters.roughness = drawn.roughness.value_or(parameters.roughness);
  if (drawn.friction) {
    parameters.friction = {*drawn.friction, *drawn.friction, *drawn.friction, *drawn.friction};
    parameters.lead_in_angle =
        std::min(parameters.lead_in_angle, sequence::CalcSteepestLeadIn(*drawn.friction));
  }
  return parameters;
}

MadeFit FitModel::CalcFit(std::size_t mate, std::span<const std::uint64_t> values) const {
  const auto force = fits::FitForce::Make(DrawParameters(mate, values));
  if (!force) {  // Make() has calculated each fit once; what varies stays in its range.
    return {std::numeric_limits<double>::infinity(), 0, std::numeric_limits<double>::infinity()};
  }
  return {force->max_resistance(), 2 * force->mean_clearance(),
          force->max_pressure() / force->elastic_limit()};
}

RunResult FitModel::Judge(std::span<const MadeFit> fits, const Plan& plan) const {
  RunResult result;
  std::vector<double> forces(joint_count_, 0);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    forces[mates_[i].joint] += fits[i].force;
  }
  double largest_of_joint = 0;
  std::int64_t pressed = -1;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const double force = forces[mates_[i].joint];
    // Of the mates of a joint it is about the one with the largest force of its own.
    const bool is_same_joint = force == result.force && fits[i].force > largest_of_joint;
    if (force > result.force || is_same_joint) {
      result.force = force;
      largest_of_joint = fits[i].force;
      pressed = mates_[i].id.value();
    }
    result.clearance = i == 0 ? fits[i].clearance : std::min(result.clearance, fits[i].clearance);
  }
  const double press_share = plan.press_force > 0 ? result.force / plan.press_force : 0;
  std::int64_t yielding = -1;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].pressure_share > result.pressure_share) {
      result.pressure_share = fits[i].pressure_share;
      yielding = mates_[i].id.value();
    }
  }
  result.utilisation = std::max(press_share, result.pressure_share);
  if (result.utilisation > 1) {
    const bool is_press = press_share >= result.pressure_share;
    result.cause = is_press ? Cause::kPress : Cause::kYield;
    result.entity = is_press ? pressed : yielding;
  }
  result.is_complete = press_share <= 1 && (plan.may_yield || result.pressure_share <= 1);
  return result;
}

void SetDrawnConditions(const FitModel& model, std::uint64_t seed, const SizeVariant& sizes,
                        product::Product* product) {
  std::vector<std::uint64_t> values(model.factors().size());
  model.DrawFactors(seed, values);
  for (const FittedMate& mate : model.mates()) {
    const Drawn drawn = DrawFit(mate, sizes, values);
    const double nominal = mate.fit.parameters.nominal_diameter;
    product::FitConditions& conditions = product->mates[mate.id.index()].conditions;
    if (drawn.hole && conditions.hole_diameters.empty()) {
      conditions.hole_diameters = {{0, nominal + *drawn.hole}};
    }
    if (drawn.shaft && conditions.shaft_diameters.empty()) {
      conditions.shaft_diameters = {{0, nominal + *drawn.shaft}};
    }
    if (drawn.friction) {
      conditions.friction = drawn.friction;
    }
    if (drawn.roughness) {
      conditions.hole_roughness = conditions.shaft_roughness = drawn.roughness;
    }
  }
}

}  // namespace hvas::campaign
