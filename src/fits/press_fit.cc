#include "fits/press_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** In which unit people state it. */
enum class Unit { kMm, kUm, kMpa, kPure };

struct Bound {
  const char* name;
  double value;
  double low;
  double high;
  bool includes_low;
  Unit unit;
};

std::string FormatWithUnit(double value, Unit unit) {
  switch (unit) {
    case Unit::kMm:
      return fmt::format("{:g} mm", units::ToMm(value));
    case Unit::kUm:
      return fmt::format("{:g} um", units::ToUm(value));
    case Unit::kMpa:
      return fmt::format("{:g} MPa", units::ToMpa(value));
    case Unit::kPure:
      break;
  }
  return fmt::format("{:g}", value);
}

Result<void> CheckBounds(std::initializer_list<Bound> bounds) {
  for (const Bound& b : bounds) {
    const bool is_above = b.includes_low ? b.value >= b.low : b.value > b.low;
    if (!is_above || !(b.value < b.high)) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("{} is {}, but must be {} {}{}", b.name, FormatWithUnit(b.value, b.unit),
                      b.includes_low ? "at least" : "over", FormatWithUnit(b.low, b.unit),
                      b.high < kInfinity ? " and below " + FormatWithUnit(b.high, b.unit) : ""),
          "press fit", "check the sizes and materials of both parts");
    }
  }
  return {};
}

Result<void> Check(const PressFitParameters& p) {
  if (!std::isfinite(p.interference)) {
    return Fail(ErrorCode::kInvalid, "the interference is not a finite number", "press fit",
                "give the sizes of both parts");
  }
  return CheckBounds(
      {{"the joint's diameter", p.joint_diameter, 0, kInfinity, false, Unit::kMm},
       {"the hub's outer diameter", p.hub_diameter, p.joint_diameter, kInfinity, false, Unit::kMm},
       {"the shaft's bore", p.shaft_bore, 0, p.joint_diameter, true, Unit::kMm},
       {"the joint's length", p.length, 0, kInfinity, false, Unit::kMm},
       {"the joint's breadth", p.breadth, 0, kInfinity, true, Unit::kMm},
       {"the hub's roughness", p.hub_roughness, 0, kInfinity, true, Unit::kUm},
       {"the shaft's roughness", p.shaft_roughness, 0, kInfinity, true, Unit::kUm},
       {"the hub's Young's modulus", p.hub.youngs_modulus, 0, kInfinity, false, Unit::kMpa},
       {"the shaft's Young's modulus", p.shaft.youngs_modulus, 0, kInfinity, false, Unit::kMpa},
       {"the hub's Poisson's ratio", p.hub.poisson_ratio, 0, 0.5001, true, Unit::kPure},
       {"the shaft's Poisson's ratio", p.shaft.poisson_ratio, 0, 0.5001, true, Unit::kPure},
       {"the friction when pressing in", p.friction_in, 0, kInfinity, true, Unit::kPure},
       {"the friction at release", p.friction_release, 0, kInfinity, true, Unit::kPure},
       {"the friction against turning", p.friction_torque, 0, kInfinity, true, Unit::kPure}});
}

/** What both sides give way: diametral strain, or strain of the width, for each pascal. */
struct Compliance {
  double hub{0};    // K_A / E_A
  double shaft{0};  // K_I / E_I
};

/** 1 / E' of plane strain. */
double CalcPlaneCompliance(const PressMaterial& material) {
  return (1 - material.poisson_ratio * material.poisson_ratio) / material.youngs_modulus;
}

Compliance CalcCompliance(const PressFitParameters& p) {
  if (p.breadth > 0) {
    const double walls = (p.hub_diameter - p.joint_diameter) / p.joint_diameter;
    return {walls * CalcPlaneCompliance(p.hub), CalcPlaneCompliance(p.shaft)};
  }
  const double qa2 = std::pow(p.joint_diameter / p.hub_diameter, 2);
  const double qi2 = std::pow(p.shaft_bore / p.joint_diameter, 2);
  return {((1 + qa2) / (1 - qa2) + p.hub.poisson_ratio) / p.hub.youngs_modulus,
          ((1 + qi2) / (1 - qi2) - p.shaft.poisson_ratio) / p.shaft.youngs_modulus};
}

double CalcSmoothingLoss(const PressFitParameters& p) {
  return GetSmoothingFactor(p.smoothing) * (p.hub_roughness + p.shaft_roughness);
}

/** Slabs in compression yield where the pressure is their strength: by Tresca; in plane strain a
 little later by von Mises, which is left out on the safe side. */
ElasticLimit CalcFlatLimit(const PressMaterial& m) {
  const double limit = m.yield_strength > 0 ? m.yield_strength : m.tensile_strength;
  return limit > 0 ? ElasticLimit{limit, limit} : ElasticLimit{kInfinity, kInfinity};
}

ElasticLimit CalcHubLimit(const PressFitParameters& p) {
  const double q2 = std::pow(p.joint_diameter / p.hub_diameter, 2);
  const PressMaterial& m = p.hub;
  if (m.yield_strength > 0) {
    return {(1 - q2) * m.yield_strength / std::sqrt(3 + q2 * q2), (1 - q2) * m.yield_strength / 2};
  }
  if (m.tensile_strength > 0) {  // Brittle: the hoop stress must stay below Rm.
    const double limit = m.tensile_strength * (1 - q2) / (1 + q2);
    return {limit, limit};
  }
  return {kInfinity, kInfinity};
}

