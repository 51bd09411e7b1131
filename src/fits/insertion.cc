#include "fits/insertion.h"

#include <cmath>
#include <limits>

namespace hvas::fits {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double PegInHole::relative_clearance() const noexcept {
  return (hole_diameter - peg_diameter) / hole_diameter;
}

double CalcTwoPointTilt(const PegInHole& pair, double l) noexcept {
  const double cosine = pair.hole_diameter / std::hypot(pair.peg_diameter, l);
  return cosine <= 1 ? std::atan2(l, pair.peg_diameter) - std::acos(cosine) : kNotANumber;
}

double CalcTwoPointLength(const PegInHole& pair, double tilt) noexcept {
  if (tilt <= 0) {
    return std::numeric_limits<double>::infinity();
  }
  if (tilt > CalcLargestTilt(pair)) {
    return kNotANumber;
  }
  return (pair.hole_diameter - pair.peg_diameter * std::cos(tilt)) / std::sin(tilt);
}

double CalcLargestTilt(const PegInHole& pair) noexcept {
  return std::acos(pair.peg_diameter / pair.hole_diameter);
}

double CalcLeastTwoPointLength(const PegInHole& pair) noexcept {
  return std::sqrt((pair.hole_diameter - pair.peg_diameter) *
                   (pair.hole_diameter + pair.peg_diameter));
}

double CalcTipDepth(const PegInHole& pair, double tilt) noexcept {
  const double cosine = std::cos(tilt);
  return (pair.hole_diameter * cosine - 0.5 * pair.peg_diameter * (cosine * cosine + 1)) /
         std::sin(tilt);
}

double CalcEntryWindow(const PegInHole& pair, double hole_chamfer, double peg_chamfer) noexcept {
  return 0.5 * (pair.hole_diameter - pair.peg_diameter) + hole_chamfer + peg_chamfer;
}

PegLoad CalcTwoPointLoad(double f1, double f2, double l, double radius, double friction) noexcept {
  return {f1 - f2, friction * (f1 + f2), l * f2 + friction * radius * (f2 - f1)};
}

double CalcLambda(double l, double radius, double friction) noexcept {
  return l / (2 * radius * friction);
}

std::array<DiagramPoint, 4> CalcJammingDiagram(double lambda, double friction) noexcept {
  const double end = 1 / friction;
  return {{{end, -1}, {-end, 1 + 2 * lambda}, {-end, 1}, {end, -(1 + 2 * lambda)}}};
}

bool IsSliding(const PegLoad& load, double l, double radius, double friction) noexcept {
  if (!(load.f_z > 0)) {
    return false;
  }
  const double lambda = CalcLambda(l, radius, friction);
  const double across = load.f_x / load.f_z;
  const double moment = load.m / (radius * load.f_z);
  return std::abs(across) * friction < 1 &&
         std::abs(moment + friction * (1 + lambda) * across) < lambda;
}

bool CanWedge(const PegInHole& pair, double l, double friction) noexcept {
  return l <= friction * pair.peg_diameter;
}

double CalcWedgingTilt(const PegInHole& pair, double friction) noexcept {
  const double l = friction * pair.peg_diameter;
  // Where two-point contact only begins deeper than that, no tilt that enters can wedge.
  return l > CalcLeastTwoPointLength(pair) ? CalcTwoPointTilt(pair, l) : CalcLargestTilt(pair);
}

InsertionForce CalcChamferForce(const CompliantSupport& support, double radius, double friction,
                                double chamfer_angle, double descent) noexcept {
  const double sine = std::sin(chamfer_angle);
  const double cosine = std::cos(chamfer_angle);
  const double a = cosine + friction * sine;
  const double b = sine - friction * cosine;
  const double h = support.height;
  const double stiffness = (support.k_x * h * h + support.k_t) * b - support.k_x * h * radius * a;
  if (!(b > 0) || !(stiffness > 0)) {
    return {kNotANumber, kNotANumber, kNotANumber};
  }
  const double f = support.k_x * support.k_t * descent * cosine / sine / stiffness;
  return {f, a * f, b * f};
}

InsertionForce CalcOnePointForce(const CompliantSupport& support, double radius, double friction,
                                 double offset, double tilt, double l) noexcept {
  const double arm = support.height - l;
  const double stiffness = support.k_t + support.k_x * arm * (arm - friction * radius);
  if (!(stiffness > 0)) {
    return {kNotANumber, kNotANumber, kNotANumber};
  }
  const double f = support.k_x * support.k_t * (offset + l * tilt) / stiffness;
  return {f, friction * f, f};
}

}  // namespace hvas::fits
