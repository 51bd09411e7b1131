// Keys of form A and other tongues with round ends in their slots. X2.

#include <numbers>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"
#include "product/features.h"
#include "product/test/round_face.h"

namespace hvas::mates {
namespace {

using product::MateKind;
using product::Part;
using product::Product;
using spatial::Pose;

/** Two round ends of a slot (outward -1) or tongue (1), along x, 10 mm high. */
void AddEnds(Product* product, const std::string& name, double half_length, double radius,
             double outward) {
  Part* part = testing::AddPart(product, name);
  constexpr double kHalf = std::numbers::pi;
  product::testing::AddRoundFace(part, half_length, radius, outward, -0.5 * kHalf, kHalf, 0, 10e-3);
  product::testing::AddRoundFace(part, -half_length, radius, outward, 0.5 * kHalf, kHalf, 0, 10e-3);
  product::BuildFeatures(part);
}

Product InferPair(double slot_half_length, double key_half_length, const Pose& X_SlotKey = Pose()) {
  Product product;
  AddEnds(&product, "shaft", slot_half_length, 4e-3, -1);
  AddEnds(&product, "key", key_half_length, 4e-3, 1);
  testing::AddOccurrence(&product, product::PartId(0), Pose());
  testing::AddOccurrence(&product, product::PartId(1), X_SlotKey);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(RoundEndsTest, AKeyIsHeldByBothEndsOfItsSeat) {
  const Product product = InferPair(12e-3, 12e-3);
  ASSERT_EQ(product.mates.size(), 2U);
  for (const product::Mate& mate : product.mates) {
    EXPECT_EQ(mate.kind, MateKind::kAxisHole);
    EXPECT_EQ(mate.a.occurrence, product::OccurrenceId(0));
    ASSERT_TRUE(mate.fit.has_value());
    EXPECT_EQ(mate.fit->kind, product::FitKind::kClearance);
    EXPECT_EQ(mate.fit->code, "H7/g6");
  }
}

TEST(RoundEndsTest, AShorterBlockIsHeldByTheEndThatItLiesIn) {
  EXPECT_TRUE(InferPair(12e-3, 10e-3).mates.empty()) << "in the middle";
  EXPECT_EQ(InferPair(12e-3, 10e-3, Pose(Vec3(2e-3, 0, 0))).mates.size(), 1U) << "at one end";
}

TEST(RoundEndsTest, ARoundEndHoldsNoShaftThatGoesAround) {
  Product product;
  AddEnds(&product, "slot", 12e-3, 4e-3, -1);
  Part* pin = testing::AddPart(&product, "pin");
  product::testing::AddRoundFace(pin, 12e-3, 4e-3, 1, 0, 2 * std::numbers::pi, 0, 10e-3);
  product::BuildFeatures(pin);
  testing::AddOccurrence(&product, product::PartId(0), Pose());
  testing::AddOccurrence(&product, product::PartId(1), Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_TRUE(product.mates.empty());
}

}  // namespace
}  // namespace hvas::mates
