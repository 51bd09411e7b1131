#include "cad/step/material.h"

#include <fmt/format.h>

#include "fits/materials.h"

namespace hvas::cad {

std::optional<double> NormaliseDensity(double value) {
  constexpr double kLowest = 400;     // Light wood.
  constexpr double kHighest = 23000;  // Osmium, rounded up.
  for (const double factor : {1.0, 1e3, 1e6, 1e9}) {
    const double density = value * factor;
    if (density >= kLowest && density <= kHighest) {
      return density;
    }
  }
  return std::nullopt;
}

product::Material MakeMaterial(const std::optional<StatedMaterial>& stated,
                               const std::string& part_name, Diagnostics* diagnostics) {
  product::Material material;
  std::optional<double> density;
  std::optional<fits::MaterialMatch> match;
  if (stated) {
    material.name = stated->name;
    density = NormaliseDensity(stated->density);
    match = fits::FindMaterial(stated->name);
  }
  material.is_standard_assumed = !match || match->is_stand_in;
  if (!match && density) {
    match = fits::FindMaterialByDensity(*density);
  }
  const fits::Material& standard = match ? *match->material : fits::DefaultMaterial();
  material.standard = standard.name;
  material.youngs_modulus = standard.youngs_modulus;
  material.poisson_ratio = standard.poisson_ratio;
  material.yield_strength = standard.yield_strength;
  material.thermal_expansion = standard.thermal_expansion;
  material.density = density.value_or(standard.density);
  material.is_assumed = !density;
  if (!density) {
    const std::string assumed =
        fmt::format("{} kg/m3 ({}) assumed", standard.density, standard.name);
    diagnostics->Note("assumed-density", part_name,
                      !stated || stated->density == 0
                          ? "the file has no density; " + assumed
                          : fmt::format("a density of {} is implausible in any unit; {}",
                                        stated->density, assumed),
                      "give the part a material in the CAD system");
  }
  return material;
}

}  // namespace hvas::cad
