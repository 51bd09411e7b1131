#include "orders/state_statics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "fits/friction.h"
#include "sequence/fit_of_mate.h"
#include "sequence/sequence.h"
#include "simulation/test/small_models.h"

namespace hvas::orders {
namespace {

using product::FitKind;
using product::OccurrenceId;
using sequence::testing::AddPart;
using sequence::testing::Complete;
using sequence::testing::Place;
using Ids = std::vector<OccurrenceId>;
using product::PartId;
using product::Product;
using spatial::Pose;

constexpr double kNear = 1e-3;  // Relative distance from a closed form on both sides.

std::shared_ptr<const simulation::Model> CompileProduct(Product product) {
  Diagnostics diagnostics;
  auto model = simulation::Compile(std::make_shared<Product>(std::move(product)),
                                   simulation::testing::FastOptions(), &diagnostics);
  EXPECT_TRUE(model) << (model ? "" : model.error().ToString());
  return *model;
}

StateStability DecideState(const simulation::Model& model, const std::vector<bool>& is_in_place,
                           const Vec3& gravity_W = -Vec3::UnitZ(), bool are_screws_tight = true) {
  StateStaticsOptions options;
  options.ghat_W = gravity_W.normalized();
  options.are_screws_tight = are_screws_tight;
  auto found = CalcStability(model, is_in_place, options);
  EXPECT_TRUE(found) << (found ? "" : found.error().ToString());
  return *found;
}

StateStability Decide(const simulation::Model& model, const Vec3& gravity_W = -Vec3::UnitZ(),
                      bool are_screws_tight = true) {
  return DecideState(model, std::vector<bool>(model.bodies.size(), true), gravity_W,
                     are_screws_tight);
}

/** Gravity that is inclined from -z towards +x. */
Vec3 Inclined(double angle) {
  return Vec3(std::sin(angle), 0, -std::cos(angle));
}

OccurrenceId BaseOf(const simulation::Model& model) {
  return sequence::FindBase(model.sequence);
}

Product WithFit(Product product, FitKind kind, const std::string& code) {
  for (product::Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kAxisHole) {
      mate.fit = product::Fit{kind, code, 2 * mate.hole_radius, false, "for the test"};
    }
  }
  return product;
}

TEST(StateStatics, PegStandsInItsHoleAndFallsOutOfItUpsideDown) {
  const auto model =
      CompileProduct(WithFit(sequence::testing::PegInBlock(), FitKind::kClearance, "H7/g6"));
  ASSERT_EQ(BaseOf(*model), OccurrenceId(0));
  EXPECT_TRUE(Decide(*model).stands);
  const StateStability over = Decide(*model, Vec3::UnitZ());
  EXPECT_FALSE(over.stands);
  EXPECT_EQ(over.moving, Ids({OccurrenceId(1)}));
  EXPECT_EQ(over.holds, Ids({OccurrenceId(1)}));
  EXPECT_TRUE(over.is_least_proven);
}

TEST(StateStatics, PegInAHorizontalHoleSlidesOutBeyondTheAngleOfFriction) {
  const auto model =
      CompileProduct(WithFit(sequence::testing::PegInBlock(), FitKind::kClearance, "H7/g6"));
  EXPECT_TRUE(Decide(*model, Vec3::UnitX()).stands);
  const double friction =
      fits::FindFriction(fits::FrictionSurface::kSteel, fits::FrictionSurface::kSteel, {})
          .static_coefficient;
  const double limit = std::atan(friction);
  // The mouth is up: gravity has to point upwards for the peg to slide out.
  const auto towards_mouth = [](double angle) { return Vec3(std::cos(angle), 0, std::sin(angle)); };
  EXPECT_TRUE(Decide(*model, towards_mouth(limit * (1 - kNear))).stands);
  EXPECT_FALSE(Decide(*model, towards_mouth(limit * (1 + kNear))).stands);
}

TEST(StateStatics, PressFitHoldsThePegUpsideDown) {
  for (const auto& [kind, code] :
       {std::pair(FitKind::kInterference, "H7/s6"), std::pair(FitKind::kThread, ""),
        std::pair(FitKind::kInsert, "")}) {
    const auto model = CompileProduct(WithFit(sequence::testing::PegInBlock(), kind, code));
    EXPECT_TRUE(Decide(*model, Vec3::UnitZ()).stands) << static_cast<int>(kind);
    EXPECT_TRUE(Decide(*model).stands) << static_cast<int>(kind);
  }
}

TEST(StateStatics, CoinAndLidNeedAHoldEachUpsideDown) {
  const auto model = CompileProduct(sequence::testing::CoinUnderLid());
  ASSERT_EQ(BaseOf(*model), OccurrenceId(0));
  EXPECT_TRUE(Decide(*model).stands);
  const StateStability over = Decide(*model, Vec3::UnitZ());
  EXPECT_EQ(over.moving, Ids({OccurrenceId(1), OccurrenceId(2)}));
  EXPECT_EQ(over.holds.size(), 2U);
  EXPECT_EQ(over.least, 2);
  EXPECT_TRUE(over.is_least_proven);
}

TEST(StateStatics, PendantAndPegAboveTheFloorFall) {
  const auto pendant = CompileProduct(sequence::testing::PendantUnderLid());
  EXPECT_EQ(Decide(*pendant).moving, Ids({OccurrenceId(2)}));
  EXPECT_EQ(Decide(*pendant).holds, Ids({OccurrenceId(2)}));
  // The peg is 2 mm above the floor, in a hole with clearance.
  const StateStability peg = Decide(*simulation::testing::PegInCarrierInCupModel());
  EXPECT_EQ(peg.moving, Ids({OccurrenceId(2)}));
}

TEST(StateStatics, WithoutWhatCarriesThemPartsFall) {
  const auto model = CompileProduct(sequence::testing::CoinUnderLid());
  const StateStability found = DecideState(*model, {false, true, true});
  EXPECT_EQ(found.moving, Ids({OccurrenceId(1), OccurrenceId(2)}));
  EXPECT_TRUE(DecideState(*model, {true, true, false}).stands);
  EXPECT_TRUE(DecideState(*model, {true, false, false}).stands);
  EXPECT_TRUE(DecideState(*model, {false, false, false}).stands);
}

/** A large block, and a smaller one on it whose centre is beyond its edge by `outside` [m]. */
Product Overhang(double outside) {
  Product product;
  product.name = "overhang";
  const PartId table = AddPart(&product, "table", contact::testing::Block(Vec3(0.1, 0.1, 0.02)));
  const PartId block = AddPart(&product, "block", contact::testing::Block(Vec3(0.03, 0.02, 0.01)));
  Place(&product, table, "table");
  Place(&product, block, "block", Pose(Vec3(0.1 + outside, 0, 0.03)));
  Complete(&product);
  return product;
}

TEST(StateStatics, BlockTipsWhenItsCentreIsBeyondTheEdge) {
  EXPECT_TRUE(Decide(*CompileProduct(Overhang(-0.2e-3))).stands);
  const StateStability beyond = Decide(*CompileProduct(Overhang(0.2e-3)));
  EXPECT_EQ(beyond.moving, Ids({OccurrenceId(1)}));
}

TEST(StateStatics, BlockSlidesBeyondTheAngleOfFriction) {
  const auto model = CompileProduct(Overhang(-0.06));
  const double limit = std::atan(0.15);  // Steel on steel.
  EXPECT_TRUE(Decide(*model, Inclined(limit * (1 - kNear))).stands);
  EXPECT_FALSE(Decide(*model, Inclined(limit * (1 + kNear))).stands);
}

TEST(StateStatics, StatedFrictionOfAPairCounts) {
  Product product = Overhang(-0.06);
  product.contact_pairs.push_back({OccurrenceId(1), OccurrenceId(0), std::nullopt, 0.4});
  const auto model = CompileProduct(std::move(product));
  EXPECT_TRUE(Decide(*model, Inclined(std::atan(0.4) * (1 - kNear))).stands);
  EXPECT_FALSE(Decide(*model, Inclined(std::atan(0.4) * (1 + kNear))).stands);
}

/** Equal blocks on one another, the lowest one higher so that it is the base, each beyond the one
 * below by the same length [m]. */
Product Stairs(int count, double step) {
  Product product;
  product.name = "stairs";
  const PartId block = AddPart(&product, "block", contact::testing::Block(Vec3(0.05, 0.04, 0.01)));
  const PartId lowest = AddPart(&product, "base", contact::testing::Block(Vec3(0.05, 0.04, 0.03)));
  Place(&product, lowest, "base", Pose(Vec3(0, 0, -0.02)));
  for (int i = 1; i < count; ++i) {
    Place(&product, block, "block" + std::to_string(i), Pose(Vec3(step * i, 0, 0.02 * i)));
  }
  Complete(&product);
  return product;
}

TEST(StateStatics, StairsOfEqualBlocksStandUpToTheClosedForm) {
  // The n blocks above the lowest, which is held, have their centre n / 2 + 1 / 2 steps beside it.
  constexpr int kCount = 4;
  const double limit = 0.05 / (0.5 * (kCount - 1) + 0.5);
  const auto standing = CompileProduct(Stairs(kCount, limit * 0.98));
  ASSERT_EQ(BaseOf(*standing), OccurrenceId(0));
  EXPECT_TRUE(Decide(*standing).stands);
  EXPECT_FALSE(Decide(*CompileProduct(Stairs(kCount, limit * 1.02))).stands);
  // All edges above one another: contacts at edges have the normals of faces.
  EXPECT_TRUE(Decide(*CompileProduct(Stairs(kCount, 0))).stands);
}

/** A base with a threaded bore, a plate on it with a passage, and a screw whose head lies on the
 plate; the centre of the plate is beside the screw. */
Product ScrewedPlate() {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  constexpr double kShank = 5e-3;
  constexpr double kHead = 8e-3;
  Product product;
  product.name = "screwed";
  const PartId base = AddPart(&product, "base", contact::testing::Cup(kShank, 20e-3, 5e-3, 25e-3));
  const PartId plate =
      AddPart(&product, "plate", contact::testing::Bushing(5.5e-3, 15e-3, 4e-3, 20e-6));
  const PartId screw =
      AddPart(&product, "screw",
              contact::testing::Lathe({{{{0, 0}, {kShank, 0}}, PlaneAt(0, -1)},
                                       {{{kShank, 0}, {kShank, 20e-3}}, CylinderZ(kShank, 1)},
                                       {{{kShank, 20e-3}, {kHead, 20e-3}}, PlaneAt(20e-3, -1)},
                                       {{{kHead, 20e-3}, {kHead, 25e-3}}, CylinderZ(kHead, 1)},
                                       {{{kHead, 25e-3}, {0, 25e-3}}, PlaneAt(25e-3, 1)}},
                                      contact::testing::Segments(kHead, 20e-6)));
  Place(&product, base, "base");
  Place(&product, plate, "plate", Pose(Vec3(0, 0, 25e-3)));
  Place(&product, screw, "screw", Pose(Vec3(0, 0, 9e-3)));
  Complete(&product);
  for (product::Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kAxisHole) {
      const bool is_in_base = mate.a.occurrence == OccurrenceId(0);
      mate.fit = product::Fit{is_in_base ? FitKind::kThread : FitKind::kPassage, "",
                              2 * mate.hole_radius, false, "for the test"};
    }
  }
  // As a lever would have it.
  product.parts[plate.index()].mass.p_BoBcm_B.x() = 12e-3;
  return product;
}

