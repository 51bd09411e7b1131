#include "simulation/test/small_models.h"

#include <utility>

#include <gtest/gtest.h>

namespace hvas::simulation::testing {

CompileOptions FastOptions() {
  CompileOptions options;
  options.threads = 2;
  options.way_looks = 0;
  return options;
}

std::shared_ptr<const Model> CompileFast(Product product) {
  Diagnostics diagnostics;
  auto model = Compile(std::make_shared<Product>(std::move(product)), FastOptions(), &diagnostics);
  EXPECT_TRUE(model) << model.error().message;
  return *model;
}

const std::shared_ptr<const Model>& PegInCarrierInCupModel() {
  static const std::shared_ptr<const Model> model = [] {
    Diagnostics diagnostics;
    return *Compile(std::make_shared<Product>(PegInCarrierInCup()), FastOptions(), &diagnostics);
  }();
  return model;
}

const std::shared_ptr<const Model>& PegInBlockModel() {
  static const std::shared_ptr<const Model> model = [] {
    Diagnostics diagnostics;
    return *Compile(std::make_shared<Product>(PegInBlock()), FastOptions(), &diagnostics);
  }();
  return model;
}

const std::shared_ptr<const Model>& PressedPegModel() {
  static const std::shared_ptr<const Model> model = [] {
    Product peg = PegInBlock();
    for (product::Mate& mate : peg.mates) {
      if (mate.kind == product::MateKind::kAxisHole) {
        mate.fit = product::Fit{product::FitKind::kInterference, "H7/s6", 2 * kBoreRadius, false,
                                "for the test"};
      }
    }
    Diagnostics diagnostics;
    return *Compile(std::make_shared<Product>(std::move(peg)), FastOptions(), &diagnostics);
  }();
  return model;
}

}  // namespace hvas::simulation::testing
