#pragma once

#include <string>

#include "product/product.h"

/** What strain a part bears that bends to get to its place: docs/algorithms/flexible.md. */
namespace hvas::product {

/** Strain that the root of a wall or an arm bears once. Rubber 100 %, metals yield strength over
 Young's modulus, plastics 4 %: polycarbonate; most others bear more. A part whose file names no
 material is taken for a plastic.
 Source: Bayer MaterialScience, Snap-Fit Joints for Plastics, table of permissible strains. */
[[nodiscard]] double FindBearableStrain(const Material& material);

/** Strain that a split ring bears when it is opened. That of FindBearableStrain(), but of metals 2
 %, to which the smallest shaft ring of DIN 471 (3 mm) is strained on its way over the shaft. One
 whose file names no material is taken for a metal. */
[[nodiscard]] double FindBearableRingStrain(const Material& material);

/** Describes what a strain is that of: "S235JR", "rubber", or `assumed` where the file names no
 material. */
[[nodiscard]] std::string DescribeBearing(const Material& material, const char* assumed);

}  // namespace hvas::product
