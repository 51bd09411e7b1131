#include "simulation/fit_of_mate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/random.h"
#include "fits/actual_size.h"
#include "fits/iso286.h"

namespace hvas::simulation {
namespace {

constexpr double kThickestWall = 0.95;  // largest c_0 = R / r_0 that is believed

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

}  // namespace

std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                   const product::Mate& mate, std::uint64_t seed,
                                                   Diagnostics* diagnostics) {
  if (!mate.fit || mate.fit->kind == product::FitKind::kThread || mate.fit->code.empty()) {
    return nullptr;
  }
  const std::string entity = fmt::format("mate m{}", mate.id.value());
  const double nominal = mate.fit->nominal_diameter;
  const auto fit = fits::ParseFit(mate.fit->code);
  const auto limits = fit ? fits::CalcFitLimits(*fit, nominal) : Unexpected(fit.error());
  if (!limits) {
    diagnostics->Warn("fit-undefined", entity, limits.error().message,
                      "the mate answers as a plain guide; assign another fit with --fit");
    return nullptr;
  }
  // Every mate has its own stream, so that one mate's fit does not change another's sizes.
  Random random(seed * 0x9e3779b97f4a7c15u + mate.id.value());
  fits::FitForceParameters parameters;
  parameters.nominal_diameter = nominal;
  parameters.hole_diameter = nominal + fits::DrawDeviation(limits->hole, &random);
  parameters.shaft_diameter = nominal + fits::DrawDeviation(limits->shaft, &random);
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
