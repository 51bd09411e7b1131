#include "haptics/giving_curve.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

// Surfaces that would lock themselves hold no more than twenty times what friction alone does: the
// arm's end turns, or breaks, before. A choice.
constexpr double kLeastRest = 0.05;

/** How far it gives, and its first two derivatives by the distance outwards. */
struct Shape {
  double given{0};
  double slope{0};      // [1]
  double curvature{0};  // [1/m]
};

double ControlPoint(const GivingCurve& curve, std::ptrdiff_t i) noexcept {
  const auto count = static_cast<std::ptrdiff_t>(curve.given.size());
  return i >= count ? 0.0 : curve.given[static_cast<std::size_t>(std::max<std::ptrdiff_t>(i, 0))];
}

Shape CalcShape(const GivingCurve& curve, double travel) noexcept {
  if (!curve.pressed.empty()) {
    return travel < curve.compression ? Shape{curve.compression - travel, -1, 0} : Shape{};
  }
  if (curve.given.empty() || travel >= curve.length()) {
    return {};
  }
  const double h = curve.spacing;
  if (travel <= -0.5 * h) {
    return {curve.given.front(), 0, 0};
  }
  const double along = travel / h + 0.5;
  const double whole = std::floor(along);
  const double u = along - whole;
  const auto i = static_cast<std::ptrdiff_t>(whole);
  const double before = ControlPoint(curve, i - 1);
  const double middle = ControlPoint(curve, i);
  const double after = ControlPoint(curve, i + 1);
  return {0.5 * (1 - u) * (1 - u) * before + (0.5 + u * (1 - u)) * middle + 0.5 * u * u * after,
          (-(1 - u) * before + (1 - 2 * u) * middle + u * after) / h,
          (before - 2 * middle + after) / (h * h)};
}

/** Force of what is pressed together, and its slope. */
struct PressedForce {
  double force{0};  // [N]
  double rise{0};   // [N/m]
};

/** @pre 0 < given, and the table has two entries at least. Beyond its place the last slope goes on,
 where it rises. */
PressedForce CalcPressed(const GivingCurve& curve, double given) noexcept {
  const std::size_t last = curve.pressed.size() - 1;
  const double step = curve.compression / static_cast<double>(last);
  const double along = given / step;
  if (along >= static_cast<double>(last)) {
    const double rise = std::max(0.0, (curve.pressed[last] - curve.pressed[last - 1]) / step);
    return {curve.pressed[last] + rise * (given - curve.compression), rise};
  }
  const auto i = static_cast<std::size_t>(along);
  const double rise = (curve.pressed[i + 1] - curve.pressed[i]) / step;
  return {curve.pressed[i] + rise * (given - static_cast<double>(i) * step), rise};
}

double CalcAcross(const GivingCurve& curve, double given) noexcept {
  if (!curve.pressed.empty()) {
    return given > 0 ? CalcPressed(curve, given).force : 0;
  }
  return curve.squeezed ? fits::CalcSqueezeForce(*curve.squeezed, given) : curve.stiffness * given;
}

}  // namespace

double GivingCurve::CalcGiven(double travel) const noexcept {
  return CalcShape(*this, travel).given;
}

GivingLoad& GivingLoad::operator+=(const GivingLoad& other) noexcept {
  spring += other.spring;
  stiffness += other.stiffness;
  in += other.in;
  out += other.out;
  return *this;
}

GivingLoad CalcGivingLoad(const GivingCurve& curve, double travel) noexcept {
  const Shape shape = CalcShape(curve, travel);
  if (!(shape.given > 0)) {
    return {};
  }
  if (!curve.pressed.empty()) {
    const PressedForce pressed = CalcPressed(curve, shape.given);
    return {pressed.force, pressed.rise, 0, 0};
  }
  const double across = CalcAcross(curve, shape.given);
  const double rise =
      curve.squeezed ? fits::CalcSqueezeStiffness(*curve.squeezed, shape.given) : curve.stiffness;
  const double m_in = -shape.slope;
  const double mu = curve.friction;
  const auto friction = [&](double m) {
    return across * mu * (1 + m * m) / std::max(kLeastRest, 1 - mu * m);
  };
  return {across * m_in, rise * m_in * m_in + across * shape.curvature, friction(m_in),
          friction(-m_in)};
}

double CalcGivingEnergy(const GivingCurve& curve, double travel) {
  constexpr int kSteps = 200;  // Simpson's error is below 1e-6 of the energy: a choice.
  const double given = CalcShape(curve, travel).given;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * CalcAcross(curve, given * i / kSteps);
  }
  return sum * given / (3 * kSteps);
}

GivingPeak CalcGivingPeak(const GivingCurve& curve) {
  constexpr int kPerPoint = 8;  // The slope is linear between points: a choice.
  GivingPeak peak;
  const int count = kPerPoint * static_cast<int>(curve.given.size() + curve.pressed.size() + 1);
  for (int i = 0; i <= count; ++i) {
    const GivingLoad load = CalcGivingLoad(curve, curve.length() * i / std::max(1, count));
    peak.in = std::max(peak.in, load.spring + load.in);
    peak.out = std::max(peak.out, load.out - load.spring);
  }
  return peak;
}

}  // namespace hvas::haptics
