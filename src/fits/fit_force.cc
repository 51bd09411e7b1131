#include "fits/fit_force.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "fits/friction.h"

namespace hvas::fits {
namespace {

Result<void> Check(bool is_valid, const char* name, double value, const char* range) {
  if (is_valid) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, fmt::format("{} is {:g}, but must be {}", name, value, range),
              "fit", "check the fit and the sizes of its parts");
}

/** What press_stroke.h does not see: it knows S and no diameters of single parts. */
Result<void> Check(const FitForceParameters& p) {
  const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
  Result<void> result = Check(!p.hole_diameters.empty() || is_positive(p.hole_diameter),
                              "the hole's diameter", p.hole_diameter, "> 0");
  if (result) {
    result = Check(!p.shaft_diameters.empty() || is_positive(p.shaft_diameter),
                   "the shaft's diameter", p.shaft_diameter, "> 0");
  }
  for (const auto* measured : {&p.hole_diameters, &p.shaft_diameters}) {
    double last = -1;
    for (const DiameterAtDepth& place : *measured) {
      if (result) {
        result = Check(is_positive(place.diameter), "a measured diameter", place.diameter, "> 0");
      }
      if (result) {
        result = Check(place.depth > last && place.depth >= 0 && std::isfinite(place.depth),
                       "the depth of a measured diameter", place.depth,
                       "at least 0 and larger than the one before");
      }
      last = place.depth;
    }
  }
  if (result) {
    result =
        Check(p.roughness >= 0 && std::isfinite(p.roughness), "the roughness", p.roughness, ">= 0");
  }
  if (result) {
    result =
        Check(p.friction.slip >= 0 && p.friction.slip <= p.friction.release, "the friction of slip",
              p.friction.slip, "at least 0 and not above the friction at release");
  }
  if (result) {
    result = Check(p.stations >= 1 && p.stations <= 1'000'000, "the number of stations", p.stations,
                   "1 to 1,000,000");
  }
  return result;
}

PressFitParameters ToPressFit(const FitForceParameters& p) {
  PressFitParameters press;
  press.joint_diameter = p.nominal_diameter;
  press.hub_diameter = p.hub_diameter == 0 ? 2 * p.nominal_diameter : p.hub_diameter;
  press.shaft_bore = p.shaft_bore;
  press.length = p.length;
  press.breadth = p.breadth;
  press.interference = p.shaft_diameter - p.hole_diameter;
  press.hub_roughness = press.shaft_roughness = p.roughness;
  press.smoothing = p.smoothing;
  press.hub = p.hub;
  press.shaft = p.shaft;
  press.friction_in = p.friction.in;
  press.friction_release = p.friction.release;
  press.friction_torque = p.friction.turning;
  return press;
}

/** The diameter at each station: measured there, or the same everywhere. */
std::vector<double> ListDiameters(const std::vector<DiameterAtDepth>& measured, double everywhere,
                                  const FitForceParameters& p) {
  std::vector<double> diameters(static_cast<std::size_t>(p.stations) + 1, everywhere);
  for (std::size_t j = 0; j < diameters.size() && !measured.empty(); ++j) {
    diameters[j] = InterpolateDiameter(measured, p.length * static_cast<double>(j) / p.stations);
  }
  return diameters;
}

double CalcMean(const std::vector<double>& values) {
  // Equal values give that value, without a rounding error.
  const double first = values.front();
  double sum = 0;
  for (const double value : values) {
    sum += value - first;
  }
  return first + sum / static_cast<double>(values.size());
}

}  // namespace

double InterpolateDiameter(std::span<const DiameterAtDepth> measured, double depth) noexcept {
  const auto next =
      std::find_if(measured.begin(), measured.end(),
                   [depth](const DiameterAtDepth& place) { return place.depth >= depth; });
  if (next == measured.begin()) {
    return next->diameter;
  }
  const DiameterAtDepth& before = *std::prev(next);
  if (next == measured.end()) {
    return before.diameter;
  }
  const double a = (depth - before.depth) / (next->depth - before.depth);
  return (1 - a) * before.diameter + a * next->diameter;
}

std::vector<double> DrawClearances(const FitForceParameters& parameters) {
  const auto holes = ListDiameters(parameters.hole_diameters, parameters.hole_diameter, parameters);
  const auto shafts =
      ListDiameters(parameters.shaft_diameters, parameters.shaft_diameter, parameters);
  std::vector<double> clearances;
  std::transform(holes.begin(), holes.end(), shafts.begin(), std::back_inserter(clearances),
                 std::minus<>());
  return DrawClearances(clearances, parameters.roughness, parameters.seed);
}

