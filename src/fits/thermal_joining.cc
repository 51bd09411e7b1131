#include "fits/thermal_joining.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace hvas::fits {

double CalcJoiningClearance(double joint_diameter) noexcept {
  return 1e-3 * joint_diameter;
}

double CalcHotClearance(const ThermalJoint& joint, double hub_c, double shaft_c) noexcept {
  return joint.joint_diameter * (joint.hub_expansion * (hub_c - joint.room_c) -
                                 joint.shaft_expansion * (shaft_c - joint.room_c)) -
         joint.interference;
}

double CalcHubTemperature(const ThermalJoint& joint, double clearance, double shaft_c) noexcept {
  return joint.room_c +
         (joint.interference + clearance) / (joint.hub_expansion * joint.joint_diameter) +
         joint.shaft_expansion / joint.hub_expansion * (shaft_c - joint.room_c);
}

double CalcShaftTemperature(const ThermalJoint& joint, double clearance, double hub_c) noexcept {
  return joint.room_c -
         (joint.interference + clearance) / (joint.shaft_expansion * joint.joint_diameter) +
         joint.hub_expansion / joint.shaft_expansion * (hub_c - joint.room_c);
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
  constexpr double kAir = 0.03;
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
  // The clearance is linear in the difference Delta, and at_mean where there is none.
  const double start = CalcHotClearance(joint, hub_c, shaft_c);
  const double left = -at_mean / (start - at_mean);  // Delta / Delta_0 where it sticks.
  const double rate = exchange.conductance * std::numbers::pi * joint.joint_diameter *
                      (1 / exchange.hub_capacity + 1 / exchange.shaft_capacity);
  return std::sqrt(-2 * exchange.speed * std::log(left) / rate);
}

}  // namespace hvas::fits
