// Parts that have to turn on their way in.

#include "sequence/turning_way.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "paths/test/pairs.h"
#include "person/test/session.h"
#include "sequence/screw_mates.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using paths::testing::CellSolid;
using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;

/** A key whose bit lies across the slot of a plate, below it: it has to turn by a quarter. */
Product KeyInPlate() {
  Product product;
  product.name = "lock";
  CellSolid plate({std::vector{-20e-3, -6e-3, -2.2e-3, 2.2e-3, 6e-3, 20e-3},
                   {-20e-3, -2.2e-3, -1.8e-3, 1.8e-3, 2.2e-3, 20e-3},
                   {0, 4e-3}});
  plate.Set(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  plate.Set(Vec3(-6e-3, -1.8e-3, -1), Vec3(6e-3, 1.8e-3, 1), false);
  plate.Set(Vec3(-2.2e-3, -2.2e-3, -1), Vec3(2.2e-3, 2.2e-3, 1), false);
  CellSolid key({std::vector{-4e-3, -1e-3, 1e-3, 4e-3},
                 {-5e-3, -4e-3, -1e-3, 1e-3, 4e-3, 5e-3},
                 {-2.3e-3, -0.3e-3, 12e-3, 16e-3}});
  key.Set(Vec3(-1e-3, -1, -1), Vec3(1e-3, 1, -0.3e-3));     // Bit.
  key.Set(Vec3(-1e-3, -1e-3, -1), Vec3(1e-3, 1e-3, 1));     // Shaft.
  key.Set(Vec3(-4e-3, -4e-3, 12e-3), Vec3(4e-3, 4e-3, 1));  // Handle.
  sequence::testing::Place(
      &product,
      sequence::testing::AddPart(&product, "plate", sequence::testing::SortByFace(plate.Make())),
      "plate");
  sequence::testing::Place(
      &product,
      sequence::testing::AddPart(&product, "key", sequence::testing::SortByFace(key.Make())),
      "key");
  sequence::testing::Complete(&product);
  return product;
}

TEST(TurningWayTest, AKeyIsTurnedBeforeItComesOutAndThePersonPutsItIn) {
  Diagnostics diagnostics;
  const auto compiled =
      simulation::Compile(std::make_shared<Product>(KeyInPlate()), {}, &diagnostics);
  ASSERT_TRUE(compiled.has_value());
  const auto& model = *compiled;
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  const sequence::SequenceStep* step = sequence::FindInsertion(model->sequence, OccurrenceId(1));
  ASSERT_NE(step, nullptr);
  ASSERT_GE(step->way.size(), 2U);
  const Pose& in = step->way.front();
  const Pose& out = step->way.back();
  EXPECT_LT((in.p() - model->bodies[1].X_WB_goal.p()).norm(), 1e-12);
  EXPECT_NEAR(spatial::RotationBetween(in.q(), out.q()).norm(), 0.5 * std::numbers::pi, 0.3);
  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  const simulation::PartResult key = session.run.results().back();
  EXPECT_TRUE(key.is_seated) << key.reason;
  EXPECT_LT(key.passage.depth, 0.2e-3);
}

/** A bolt without a mate, and a nut on it: freeform faces in both. */
Product NutOnBolt(double gap) {
  constexpr double kMinor = 6.2e-3, kMajor = 8e-3, kPitch = 2e-3;  // [m]
  Product product;
  product.name = "screwed";
  sequence::testing::Place(
      &product,
      sequence::testing::AddPart(&product, "bolt",
                                 paths::testing::MakeThread(kMinor, kMajor, kPitch, 0, 7e-3, 0)),
      "bolt");
  sequence::testing::Place(
      &product,
      sequence::testing::AddPart(
          &product, "nut",
          paths::testing::MakeThread(kMinor + gap, kMajor + gap, kPitch, 2e-3, 5e-3, 12e-3)),
      "nut");
  sequence::testing::Complete(&product);
  return product;
}

TEST(ScrewMatesTest, PartsThatComeApartAlongAScrewAreAThreadedJointAndGoIn) {
  Diagnostics diagnostics;
  const auto product = std::make_shared<Product>(NutOnBolt(0.2e-3));
  ASSERT_TRUE(product->mates.empty());
  const auto compiled = simulation::Compile(product, {}, &diagnostics);
  ASSERT_TRUE(compiled.has_value());
  const auto& model = *compiled;
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->product->mates.size(), 1U);
  const product::Mate& mate = model->product->mates[0];
  ASSERT_TRUE(mate.fit.has_value());
  EXPECT_EQ(mate.fit->kind, product::FitKind::kThread);
  EXPECT_EQ(model->product->occurrences[mate.a.occurrence.index()].name, "nut");
  EXPECT_GT(mate.shaft_radius, mate.hole_radius);
  const product::Feature& hole =
      model->product->part_of(mate.a.occurrence).features[mate.a.feature.index()];
  EXPECT_NEAR(hole.thread_pitch, 2e-3, 0.03e-3);
  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  const simulation::PartResult& last = session.run.results().back();
  EXPECT_TRUE(last.is_seated) << last.reason;
  EXPECT_LT(last.passage.depth, 0.2e-3);
}