Result<FitForce> FitForce::Make(const FitForceParameters& parameters) {
  FitForceParameters p = parameters;
  if (Result<void> check = Check(p); !check) {
    return Unexpected(check.error());
  }
  p.hole_diameter = CalcMean(ListDiameters(p.hole_diameters, p.hole_diameter, p));
  p.shaft_diameter = CalcMean(ListDiameters(p.shaft_diameters, p.shaft_diameter, p));
  StrokeLand land;
  land.press = ToPressFit(p);
  land.lead_in_angle = p.lead_in_angle;
  land.clearances = DrawClearances(p);
  const Result<PressFit> press = CalcPressFit(land.press);
  if (!press) {
    return Unexpected(press.error());
  }
  Result<PressStroke> forces = PressStroke::Make({land});
  if (!forces) {
    return Unexpected(forces.error());
  }
  FitForce fit(std::move(*forces));
  fit.friction_ = p.friction;
  fit.length_ = p.length;
  fit.step_ = p.length / p.stations;
  fit.outline_ = press->outline;
  fit.torque_radius_ = p.breadth > 0 ? 0 : 0.5 * p.nominal_diameter;
  fit.mean_clearance_ = 0.5 * (p.hole_diameter - p.shaft_diameter);
  fit.shaft_diameter_ = p.shaft_diameter;
  fit.pressure_per_interference_ = press->pressure_per_interference;
  fit.smoothing_loss_ = press->smoothing_loss;
  fit.elastic_limit_ = std::min(press->hub_limit.von_mises, press->shaft_limit.von_mises);
  fit.clearance_ = std::move(land.clearances);
  fit.max_pressure_ =
      fit.CalcPressureOf(*std::min_element(fit.clearance_.begin(), fit.clearance_.end()));
  double play = std::numeric_limits<double>::infinity();
  for (const double s : fit.clearance_) {
    play = std::min(play, std::max(0.0, s));
    fit.play_.push_back(play);
  }
  return fit;
}

FitForce::Place FitForce::Locate(double depth) const noexcept {
  // Written so that a depth that is no number counts as 0.
  const double l = depth > 0 ? std::min(depth, length_) : 0.0;
  const std::size_t last = clearance_.size() - 2;
  const std::size_t interval = std::min(static_cast<std::size_t>(l / step_), last);
  return {interval, std::clamp(l - static_cast<double>(interval) * step_, 0.0, step_)};
}

double FitForce::CalcClearance(double depth) const noexcept {
  const Place place = Locate(depth);
  const double a = place.offset / step_;
  return (1 - a) * clearance_[place.interval] + a * clearance_[place.interval + 1];
}

double FitForce::CalcRadialPlay(double depth) const noexcept {
  // Between stations S is linear, so its least value is at an end.
  return std::min(play_[Locate(depth).interval], std::max(0.0, CalcClearance(depth)));
}

double FitForce::CalcPressureOf(double clearance) const noexcept {
  return 2 * pressure_per_interference_ *
         std::max(0.0, -CalcSmoothedClearance(clearance, smoothing_loss_));
}

double FitForce::CalcPressure(double depth) const noexcept {
  return CalcPressureOf(CalcClearance(depth));
}

double FitForce::CalcNormalForce(double depth) const noexcept {
  return forces_.CalcForce(std::isnan(depth) ? 0 : depth).normal;
}

double FitForce::CalcAxialResistance(double depth) const noexcept {
  // Past L, a chamfer that comes out of the far end is no longer felt, but the joint is as long.
  return std::isnan(depth) ? 0 : forces_.CalcForce(std::min(depth, length_)).in;
}

double FitForce::CalcReleaseForce(double depth, double speed) const noexcept {
  if (std::isnan(depth)) {
    return 0;
  }
  const FrictionLaw law{friction_.release, friction_.slip};
  const double less = friction_.release - law.CalcCoefficient(std::abs(speed));
  const StrokeForce force = forces_.CalcForce(std::min(depth, length_));
  // The chamfer's slope helps outwards; it does not push the shaft out.
  return std::max(0.0, force.release - less * force.normal);
}

double FitForce::CalcTorque(double depth) const noexcept {
  return friction_.turning * CalcNormalForce(depth) * torque_radius_;
}

double FitForce::CalcRadialStiffness(double depth) const noexcept {
  const double l = depth > 0 ? std::min(depth, length_) : 0.0;
  return outline_ * pressure_per_interference_ * l;
}

double FitForce::CalcTiltStiffness(double depth) const noexcept {
  const double l = depth > 0 ? std::min(depth, length_) : 0.0;
  return CalcRadialStiffness(depth) * l * l / 12;
}

}  // namespace hvas::fits