ElasticLimit CalcShaftLimit(const PressFitParameters& p) {
  const double q2 = std::pow(p.shaft_bore / p.joint_diameter, 2);
  const PressMaterial& m = p.shaft;
  // A brittle shaft is in compression throughout; its tensile strength is on the safe side.
  const double strength = m.yield_strength > 0 ? m.yield_strength : m.tensile_strength;
  if (!(strength > 0)) {
    return {kInfinity, kInfinity};
  }
  // The bore of a hollow shaft is in uniaxial, a solid one in equal biaxial compression: von Mises
  // and Tresca agree.
  const double limit = q2 > 0 ? (1 - q2) * strength / 2 : strength;
  return {limit, limit};
}

bool IsBrittle(const PressMaterial& m) {
  return !(m.yield_strength > 0) && m.tensile_strength > 0;
}

double CalcMargin(double limit, double pressure) {
  return pressure > 0 ? limit / pressure : kInfinity;
}

}  // namespace

double GetSmoothingFactor(Smoothing edition) noexcept {
  switch (edition) {
    case Smoothing::kNone:
      break;
    case Smoothing::kDin2001:
      return 0.8;
    case Smoothing::kDin2017:
      return 0.4;
  }
  return 0;
}

PressMaterial ToPressMaterial(const Material& material) noexcept {
  const double yield = material.group == "grey iron" ? 0 : material.yield_strength;
  return {material.youngs_modulus, material.poisson_ratio, yield, material.tensile_strength,
          material.thermal_expansion};
}

double RingStress::von_mises() const noexcept {
  return std::sqrt(hoop * hoop - hoop * radial + radial * radial);
}

double RingStress::tresca() const noexcept {
  return std::max({hoop, radial, 0.0}) - std::min({hoop, radial, 0.0});
}

double PressFit::margin_von_mises() const noexcept {
  return CalcMargin(std::min(hub_limit.von_mises, shaft_limit.von_mises), pressure);
}

double PressFit::margin_tresca() const noexcept {
  return CalcMargin(std::min(hub_limit.tresca, shaft_limit.tresca), pressure);
}

double PressFit::margin_hub() const noexcept {
  return CalcMargin(hub_limit.von_mises, pressure);
}

double PressFit::margin_shaft() const noexcept {
  return CalcMargin(shaft_limit.von_mises, pressure);
}

bool IsFracturing(const PressFit& fit) noexcept {
  return fit.is_hub_brittle && fit.margin_hub() < kBrittleSafety;
}

double CalcLargestPressure(const PressFit& fit) noexcept {
  return std::min(fit.hub_limit.von_mises / (fit.is_hub_brittle ? kBrittleSafety : 1),
                  fit.shaft_limit.von_mises);
}

Result<PressFit> CalcPressFit(const PressFitParameters& parameters) {
  const PressFitParameters& p = parameters;
  if (Result<void> check = Check(p); !check) {
    return Unexpected(check.error());
  }
  const Compliance compliance = CalcCompliance(p);
  PressFit fit;
  fit.smoothing_loss = CalcSmoothingLoss(p);
  fit.effective_interference = std::max(0.0, p.interference - fit.smoothing_loss);
  fit.pressure_per_interference = 1 / (p.joint_diameter * (compliance.hub + compliance.shaft));
  fit.pressure = fit.pressure_per_interference * fit.effective_interference;
  fit.hub_expansion = fit.pressure * p.joint_diameter * compliance.hub;
  fit.shaft_contraction = fit.pressure * p.joint_diameter * compliance.shaft;
  fit.is_hub_brittle = IsBrittle(p.hub);
  if (p.breadth > 0) {
    fit.outline = 2 * p.breadth;
    fit.hub_bore = fit.shaft_surface = fit.shaft_governing = {0, -fit.pressure};
    fit.hub_limit = CalcFlatLimit(p.hub);
    fit.shaft_limit = CalcFlatLimit(p.shaft);
  } else {
    fit.outline = std::numbers::pi * p.joint_diameter;
    const double qa2 = std::pow(p.joint_diameter / p.hub_diameter, 2);
    const double qi2 = std::pow(p.shaft_bore / p.joint_diameter, 2);
    fit.hub_bore = {fit.pressure * (1 + qa2) / (1 - qa2), -fit.pressure};
    fit.shaft_surface = {-fit.pressure * (1 + qi2) / (1 - qi2), -fit.pressure};
    fit.shaft_governing =
        qi2 > 0 ? RingStress{-2 * fit.pressure / (1 - qi2), 0} : fit.shaft_surface;
    fit.hub_limit = CalcHubLimit(p);
    fit.shaft_limit = CalcShaftLimit(p);
  }
  const double normal_force = fit.outline * p.length * fit.pressure;
  fit.press_in_force = p.friction_in * normal_force;
  fit.push_out_force = p.friction_release * normal_force;
  // Walls hold against turning by their form, not by friction.
  fit.torque = p.breadth > 0 ? 0 : p.friction_torque * normal_force * p.joint_diameter / 2;
  return fit;
}

Result<double> CalcInterferenceFor(double pressure, const PressFitParameters& parameters) {
  if (Result<void> check = Check(parameters); !check) {
    return Unexpected(check.error());
  }
  const Compliance compliance = CalcCompliance(parameters);
  return pressure * parameters.joint_diameter * (compliance.hub + compliance.shaft) +
         CalcSmoothingLoss(parameters);
}

double CalcRequiredPressure(const PressFitParameters& parameters, double axial_load,
                            double torque_load, double safety) noexcept {
  const PressFitParameters& p = parameters;
  const double load = std::hypot(axial_load, 2 * torque_load / p.joint_diameter);
  const double friction = std::min(p.friction_release, p.friction_torque);
  return safety * load / (std::numbers::pi * p.joint_diameter * p.length * friction);
}

}  // namespace hvas::fits