TEST(ScrewMatesTest, AMateThatTheUserHasRemovedIsNotMadeAgain) {
  Product product = NutOnBolt(0.2e-3);
  sequence::ScrewPair pair;
  pair.hole = OccurrenceId(1);
  pair.shaft = OccurrenceId(0);
  pair.axis.pitch = 2e-3;
  pair.turn = 8;
  pair.core_radius = 6.4e-3;
  pair.outer_radius = 8e-3;
  pair.hole_faces = {product::FaceId(0)};
  pair.shaft_faces = {product::FaceId(0)};
  const auto with = sequence::AddScrewMates(product, {pair});
  ASSERT_NE(with, nullptr);
  ASSERT_EQ(with->mates.size(), 1U);
  EXPECT_EQ(sequence::AddScrewMates(*with, {pair})->parts[1].features.size(),
            with->parts[1].features.size())
      << "one feature, however often it is found";
  product.removed_mates = {with->mates[0].key};
  EXPECT_EQ(sequence::AddScrewMates(product, {pair}), nullptr);
}

TEST(ScrewMatesTest, ATurnThatDoesNotLeadOutIsNoScrew) {
  paths::FreeScrew screw;
  screw.axis.pitch = 0;
  screw.turn = 1;
  for (int k = 0; k < 40; ++k) {
    paths::NearPoint flank;
    const double angle = 0.5 * k;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    flank.p_W = 5e-3 * out + Vec3(0, 0, 0.1e-3 * k);
    flank.nhat_W = out;
    flank.body = contact::BodyId(1);
    flank.is_of_part = k % 2 == 0;
    flank.face = 0;
    screw.flanks.push_back(flank);
  }
  EXPECT_FALSE(sequence::FindScrewPair(OccurrenceId(0), screw).has_value()) << "a bayonet";
  screw.axis.pitch = 25e-3;
  const auto pair = sequence::FindScrewPair(OccurrenceId(0), screw);
  EXPECT_FALSE(pair.has_value()) << "no play between core and outer radius";
  for (std::size_t k = 0; k < screw.flanks.size(); k += 4) {
    screw.flanks[k].p_W.head<2>() *= 0.8;
  }
  const auto deep = sequence::FindScrewPair(OccurrenceId(0), screw);
  ASSERT_TRUE(deep.has_value());
  EXPECT_EQ(deep->hole, OccurrenceId(0)) << "what pushes it outwards is a shaft in it";
  EXPECT_NEAR(deep->core_radius, 4e-3, 1e-9);
  EXPECT_NEAR(deep->outer_radius, 5e-3, 1e-9);
}

TEST(TurningWayTest, TheLastPieceLeadsPastAllOthers) {
  const spatial::Box box_B{Vec3(-1e-3, -1e-3, -1e-3), Vec3(1e-3, 1e-3, 1e-3)};
  const paths::Path path{Pose(), Pose(Vec3(0, 0, 5e-3))};
  const spatial::Box above{Vec3(-5e-3, -5e-3, 20e-3), Vec3(5e-3, 5e-3, 30e-3)};
  const auto step = sequence::MakeTurningStep(OccurrenceId(1), path, box_B, std::array{above});
  ASSERT_TRUE(step);
  const Vec3 last = step->way.back().p() - step->way[step->way.size() - 2].p();
  EXPECT_LT((last - Vec3(0, 0, -10e-3)).norm(), 1e-12);
  EXPECT_NEAR(step->extraction_W.z(), 1, 1e-6);
  // Walls on all sides leave no way to go on.
  const spatial::Box below{Vec3(-1, -1, -30e-3), Vec3(1, 1, -20e-3)};
  const spatial::Box over{Vec3(-1, -1, 20e-3), Vec3(1, 1, 30e-3)};
  const spatial::Box left{Vec3(-30e-3, -1, -1), Vec3(-20e-3, 1, 1)};
  const spatial::Box right{Vec3(20e-3, -1, -1), Vec3(30e-3, 1, 1)};
  const spatial::Box front{Vec3(-1, -30e-3, -1), Vec3(1, -20e-3, 1)};
  const spatial::Box back{Vec3(-1, 20e-3, -1), Vec3(1, 30e-3, 1)};
  EXPECT_FALSE(sequence::MakeTurningStep(OccurrenceId(1), path, box_B,
                                         std::array{below, over, left, right, front, back}));
}

TEST(TurningWayTest, TheGripGoesWithItsPart) {
  const Vec3 p_BG(2e-3, 0, 1e-3);
  const spatial::Box box_B{Vec3(-1e-3, -1e-3, -1e-3), Vec3(1e-3, 1e-3, 1e-3)};
  const Quat half(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  const sequence::GripWay way =
      sequence::MakeGripWay({Pose(), Pose(half, Vec3(0, 0, 5e-3))}, p_BG, box_B);
  EXPECT_LT((way.At(0).p() - p_BG).norm(), 1e-12);
  EXPECT_LT((way.At(way.length()).p() - (half * p_BG + Vec3(0, 0, 5e-3))).norm(), 1e-12);
}

}  // namespace
}  // namespace hvas::person
