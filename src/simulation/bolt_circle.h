#pragma once

#include "product/product.h"

namespace hvas::simulation {

/** Stiffness of a screw's joint along its axis where gaskets that it goes through are clamped as
 well [N/m]: 1 / (1 / stiffness + sum of n s / F), with n screws through a gasket, F = n preload on
 it, and s its compression then. All screws of the circle are taken to have the same preload.
 @param stiffness  That of the screw and of what it clamps without gaskets [N/m].
 @param preload  Of the screw, tightened [N]. */
[[nodiscard]] double SoftenByGaskets(const product::Product& product, product::OccurrenceId screw,
                                     double stiffness, double preload);

}  // namespace hvas::simulation
