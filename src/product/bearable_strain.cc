#include "product/bearable_strain.h"

#include "product/flexible.h"

namespace hvas::product {
namespace {

constexpr double kPlasticStrain = 0.04;    // Bayer: polycarbonate, once.
constexpr double kRubberStrain = 1;        // Rubber stretches by more than a hundred per cent.
constexpr double kMetalRingStrain = 0.02;  // DIN 471, 3 mm: 2.0 % on its way over the shaft.
constexpr double kSoftestOfMetals = 20e9;  // [Pa]; filled plastics stay below. A choice.

}  // namespace

double FindBearableStrain(const Material& material) {
  if (IsRubber(material)) {
    return kRubberStrain;
  }
  const bool is_metal = !material.is_standard_assumed && material.youngs_modulus > kSoftestOfMetals;
  return is_metal ? material.yield_strength / material.youngs_modulus : kPlasticStrain;
}

double FindBearableRingStrain(const Material& material) {
  const bool is_metal = !IsRubber(material) && (material.is_standard_assumed ||
                                                material.youngs_modulus > kSoftestOfMetals);
  return is_metal ? kMetalRingStrain : FindBearableStrain(material);
}

std::string DescribeBearing(const Material& material, const char* assumed) {
  if (IsRubber(material)) {
    return "rubber";
  }
  return material.is_standard_assumed ? assumed : material.standard;
}

}  // namespace hvas::product
