// Screws that clamp a gasket.

#include "simulation/bolt_circle.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "fits/pressed_parts.h"
#include "mates/elastic_parts.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using product::Product;

constexpr std::uint32_t kScrews = 4;
constexpr double kJoint = 3e8;      // [N/m]
constexpr double kPreload = 500.0;  // [N]

/** A block (0), a gasket (1), and screws through the gasket into the block. */
Product GasketUnderScrews() {
  Product product;
  product::ElasticPart gasket;
  gasket.occurrence = OccurrenceId(1);
  gasket.kind = product::ElasticKind::kGasket;
  gasket.area = 1500e-6;
  gasket.free_area = 400e-6;
  gasket.thickness = 2e-3;
  gasket.length = 2e-3;
  gasket.free_size = 2e-3;
  gasket.modulus = 5e6;
  product.elastic.push_back(gasket);
  for (std::uint32_t i = 0; i < kScrews; ++i) {
    for (const std::uint32_t hole : {0U, 1U}) {
      product::Mate mate;
      mate.kind = product::MateKind::kAxisHole;
      mate.a.occurrence = OccurrenceId(hole);
      mate.b.occurrence = OccurrenceId(2 + i);
      product::Fit fit;
      fit.kind = hole == 0 ? product::FitKind::kThread : product::FitKind::kPassage;
      mate.fit = fit;
      product.mates.push_back(mate);
    }
  }
  return product;
}

// At its preload a screw has turned by what the joint and the gasket under all screws give.
TEST(BoltCircle, AScrewGivesByItsJointAndByTheGasketUnderAllScrews) {
  const Product product = GasketUnderScrews();
  const double soft = SoftenByGaskets(product, OccurrenceId(2), kJoint, kPreload);
  const auto law = mates::MakePressedPart(product.elastic[0]);
  ASSERT_TRUE(law);
  const double of_gasket = kPreload / soft - kPreload / kJoint;
  EXPECT_GT(of_gasket, 0.01e-3);
  EXPECT_LT(of_gasket, 1e-3);
  EXPECT_NEAR(fits::CalcPressForce(*law, of_gasket), kScrews * kPreload, 0.01);
}

TEST(BoltCircle, AScrewBesideTheGasketOrWithoutPreloadIsAsStiffAsItsJoint) {
  const Product product = GasketUnderScrews();
  EXPECT_EQ(SoftenByGaskets(product, OccurrenceId(9), kJoint, kPreload), kJoint);
  EXPECT_EQ(SoftenByGaskets(product, OccurrenceId(2), kJoint, 0), kJoint);
  Product rigid = product;
  rigid.elastic.clear();
  EXPECT_DOUBLE_EQ(SoftenByGaskets(rigid, OccurrenceId(2), kJoint, kPreload), kJoint);
}

}  // namespace
}  // namespace hvas::simulation
