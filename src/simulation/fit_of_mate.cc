#include "simulation/fit_of_mate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/random.h"
#include "fits/actual_size.h"
#include "fits/iso286.h"

namespace hvas::simulation {
namespace {

constexpr double kReferenceTemperature_c = 20;  // ISO 1
constexpr double kThickestWall = 0.95;          // largest c_0 = R / r_0 that is believed

/** Outer radius of the hub around a hole: the narrowest coaxial outside cylinder, or else half the
 least width of the part across the axis [m]. */
double FindHubRadius(const product::Part& part, const product::Feature& hole) {
  double outer = std::numeric_limits<double>::infinity();
  for (const product::Feature& feature : part.features) {
    if (feature.kind != product::FeatureKind::kShaft || feature.radius <= hole.radius) {
      continue;
    }
    const Vec3 d = feature.origin_B - hole.origin_B;
    const double away = (d - d.dot(hole.axis_B) * hole.axis_B).norm();
    if (std::abs(feature.axis_B.dot(hole.axis_B)) > 0.999 && away < 0.05 * hole.radius) {
      outer = std::min(outer, feature.radius);
    }
  }
  if (std::isfinite(outer)) {
    return outer;
  }
  Vec3 half = 0.5 * part.box_B.size();
  Eigen::Index along = 0;
  hole.axis_B.cwiseAbs().maxCoeff(&along);
  half[along] = std::numeric_limits<double>::infinity();
  return half.minCoeff();
}

/** The zones of the code on a mate: of both sides, or of one where the other is as drawn. */
struct Zones {
  std::optional<fits::Limits> hole, shaft;
};

Result<Zones> FindZones(const std::string& code, double nominal) {
  if (const auto side = fits::ParseToleranceClass(code)) {
    const auto limits = fits::CalcLimits(*side, nominal);
    if (!limits) {
      return Unexpected(limits.error());
    }
    return side->is_hole() ? Zones{*limits, {}} : Zones{{}, *limits};
  }
  const auto fit = fits::ParseFit(code);
  const auto limits = fit ? fits::CalcFitLimits(*fit, nominal) : Unexpected(fit.error());
  if (!limits) {
    return Unexpected(limits.error());
  }
  return Zones{limits->hole, limits->shaft};
}

/** Actual diameter of one side at 20 C: measured, or drawn by chance from its zone, or as drawn in
 the file. Takes from `random` what the zone asks for even where a measured size makes it vain, so
 that what comes after is the same. */
double ChooseDiameter(const std::optional<double>& measured,
                      const std::optional<fits::Limits>& zone, double nominal, double drawn,
                      Random* random) {
  const double by_chance = zone ? nominal + fits::DrawDeviation(*zone, random) : drawn;
  return measured.value_or(by_chance);
}

/** The diameter at the temperature that is stated; expansion is free and uniform. */
double Expand(double diameter, const std::optional<double>& temperature,
              const product::Material& material) {
  const double rise = temperature.value_or(kReferenceTemperature_c) - kReferenceTemperature_c;
  return diameter * (1 + material.thermal_expansion * rise);
}

bool HasSizes(const product::FitConditions& conditions) {
  return conditions.hole_diameter || conditions.shaft_diameter || conditions.hole_temperature ||
         conditions.shaft_temperature;
}

}  // namespace

std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                   const product::Mate& mate, std::uint64_t seed,
                                                   Diagnostics* diagnostics) {
  const product::FitConditions& conditions = mate.conditions;
  if (!mate.fit || mate.fit->kind == product::FitKind::kThread ||
      (mate.fit->code.empty() && !HasSizes(conditions))) {
    return nullptr;
  }
  const std::string entity = fmt::format("mate m{}", mate.id.value());
  const double nominal = mate.fit->nominal_diameter;
  const auto zones =
      mate.fit->code.empty() ? Result<Zones>(Zones{}) : FindZones(mate.fit->code, nominal);
  if (!zones) {
    diagnostics->Warn("fit-undefined", entity, zones.error().message,
                      "the mate answers as a plain guide; assign another fit with --fit");
    return nullptr;
  }
  // Every mate has its own stream, so that one mate's fit does not change another's sizes.
  Random random(seed * 0x9e3779b97f4a7c15u + mate.id.value());
  fits::FitForceParameters parameters;
  parameters.nominal_diameter = nominal;
  parameters.hole_diameter = Expand(
      ChooseDiameter(conditions.hole_diameter, zones->hole, nominal, 2 * mate.hole_radius, &random),
      conditions.hole_temperature, product.part_of(mate.a.occurrence).material);
  parameters.shaft_diameter =
      Expand(ChooseDiameter(conditions.shaft_diameter, zones->shaft, nominal, 2 * mate.shaft_radius,
                            &random),
             conditions.shaft_temperature, product.part_of(mate.b.occurrence).material);
  parameters.friction = conditions.friction.value_or(parameters.friction);
  // The profile of the pair is the mean of the two: equal sides give their own.
  parameters.roughness = 0.5 * (conditions.hole_roughness.value_or(parameters.roughness) +
                                conditions.shaft_roughness.value_or(parameters.roughness));
  parameters.length = mate.overlap;
  const product::Part& hub = product.part_of(mate.a.occurrence);
  const double hub_radius = FindHubRadius(hub, hub.features[mate.a.feature.index()]);
  parameters.radius_ratio = std::clamp(mate.hole_radius / hub_radius, 0.0, kThickestWall);
  parameters.seed = random.NextBits();
  const auto force = fits::FitForce::Make(parameters);
  if (!force) {
    diagnostics->Warn("fit-undefined", entity, force.error().message,
                      "the mate answers as a plain guide");
    return nullptr;
  }
  return std::make_shared<const fits::FitForce>(*force);
}

}  // namespace hvas::simulation
