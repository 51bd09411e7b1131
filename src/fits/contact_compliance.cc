#include "fits/contact_compliance.h"

namespace hvas::fits {
namespace {

// Compliance of contacts that state none (haptics::ContactOptions::compliance) [m/N].
constexpr double kSteelCompliance = 5e-7;

}  // namespace

double CalcReducedModulus(const Elasticity& a, const Elasticity& b) noexcept {
  const auto half = [](const Elasticity& body) {
    return (1 - body.poisson_ratio * body.poisson_ratio) / body.youngs_modulus;
  };
  return 1 / (half(a) + half(b));
}

double CalcPunchCompliance(double radius, double reduced_modulus) noexcept {
  return 1 / (2 * radius * reduced_modulus);
}

double CalcContactRadius() noexcept {
  return 1 / (2 * kSteelCompliance * CalcReducedModulus({}, {}));
}

double CalcContactCompliance(const Elasticity& a, const Elasticity& b) noexcept {
  return CalcPunchCompliance(CalcContactRadius(), CalcReducedModulus(a, b));
}

}  // namespace hvas::fits
