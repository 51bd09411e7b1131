#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using product::Product;
using spatial::Pose;
using testing::Session;

constexpr double kWeightTime = 300;  // [s]

/** Poses of a product in which its part goes in from above, from the side and from below. */
std::array<Pose, 3> ListWaysIn() {
  const auto turned = [](double angle) {
    return Pose(spatial::RotationFromVector(angle * Vec3::UnitX()), Vec3::Zero());
  };
  return {turned(0), turned(0.5 * std::numbers::pi), turned(std::numbers::pi)};
}

/** A plate on a larger one: planes alone hold it. `scale` is that of all lengths. */
Product PlateOnPlate(const Pose& X_WP, double scale) {
  Product product;
  product.name = "plates";
  const Vec3 half_base = scale * Vec3(30e-3, 30e-3, 10e-3);
  const Vec3 half_plate = scale * Vec3(20e-3, 15e-3, 4e-3);
  const auto base =
      sequence::testing::AddPart(&product, "base", contact::testing::Block(half_base));
  const auto plate =
      sequence::testing::AddPart(&product, "plate", contact::testing::Block(half_plate));
  sequence::testing::Place(&product, base, "base", X_WP);
  sequence::testing::Place(&product, plate, "plate",
                           X_WP * Pose(Vec3(0, 0, half_base.z() + half_plate.z())));
  sequence::testing::Complete(&product);
  return product;
}

/** The block and the peg of sequence::testing::PegInBlock, with all lengths multiplied. */
Product ScaledPegInBlock(const Pose& X_WP, double scale) {
  Product product;
  product.name = "rig";
  const auto block = sequence::testing::AddPart(
      &product, "block",
      contact::testing::Cup(scale * sequence::testing::kBoreRadius, scale * 15e-3,
                            scale * sequence::testing::kFloor,
                            scale * sequence::testing::kBlockHeight));
  const auto peg =
      sequence::testing::AddPart(&product, "peg",
                                 contact::testing::Shaft(scale * sequence::testing::kBoreRadius,
                                                         scale * sequence::testing::kPegLength));
  sequence::testing::Place(&product, block, "block", X_WP);
  sequence::testing::Place(&product, peg, "peg",
                           X_WP * Pose(Vec3(0, 0, scale * sequence::testing::kFloor)));
  sequence::testing::Complete(&product);
  return product;
}

/** Gives the second part another mass, as if it had another density. */
Product WithMass(Product product, double mass) {
  product::MassProperties& properties = product.parts[1].mass;
  properties.I_BBcm_B *= mass / properties.mass;
  properties.mass = mass;
  return product;
}

void ExpectInPlace(const Product& product) {
  Diagnostics diagnostics;
  const auto model = simulation::Compile(std::make_shared<Product>(product),
                                         simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value());
  Session session(*model);
  (void)simulation::RunLockstep(session.MakeExecution(kWeightTime));
  ASSERT_TRUE(session.run.is_done());
  for (const simulation::PartResult& part : session.run.results()) {
    EXPECT_TRUE(part.is_seated) << part.reason;
    EXPECT_TRUE(part.has_touched);
    EXPECT_EQ(part.passage.depth, 0);
  }
}

TEST(WeightTest, PartsOfEveryDensityGoIn) {
  for (const double mass : {1e-4, 0.1, 8.7, 100.0, 68e3}) {  // [kg]; 8.7 kg weigh 85 N
    for (const Pose& X_WP : ListWaysIn()) {
      SCOPED_TRACE(::testing::Message()
                   << mass << " kg, from " << (X_WP.q() * Vec3::UnitZ()).transpose());
      ExpectInPlace(WithMass(sequence::testing::PegInBlock(X_WP), mass));
      ExpectInPlace(WithMass(PlateOnPlate(X_WP, 1), mass));
    }
  }
}

TEST(WeightTest, PartsOfEverySizeGoIn) {
  for (const double scale : {0.2, 5.0, 20.0}) {  // 0.15 g to 150 kg of steel
    for (const Pose& X_WP : ListWaysIn()) {
      SCOPED_TRACE(::testing::Message()
                   << "x " << scale << ", from " << (X_WP.q() * Vec3::UnitZ()).transpose());
      ExpectInPlace(ScaledPegInBlock(X_WP, scale));
      ExpectInPlace(PlateOnPlate(X_WP, scale));
    }
  }
}

}  // namespace
}  // namespace hvas::person
