#include "fits/press_stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/random.h"
#include "base/units.h"

namespace hvas::fits {
namespace {

/** Integral of max(0, -s) over a step along which s goes evenly from a to b. */
double IntegrateInterference(double a, double b, double step) noexcept {
  const double sum = std::max(0.0, -a) + std::max(0.0, -b);
  return sum > 0 ? 0.5 * step * sum * sum / (std::abs(a) + std::abs(b)) : 0;
}

Result<void> Check(const StrokeLand& land) {
  const auto fail = [](std::string what, std::string remedy) {
    return Fail(ErrorCode::kInvalid, std::move(what), "stroke", std::move(remedy));
  };
  if (!(land.start >= 0) || !std::isfinite(land.start)) {
    return fail(fmt::format("a land begins at {:g} mm", units::ToMm(land.start)),
                "give the depth at which it begins to engage, 0 or more");
  }
  // Steeper than this, friction and slope together lock.
  const double steepest = std::atan(1 / std::max(land.press.friction_in, 1e-12));
  if (!(land.lead_in_angle >= 0) || !(land.lead_in_angle < steepest)) {
    return fail(
        fmt::format("a chamfer of {:g} degrees from the axis is not a lead-in",
                    units::ToDeg(land.lead_in_angle)),
        fmt::format("give an angle above 0 and below {:.1f} degrees; DIN 7190-1 recommends 5",
                    units::ToDeg(steepest)));
  }
  if (land.clearances.size() == 1 || !std::all_of(land.clearances.begin(), land.clearances.end(),
                                                  [](double s) { return std::isfinite(s); })) {
    return fail("a land has fewer than two clearances, or one that is not finite",
                "give at least two finite numbers");
  }
  return {};
}

}  // namespace

std::vector<double> DrawClearances(double diametral_clearance, double rz, int stations,
                                   std::uint64_t seed) {
  const std::vector<double> even(static_cast<std::size_t>(std::max(1, stations)) + 1,
                                 diametral_clearance);
  return DrawClearances(even, rz, seed);
}

std::vector<double> DrawClearances(std::span<const double> diametral_clearances, double rz,
                                   std::uint64_t seed) {
  Random random(seed);
  std::vector<double> clearances;
  for (const double clearance : diametral_clearances) {
    clearances.push_back(0.5 * clearance + 0.5 * rz * random.Uniform(-1, 1));
  }
  return clearances;
}

Result<PressStroke> PressStroke::Make(std::vector<StrokeLand> lands) {
  if (lands.empty()) {
    return Fail(ErrorCode::kInvalid, "a stroke needs a land", "stroke", "give at least one fit");
  }
  PressStroke stroke;
  stroke.begin_ = std::numeric_limits<double>::infinity();
  for (StrokeLand& source : lands) {
    if (Result<void> check = Check(source); !check) {
      return Unexpected(check.error());
    }
    const Result<PressFit> fit = CalcPressFit(source.press);
    if (!fit) {
      return Unexpected(fit.error());
    }
    const PressFitParameters& p = source.press;
    if (source.clearances.empty()) {
      source.clearances.assign(2, -0.5 * p.interference);
    }
    Land land{source.start,
              p.length,
              std::tan(source.lead_in_angle),
              p.friction_in,
              p.friction_release,
              fit->outline * fit->pressure_per_interference,
              p.length / static_cast<double>(source.clearances.size() - 1),
              std::move(source.clearances),
              {0}};
    for (double& s : land.s) {
      s = CalcSmoothedClearance(s, fit->smoothing_loss);
    }
    for (std::size_t j = 1; j < land.s.size(); ++j) {
      land.integral.push_back(land.integral.back() +
                              IntegrateInterference(land.s[j - 1], land.s[j], land.step));
    }
    const double ramp =
        land.tan_lead_in > 0 ? std::max(0.0, -land.s.front()) / land.tan_lead_in : 0;
    stroke.begin_ = std::min(stroke.begin_, land.start - ramp);
    stroke.end_ = std::max(stroke.end_, land.start + land.length);
    stroke.lands_.push_back(std::move(land));
  }
  return stroke;
}

double PressStroke::InterferenceAt(const Land& land, double z) noexcept {
  const double at = std::clamp(z, 0.0, land.length) / land.step;
  const std::size_t j = std::min(static_cast<std::size_t>(at), land.s.size() - 2);
  const double part = at - static_cast<double>(j);
  return std::max(0.0, -((1 - part) * land.s[j] + part * land.s[j + 1]));
}

double PressStroke::IntegrateTo(const Land& land, double z) noexcept {
  if (!(z > 0)) {
    return 0;
  }
  if (z >= land.length) {
    return land.integral.back();
  }
  const double at = z / land.step;
  const std::size_t j = std::min(static_cast<std::size_t>(at), land.s.size() - 2);
  const double part = at - static_cast<double>(j);
  const double b = land.s[j] + part * (land.s[j + 1] - land.s[j]);
  return land.integral[j] + IntegrateInterference(land.s[j], b, part * land.step);
}

double PressStroke::IntegrateRamp(const Land& land, double z) noexcept {
  if (!(land.tan_lead_in > 0)) {
    return 0;
  }
  const double n = InterferenceAt(land, z);
  const double ramp = n / land.tan_lead_in;
  // Only the part of it that is between the mouth and the land's end touches.
  const double from = std::max(z, 0.0) - z;
  const double to = std::min(ramp, land.length - z);
  return to > from ? (n - 0.5 * land.tan_lead_in * (from + to)) * (to - from) : 0;
}

StrokeForce PressStroke::CalcForce(double depth) const noexcept {
  StrokeForce force;
  for (const Land& land : lands_) {
    const double z = depth - land.start;
    // Of diametral interference: twice the radial one.
    const double body = 2 * land.force_per_area * IntegrateTo(land, z);
    const double ramp = 2 * land.force_per_area * IntegrateRamp(land, z);
    const double t = land.tan_lead_in;
    force.normal += body;
    force.in +=
        land.friction_in * body + (land.friction_in + t) / (1 - land.friction_in * t) * ramp;
    force.release += land.friction_release * body +
                     (land.friction_release - t) / (1 + land.friction_release * t) * ramp;
  }
  return force;
}

double PressStroke::CalcWork() const noexcept {
  // Steps of Simpson's rule, whose error falls with their fourth power: a choice.
  constexpr int kSteps = 2000;
  const double step = (end_ - begin_) / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double weight = i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * CalcForce(begin_ + i * step).in;
  }
  return sum * step / 3;
}

}  // namespace hvas::fits