TEST(StateStatics, TightScrewClampsWhatIsUnderItsHead) {
  const auto model = CompileProduct(ScrewedPlate());
  for (const Vec3& gravity_W : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
    EXPECT_TRUE(Decide(*model, gravity_W).stands) << gravity_W.transpose();
  }
  // Loose, it hangs on the screw, and swings down where its axis is horizontal.
  EXPECT_TRUE(Decide(*model, Vec3::UnitZ(), false).stands);
  EXPECT_FALSE(Decide(*model, Vec3::UnitY(), false).stands);
  // Without the screw it falls off when it is turned over.
  EXPECT_EQ(DecideState(*model, {true, true, false}, Vec3::UnitZ()).moving, Ids({OccurrenceId(1)}));
}

TEST(StateStatics, OneObjectDecidesOnAllStates) {
  const auto model = CompileProduct(sequence::testing::CollarUnderClamp());
  const StateStatics statics(*model);
  for (unsigned state = 0; state < 8; ++state) {
    const std::vector<bool> is_in_place{(state & 1U) != 0, (state & 2U) != 0, (state & 4U) != 0};
    const auto once = CalcStability(*model, is_in_place);
    const auto again = statics.CalcStability(is_in_place);
    ASSERT_TRUE(once && again);
    EXPECT_EQ(once->stands, again->stands);
    EXPECT_EQ(once->moving, again->moving);
    EXPECT_EQ(once->holds, again->holds);
  }
}

