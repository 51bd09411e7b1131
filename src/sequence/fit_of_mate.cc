#include "sequence/fit_of_mate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"
#include "base/units.h"
#include "fits/actual_size.h"
#include "fits/friction.h"
#include "fits/iso286.h"
#include "fits/materials.h"
#include "mates/prismatic_fits.h"
#include "product/names.h"

namespace hvas::sequence {
namespace {

using product::FitKind;

constexpr double kReferenceTemperature_c = 20;  // ISO 1
constexpr double kThickestRatio = 0.95;         // of inner to outer radius that is believed
constexpr double kThinnestRatio = 1e-3;         // A solid shaft, or as good as one.
constexpr double kSteepestLeadIn = 0.8;         // of the angle that friction would lock

/** True where an axis of the same part runs along the feature's. */
bool IsCoaxial(const product::Feature& feature, const Vec3& origin_B, const Vec3& axis_B) {
  const Vec3 d = origin_B - feature.origin_B;
  const double away = (d - d.dot(feature.axis_B) * feature.axis_B).norm();
  return std::abs(axis_B.dot(feature.axis_B)) > 0.999 && away < 0.05 * feature.radius;
}

/** Outer radius of the hub around a hole: the narrowest coaxial outside cylinder, or else half the
 least width of the part across the axis [m]. */
double FindHubRadius(const product::Part& part, const product::Feature& hole) {
  double outer = std::numeric_limits<double>::infinity();
  for (const product::Feature& feature : part.features) {
    if (feature.kind == product::FeatureKind::kShaft && feature.radius > hole.radius &&
        IsCoaxial(hole, feature.origin_B, feature.axis_B)) {
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

/** Radius of the bore that makes a shaft hollow: the widest coaxial hole that goes through most of
 it; 0 where it is solid [m]. */
double FindBoreRadius(const product::Part& part, const product::Feature& shaft) {
  const double length = shaft.span_high - shaft.span_low;
  double bore = 0;
  for (const product::Feature& feature : part.features) {
    if (feature.kind != product::FeatureKind::kHole || feature.radius >= shaft.radius ||
        !IsCoaxial(shaft, feature.origin_B, feature.axis_B)) {
      continue;
    }
    const double sense = shaft.axis_B.dot(feature.axis_B);
    const double origin = (feature.origin_B - shaft.origin_B).dot(shaft.axis_B);
    const double a = origin + sense * feature.span_low;
    const double b = origin + sense * feature.span_high;
    const double shared =
        std::min(std::max(a, b), shaft.span_high) - std::max(std::min(a, b), shaft.span_low);
    bore = shared > 0.5 * length ? std::max(bore, feature.radius) : bore;
  }
  return bore;
}

/** Angle to the axis of a chamfer at an end of a hole or shaft [rad]; 0 where it has none. */
double FindChamferAngle(const product::Part& part, const product::Feature& feature) {
  for (const product::Form& form : part.forms) {
    const double at = (form.origin_B - feature.origin_B).dot(feature.axis_B);
    const double outside = std::max(feature.span_low - at, at - feature.span_high);
    if (form.kind == product::FormKind::kChamfer && form.angle > 0 &&
        IsCoaxial(feature, form.origin_B, form.axis_B) && std::abs(outside) <= form.depth) {
      return 0.5 * form.angle;
    }
  }
  return 0;
}

fits::PressMaterial ToPressMaterial(const product::Material& material) {
  fits::PressMaterial press;
  press.youngs_modulus = material.youngs_modulus;
  press.poisson_ratio = material.poisson_ratio;
  press.yield_strength = material.yield_strength;
  press.thermal_expansion = material.thermal_expansion;
  return press;
}

/** One coefficient where somebody states one; else those of the pair of materials. */
fits::FitFriction ChooseFriction(const std::optional<double>& stated, const product::Material& hub,
                                 const product::Material& shaft) {
  const fits::FrictionLaw law =
      stated ? fits::FrictionLaw{*stated, *stated}
             : fits::FindFriction(SurfaceOf(hub), SurfaceOf(shaft), fits::FrictionLaw{});
  return {law.static_coefficient, law.static_coefficient, law.kinetic_coefficient,
          law.static_coefficient};
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

/** The diameter at the temperature that is stated; expansion is free and uniform. */
double Expand(double diameter, const std::optional<double>& temperature_c,
              const product::Material& material) {
  const double rise = temperature_c.value_or(kReferenceTemperature_c) - kReferenceTemperature_c;
  return diameter * (1 + material.thermal_expansion * rise);
}

bool HasTemperature(const product::FitConditions& conditions) {
  return conditions.hole_temperature_c || conditions.shaft_temperature_c;
}

bool HasSizes(const product::FitConditions& conditions) {
  return !conditions.hole_diameters.empty() || !conditions.shaft_diameters.empty() ||
         HasTemperature(conditions);
}

std::vector<fits::DiameterAtDepth> ListMeasured(
    const std::vector<product::MeasuredDiameter>& measured,
    const std::optional<double>& temperature_c, const product::Material& material) {
  std::vector<fits::DiameterAtDepth> diameters;
  diameters.reserve(measured.size());
  for (const auto& [depth, diameter] : measured) {
    diameters.push_back({depth, Expand(diameter, temperature_c, material)});
  }
  return diameters;
}

/** What is round about a shaft in a hole. */
void AddRings(const product::Product& product, const product::Mate& mate,
              fits::FitForceParameters* parameters) {
  const product::Part& hub = product.part_of(mate.a.occurrence);
  const product::Part& shaft = product.part_of(mate.b.occurrence);
  const product::Feature& hole_feature = hub.features[mate.a.feature.index()];
  const product::Feature& shaft_feature = shaft.features[mate.b.feature.index()];
  const double nominal = parameters->nominal_diameter;
  parameters->hub_diameter =
      nominal / std::clamp(mate.hole_radius / FindHubRadius(hub, hole_feature), kThinnestRatio,
                           kThickestRatio);
  parameters->shaft_bore =
      nominal * std::min(FindBoreRadius(shaft, shaft_feature) / mate.shaft_radius, kThickestRatio);
  const double lead_in = FindChamferAngle(shaft, shaft_feature);
  parameters->lead_in_angle = lead_in > 0 ? lead_in : FindChamferAngle(hub, hole_feature);
}

/** What is flat about a tongue in a slot. Walls that are thicker than the contact is large give way
 as a half space does, whose mean under a square of side s is 0.95 p s / E' (Timoshenko and Goodier,
 Theory of Elasticity, 1970, article 139): as a slab of about the thickness s. */
void AddWalls(const product::Product& product, const product::Mate& mate,
              fits::FitForceParameters* parameters) {
  const double side = std::sqrt(mate.overlap * mate.breadth);
  const double thickness = std::min(mates::CalcWallThickness(product, mate), 2 * side);
  parameters->breadth = mate.breadth;
  parameters->hub_diameter = parameters->nominal_diameter +
                             std::max(thickness, kThinnestRatio * parameters->nominal_diameter);
  parameters->lead_in_angle = mates::FindLeadIn(product, mate).angle;
}

}  // namespace

fits::FrictionSurface SurfaceOf(const product::Material& material) {
  const auto match = fits::FindMaterial(material.standard);
  return match ? fits::SurfaceOf(match->material->group) : fits::FrictionSurface::kUnknown;
}

fits::FitKind ToFitsKind(product::FitKind kind) {
  switch (kind) {
    case FitKind::kInterference:
      return fits::FitKind::kInterference;
    case FitKind::kTransition:
      return fits::FitKind::kTransition;
    case FitKind::kClearance:
    case FitKind::kThread:
    case FitKind::kInsert:
    case FitKind::kPassage:
      break;
  }
  return fits::FitKind::kClearance;
}

std::uint64_t CalcFitSeed(std::uint64_t seed, product::MateId mate) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio.
  return seed * kGolden + mate.value();
}

double CalcSteepestLeadIn(double friction) noexcept {
  return kSteepestLeadIn * std::atan(1 / std::max(friction, 1e-12));
}

Result<std::optional<FitToDraw>> MakeFitToDraw(const product::Product& product,
                                               const product::Mate& mate, fits::PairChoice pairs) {
  const product::FitConditions& conditions = mate.conditions;
  if (!mate.fit || !product::IsIsoFit(mate.fit->kind) ||
      (mate.fit->code.empty() && !HasSizes(conditions))) {
    return std::optional<FitToDraw>();
  }
  const double nominal = mate.fit->nominal_diameter;
  const auto zones =
      mate.fit->code.empty() ? Result<Zones>(Zones{}) : FindZones(mate.fit->code, nominal);
  if (!zones) {
    return Unexpected(zones.error());
  }
  FitToDraw fit;
  fits::FitForceParameters& parameters = fit.parameters;
  parameters.nominal_diameter = nominal;
  const product::Part& hub = product.part_of(mate.a.occurrence);
  const product::Part& shaft = product.part_of(mate.b.occurrence);
  parameters.hole_diameters =
      ListMeasured(conditions.hole_diameters, conditions.hole_temperature_c, hub.material);
  parameters.shaft_diameters =
      ListMeasured(conditions.shaft_diameters, conditions.shaft_temperature_c, shaft.material);
  parameters.friction = ChooseFriction(conditions.friction, hub.material, shaft.material);
  // The profile of the pair is the mean of the two: equal sides give their own.
  parameters.roughness = 0.5 * (conditions.hole_roughness.value_or(parameters.roughness) +
                                conditions.shaft_roughness.value_or(parameters.roughness));
  parameters.length = mate.overlap;
  parameters.hub = ToPressMaterial(hub.material);
  parameters.shaft = ToPressMaterial(shaft.material);
  if (mate.kind == product::MateKind::kPrismatic) {
    AddWalls(product, mate, &parameters);
  } else {
    AddRings(product, mate, &parameters);
  }
  parameters.lead_in_angle =
      std::min(parameters.lead_in_angle, CalcSteepestLeadIn(parameters.friction.in));
  fits::PairToDraw& pair = fit.pair;
  pair.hole = {zones->hole, 2 * mate.hole_radius,
               Expand(1, conditions.hole_temperature_c, hub.material)};
  pair.shaft = {zones->shaft, 2 * mate.shaft_radius,
                Expand(1, conditions.shaft_temperature_c, shaft.material)};
  pair.kind = ToFitsKind(mate.fit->kind);
  const bool has_kind = !mate.fit->code.empty() && !HasTemperature(conditions);
  pair.choice = has_kind ? pairs : fits::PairChoice::kAny;
  return std::optional<FitToDraw>(std::move(fit));
}

std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                   const product::Mate& mate, std::uint64_t seed,
                                                   fits::PairChoice pairs,
                                                   Diagnostics* diagnostics) {
  const std::string entity = fmt::format("mate m{}", mate.id.value());
  auto fit = MakeFitToDraw(product, mate, pairs);
  if (!fit) {
    diagnostics->Warn("fit-undefined", entity, fit.error().message,
                      "the mate answers as a plain guide; assign another fit with --fit");
    return nullptr;
  }
  if (!*fit) {
    return nullptr;
  }
  fits::FitForceParameters& parameters = (*fit)->parameters;
  Random random(CalcFitSeed(seed, mate.id));
  if (!fits::DrawPair((*fit)->pair, &random, &parameters)) {
    diagnostics->Note(
        kFitNotShown, entity,
        fmt::format("none of {} pairs drawn for {} at {:g} mm shows a {} fit along its length "
                    "with a roughness of Rz {:g} um",
                    fits::kMostPairsDrawn, mate.fit->code, units::ToMm(parameters.nominal_diameter),
                    product::ToString(mate.fit->kind), units::ToUm(parameters.roughness)),
        "state a smaller roughness or another fit");
  }
  const auto force = fits::FitForce::Make(parameters);
  if (!force) {
    diagnostics->Warn("fit-undefined", entity, force.error().message,
                      "the mate answers as a plain guide");
    return nullptr;
  }
  return std::make_shared<const fits::FitForce>(*force);
}

}  // namespace hvas::sequence
