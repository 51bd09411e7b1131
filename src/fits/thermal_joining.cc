#include "fits/thermal_joining.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace hvas::fits {
namespace {

constexpr std::string_view kDinExpansion =
    "DIN 7190, as quoted in the help of WHZ's sheet and of Autodesk Inventor";
constexpr std::string_view kHandbookExpansion =
    "handbook value from 20 to 100 C; reduced for cooling, on the safe side";

double CalcHubStrain(const ThermalJoint& joint, double hub_c) noexcept {
  const double rise = hub_c - joint.room_c;
  return (rise >= 0 ? joint.hub_expansion : joint.hub_contraction) * rise;
}

double CalcShaftStrain(const ThermalJoint& joint, double shaft_c) noexcept {
  const double rise = shaft_c - joint.room_c;
  return (rise >= 0 ? joint.shaft_heating : joint.shaft_expansion) * rise;
}

JoiningMaterial MakeHandbookMaterial(const Material& material, double cooling_share,
                                     double hottest_c, std::string_view limit_source) noexcept {
  return {material.thermal_expansion, cooling_share * material.thermal_expansion, hottest_c,
          kHandbookExpansion, limit_source};
}

}  // namespace

double CalcJoiningClearance(double joint_diameter) noexcept {
  return 1e-3 * joint_diameter;
}

double CalcHotClearance(const ThermalJoint& joint, double hub_c, double shaft_c) noexcept {
  return joint.joint_diameter * (CalcHubStrain(joint, hub_c) - CalcShaftStrain(joint, shaft_c)) -
         joint.interference;
}

double CalcHubTemperature(const ThermalJoint& joint, double clearance, double shaft_c) noexcept {
  const double strain =
      (joint.interference + clearance) / joint.joint_diameter + CalcShaftStrain(joint, shaft_c);
  return joint.room_c + strain / (strain >= 0 ? joint.hub_expansion : joint.hub_contraction);
}

double CalcShaftTemperature(const ThermalJoint& joint, double clearance, double hub_c) noexcept {
  const double strain =
      CalcHubStrain(joint, hub_c) - (joint.interference + clearance) / joint.joint_diameter;
  return joint.room_c + strain / (strain >= 0 ? joint.shaft_heating : joint.shaft_expansion);
}

JoiningMaterial FindJoiningMaterial(const Material& material) noexcept {
  const auto is_named = [&material](std::string_view word) {
    return material.name.find(word) != std::string_view::npos;
  };
  const auto has = [&material](std::string_view word) {
    return material.group.find(word) != std::string_view::npos;
  };
  if (has("stainless")) {
    return MakeHandbookMaterial(material, 0.77, 300,
                                "below the range in which stainless steels embrittle");
  }
  if (has("steel")) {
    constexpr double kHighStrength = 850e6;  // [Pa]: what is quenched and tempered. A choice.
    if (has("case-hardening") || material.yield_strength >= kHighStrength) {
      return {11e-6, 8.5e-6, 200, kDinExpansion,
              "case-hardened or of high strength, DIN 7190, unverified"};
    }
    if (is_named("Q&T")) {
      return {11e-6, 8.5e-6, 300, kDinExpansion, "quenched and tempered, DIN 7190, unverified"};
    }
    return {11e-6, 8.5e-6, 350, kDinExpansion, "steel of low strength, DIN 7190, unverified"};
  }
  if (has("iron")) {
    return {10e-6, 8e-6, 350, kDinExpansion, "as ductile iron, DIN 7190, unverified"};
  }
  if (has("bronze") || has("copper")) {  // Before aluminium, for there is aluminium bronze.
    return {16e-6, 14e-6, 200, kDinExpansion, "work hardening is lost above it, handbooks"};
  }
  if (has("brass")) {
    return {18e-6, 16e-6, 200, kDinExpansion, "work hardening is lost above it, handbooks"};
  }
  if (has("aluminium")) {
    return {23e-6, 18e-6, 150, kDinExpansion, "hardened by ageing near 170 C, handbooks"};
  }
  if (has("magnesium")) {
    return {26e-6, 21e-6, 150, kDinExpansion, "softens above it, handbooks"};
  }
  if (has("polymer")) {
    return MakeHandbookMaterial(material, 0.5, 80, "softens above it, handbooks");
  }
  if (has("zinc")) {
    return MakeHandbookMaterial(material, 0.77, 100, "creeps above it, handbooks");
  }
  return MakeHandbookMaterial(material, 0.77, 300, "scales above it, handbooks");
}

double SpecificHeatOf(std::string_view group) noexcept {
  const auto has = [group](std::string_view word) {
    return group.find(word) != std::string_view::npos;
  };
  if (has("bronze") || has("brass") || has("copper") || has("zinc")) {
    return 390;  // Before aluminium, for there is aluminium bronze.
  }
  if (has("iron")) {
    return 500;
  }
  if (has("aluminium")) {
    return 900;
  }
  if (has("magnesium")) {
    return 1020;
  }
  if (has("titanium")) {
    return 530;
  }
  return has("polymer") ? 1500 : 480;
}

double CalcGapConductance(double clearance) noexcept {
  constexpr double kAir = 0.03;  // [W/(m K)], near 100 C.
  return 2 * kAir / clearance;
}

double CalcStickingDepth(const ThermalJoint& joint, double hub_c, double shaft_c,
                         const HeatExchange& exchange) noexcept {
  if (CalcHotClearance(joint, hub_c, shaft_c) <= 0) {
    return 0;
  }
  const double sum = exchange.hub_capacity + exchange.shaft_capacity;
  const double mean_c = (exchange.hub_capacity * hub_c + exchange.shaft_capacity * shaft_c) / sum;
  const double at_mean = CalcHotClearance(joint, mean_c, mean_c);
  if (at_mean >= 0) {
    return std::numeric_limits<double>::infinity();
  }
  // The clearance falls with the difference; not linearly, for the shaft passes room temperature.
  const auto clearance_at = [&](double left) {
    return CalcHotClearance(joint, mean_c + left * (hub_c - mean_c),
                            mean_c + left * (shaft_c - mean_c));
  };
  double left = 1;  // Delta / Delta_0 where it sticks.
  for (double low = 0; left - low > 1e-13;) {
    const double middle = 0.5 * (low + left);
    (clearance_at(middle) > 0 ? left : low) = middle;
  }
  const double rate = exchange.conductance * std::numbers::pi * joint.joint_diameter *
                      (1 / exchange.hub_capacity + 1 / exchange.shaft_capacity);
  return std::sqrt(-2 * exchange.speed * std::log(left) / rate);
}

}  // namespace hvas::fits
