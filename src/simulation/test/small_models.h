#pragma once

#include <memory>

#include "sequence/test/small_products.h"
#include "simulation/model.h"

/** Compiled models of small products. */
namespace hvas::simulation::testing {

using namespace sequence::testing;  // NOLINT(google-build-using-namespace): the products
                                    // themselves.

/** The model of PegInCarrierInCup, compiled once in a program. */
const std::shared_ptr<const Model>& PegInCarrierInCupModel();

/** The model of PegInBlock, compiled once in a program. */
const std::shared_ptr<const Model>& PegInBlockModel();

/** The model of PegInBlock(), whose peg has an interference in its bore. */
const std::shared_ptr<const Model>& PressedPegModel();

/** No search for ways that turn, for speed. */
CompileOptions FastOptions();

/** The model of a product, compiled with FastOptions(); a failure of the test where there is none.
 */
std::shared_ptr<const Model> CompileFast(Product product);

}  // namespace hvas::simulation::testing
