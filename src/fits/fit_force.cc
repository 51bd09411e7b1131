#include "fits/fit_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "base/random.h"

namespace hvas::fits {
namespace {

/** Integral of max(0, -s) over [0, x] for s linear from a at 0 with slope k. */
double IntegrateInterference(double a, double k, double x) noexcept {
  const double b = a + k * x;
  if (a >= 0 && b >= 0) {
    return 0;
  }
  if (a < 0 && b < 0) {
    return -0.5 * (a + b) * x;
  }
  // A triangle on the side where s is negative; s crosses zero at -a / k.
  const double crossing = -a / k;
  return a < 0 ? -0.5 * a * crossing : -0.5 * b * (x - crossing);
}

Result<void> Check(bool is_valid, const char* name, double value, const char* range) {
  if (is_valid) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, fmt::format("{} is {:g}, but must be {}", name, value, range),
              "fit", "check the fit and the sizes of its parts");
}

Result<void> Check(const FitForceParameters& p) {
  const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
  const auto is_not_negative = [](double x) { return x >= 0 && std::isfinite(x); };
  Result<void> result =
      Check(is_positive(p.hole_diameter), "the hole's diameter", p.hole_diameter, "> 0");
  if (result) {
    result = Check(is_positive(p.shaft_diameter), "the shaft's diameter", p.shaft_diameter, "> 0");
  }
  if (result) {
    result =
        Check(is_positive(p.nominal_diameter), "the nominal diameter", p.nominal_diameter, "> 0");
  }
  if (result) {
    result = Check(is_positive(p.length), "the mating length", p.length, "> 0");
  }
  if (result) {
    result = Check(p.radius_ratio >= 0 && p.radius_ratio < 1, "the ratio of the radii",
                   p.radius_ratio, "at least 0 and below 1");
  }
  if (result) {
    result = Check(is_positive(p.youngs_modulus), "Young's modulus", p.youngs_modulus, "> 0");
  }
  if (result) {
    result = Check(is_not_negative(p.friction), "the friction coefficient", p.friction, ">= 0");
  }
  if (result) {
    result = Check(is_not_negative(p.roughness), "the roughness", p.roughness, ">= 0");
  }
  if (result) {
    result = Check(p.stations >= 1 && p.stations <= 1'000'000, "the number of stations", p.stations,
                   "1 to 1,000,000");
  }
  return result;
}

}  // namespace

Result<FitForce> FitForce::Make(const FitForceParameters& parameters) {
  if (Result<void> check = Check(parameters); !check) {
    return Unexpected(check.error());
  }
  const FitForceParameters& p = parameters;
  const double stiffness = p.youngs_modulus * (1 - p.radius_ratio * p.radius_ratio);
  FitForce fit;
  fit.length_ = p.length;
  fit.step_ = p.length / p.stations;
  fit.friction_ = p.friction;
  fit.mean_clearance_ = 0.5 * (p.hole_diameter - p.shaft_diameter);
  fit.shaft_diameter_ = p.shaft_diameter;
  fit.force_scale_ = p.friction * std::numbers::pi * stiffness;
  fit.pressure_scale_ = stiffness / p.nominal_diameter;
  Random random(p.seed);
  double play = std::numeric_limits<double>::infinity();
  double resistance = 0;
  for (int j = 0; j <= p.stations; ++j) {
    const double s = fit.mean_clearance_ + 0.5 * p.roughness * random.Uniform(-1, 1);
    if (j > 0) {
      const double before = fit.clearance_.back();
      resistance +=
          fit.force_scale_ * IntegrateInterference(before, (s - before) / fit.step_, fit.step_);
    }
    play = std::min(play, std::max(0.0, s));
    fit.clearance_.push_back(s);
    fit.play_.push_back(play);
    fit.resistance_.push_back(resistance);
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

double FitForce::CalcAxialResistance(double depth) const noexcept {
  const Place place = Locate(depth);
  const double s = clearance_[place.interval];
  const double slope = (clearance_[place.interval + 1] - s) / step_;
  return resistance_[place.interval] + force_scale_ * IntegrateInterference(s, slope, place.offset);
}

double FitForce::CalcPressure(double depth) const noexcept {
  return pressure_scale_ * std::max(0.0, -CalcClearance(depth));
}

}  // namespace hvas::fits