TEST(StateStatics, RefusesAStateOfOtherParts) {
  const auto& model = simulation::testing::PegInBlockModel();
  EXPECT_EQ(CalcStability(*model, {true}).error().code, ErrorCode::kInvalid);
  StateStaticsOptions options;
  options.ghat_W = Vec3(0, 0, -9.81);
  EXPECT_EQ(CalcStability(*model, {true, true}, options).error().code, ErrorCode::kInvalid);
}

TEST(StandingMargin, OfABlockIsThatOfItsFace) {
  // Halves 0.1, 0.1, 0.02: on its large face it tips from atan(0.1 / 0.02) on.
  const auto model = CompileProduct(Overhang(-0.05));
  EXPECT_NEAR(CalcStandingMargin(*model, OccurrenceId(0), -Vec3::UnitZ()), std::atan(5.0), 1e-6);
  EXPECT_NEAR(CalcStandingMargin(*model, OccurrenceId(0), -Vec3::UnitX()), std::atan(0.2), 1e-6);
}

TEST(StandingMargin, OfATurnedPartIsThatOfItsFace) {
  const Pose X_WP(spatial::RotationFromVector(Vec3(0.4, 0.3, 0)), Vec3(0.1, 0, 0));
  const auto model = CompileProduct(sequence::testing::PegInBlock(X_WP));
  const double margin = CalcStandingMargin(*model, OccurrenceId(0), Vec3(-X_WP.R().col(2)));
  // A round block of radius 15 mm; its centre, by its bore, is a little below the middle.
  const double height = std::tan(std::numbers::pi / 2 - margin) * 15e-3;
  EXPECT_NEAR(height, model->bodies[0].mass.p_BoBcm_B.z(), 0.1e-3);
  EXPECT_LE(CalcStandingMargin(*model, OccurrenceId(0), -Vec3::UnitZ()), 1e-6) << "on its edge";
}

}  // namespace
}  // namespace hvas::orders
