// Springs and gaskets that a part presses together on its way to its place.

#include "simulation/pressed_pairs.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fits/elastic_parts.h"
#include "fits/pressed_parts.h"
#include "mates/elastic_parts.h"
#include "person/test/session.h"
#include "product/test/coil_mesh.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;
using ::testing::IsSubstring;

constexpr double kPistonBore = 10e-3;    // Radius [m].
constexpr double kCylinderFloor = 5e-3;  // [m]

const product::testing::Coil kCoil{2e-3, 14e-3, 5, 4e-3, 1};

/** A cylinder, a coil spring on its floor, and a piston on the spring. */
Product PistonOnSpring(const std::vector<mates::StatedElastic>& stated) {
  Product product;
  product.name = "buffer";
  const auto mesh = product::testing::MakeCoil(kCoil);
  contact::ShapeSource coil{mesh.vertices, mesh.triangles, {}, {}};
  coil.triangle_face.assign(coil.triangles.size(), 0);
  spatial::Surface surface;
  surface.kind = spatial::SurfaceKind::kFreeform;
  coil.faces.push_back(surface);
  const auto cylinder = sequence::testing::AddPart(
      &product, "cylinder", contact::testing::Cup(kPistonBore, 16e-3, kCylinderFloor, 50e-3));
  const auto spring = sequence::testing::AddPart(&product, "spring", coil);
  const auto piston = sequence::testing::AddPart(
      &product, "piston", contact::testing::Shaft(kPistonBore, 40e-3, 20e-6));
  sequence::testing::Place(&product, cylinder, "cylinder");
  sequence::testing::Place(&product, spring, "spring", Pose(Vec3(0, 0, kCylinderFloor)));
  sequence::testing::Place(&product, piston, "piston",
                           Pose(Vec3(0, 0, kCylinderFloor + mesh.length)));
  sequence::testing::Complete(&product);
  const auto set = mates::SetElasticParts(stated, &product);
  EXPECT_TRUE(set) << set.error().message;
  return product;
}

mates::StatedElastic FreeLength(const std::string& part, double length) {
  mates::StatedElastic stated;
  stated.part = part;
  stated.free_size = length;
  return stated;
}

simulation::PartResult ResultOf(const testing::Session& session, OccurrenceId id) {
  for (const simulation::PartResult& result : session.run.results()) {
    if (result.occurrence == id) {
      return result;
    }
  }
  ADD_FAILURE() << id.value() << " has no result";
  return {};
}

TEST(PressedPairs, APistonPressesTheSpringUnderItByWhatIsStated) {
  const double drawn = product::testing::MakeCoil(kCoil).length;
  const auto model =
      simulation::testing::CompileFast(PistonOnSpring({FreeLength("spring", drawn + 6e-3)}));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->presses.size(), 1U);
  const simulation::PressedPair& pair = model->presses[0];
  EXPECT_EQ(pair.moved, OccurrenceId(2));
  EXPECT_EQ(pair.parts, std::vector{OccurrenceId(1)});
  EXPECT_EQ(pair.support, OccurrenceId(0));
  EXPECT_NEAR(pair.compression, 6e-3, 1e-9);
  const double rate = fits::CalcCoilStiffness({2e-3, 14e-3, 5, 206e9 / 2.6});
  EXPECT_NEAR(pair.force, 6e-3 * rate, 0.06 * pair.force);
  EXPECT_NEAR(haptics::CalcGivingEnergy(*pair.curve, 0), 0.5 * pair.force * 6e-3,
              1e-6 * pair.force * 6e-3);

  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  ASSERT_EQ(session.run.results().size(), 3U);
  const simulation::PartResult piston = ResultOf(session, OccurrenceId(2));
  EXPECT_TRUE(piston.is_seated) << piston.reason;
  ASSERT_EQ(piston.presses.size(), 1U);
  EXPECT_NEAR(piston.fit_true, pair.force, 0.1 * pair.force);
  EXPECT_PRED_FORMAT2(IsSubstring, "presses buffer/spring together by 6.00 mm: ", piston.note);
  EXPECT_PRED_FORMAT2(IsSubstring, "G d^4 / (8 D^3 n), Wahl", piston.note);
}

TEST(PressedPairs, ASpringAsDrawnOrARigidOneIsNotPressed) {
  EXPECT_TRUE(simulation::testing::CompileFast(PistonOnSpring({}))->presses.empty());
  Product rigid = PistonOnSpring({});
  rigid.elastic.clear();
  EXPECT_TRUE(simulation::testing::CompileFast(std::move(rigid))->presses.empty());
}

/** A block, a gasket ring on it, another on that, and a lid. */
Product LidOnGaskets(double second_free) {
  Product product;
  product.name = "box";
  const auto block = sequence::testing::AddPart(
      &product, "block", contact::testing::Bushing(15e-3, 30e-3, 20e-3, 20e-6));
  const auto gasket = sequence::testing::AddPart(
      &product, "gasket", contact::testing::Bushing(18e-3, 28e-3, 2e-3, 20e-6));
  const auto lid =
      sequence::testing::AddPart(&product, "lid", contact::testing::Shaft(30e-3, 5e-3, 20e-6));
  sequence::testing::Place(&product, block, "block");
  sequence::testing::Place(&product, gasket, "gasket", Pose(Vec3(0, 0, 20e-3)));
  sequence::testing::Place(&product, gasket, "second gasket", Pose(Vec3(0, 0, 22e-3)));
  sequence::testing::Place(&product, lid, "lid", Pose(Vec3(0, 0, 24e-3)));
  sequence::testing::Complete(&product);
  const auto set = mates::SetElasticParts({FreeLength("second gasket", second_free)}, &product);
  EXPECT_TRUE(set) << set.error().message;
  return product;
}

TEST(PressedPairs, GasketsOneBehindTheOtherArePressedByOneForce) {
  const auto model = simulation::testing::CompileFast(LidOnGaskets(2.2e-3));
  ASSERT_EQ(model->presses.size(), 1U);
  const simulation::PressedPair& pair = model->presses[0];
  EXPECT_EQ(pair.moved, OccurrenceId(3));
  EXPECT_EQ(pair.parts, (std::vector{OccurrenceId(2), OccurrenceId(1)}));
  EXPECT_EQ(pair.support, OccurrenceId(0));
  EXPECT_NEAR(pair.compression, 0.2e-3, 1e-9);
  // Both together give by about 0.1 mm each.
  const auto law = mates::MakePressedPart(*FindElastic(*model->product, OccurrenceId(1)));
  ASSERT_TRUE(law);
  EXPECT_NEAR(pair.force, fits::CalcPressForce(*law, 0.1e-3), 0.25 * pair.force);
}

// The lid presses; the gaskets themselves are put on without a force.
TEST(PressedPairs, WhatIsPutOnAGasketAsDrawnMeetsNoForce) {
  EXPECT_TRUE(simulation::testing::CompileFast(LidOnGaskets(2e-3))->presses.empty());
}

// A pin of ISO 8752, drawn at its nominal 4 mm, is closed by 0.25 mm of radius, more than it bears
// elastically; friction of its radial force grows with the length in the hole.
TEST(SqueezedPairs, ASlitPinIsPushedInAgainstTheFrictionOfItsRadialForce) {
  constexpr double kDepth = 18e-3;
  Product product;
  product.name = "joint";
  const auto block = sequence::testing::AddPart(
      &product, "block", contact::testing::Cup(2e-3, 10e-3, 5e-3, 5e-3 + kDepth));
  const auto pin = sequence::testing::AddPart(&product, "roll pin",
                                              contact::testing::Bushing(1.2e-3, 2e-3, 20e-3, 5e-6));
  sequence::testing::Place(&product, block, "block");
  sequence::testing::Place(&product, pin, "roll pin", Pose(Vec3(0, 0, 5e-3)));
  ASSERT_TRUE(mates::SetElasticParts({}, &product));
  sequence::testing::Complete(&product);
  ASSERT_EQ(product.elastic.size(), 1U);
  const auto model = simulation::testing::CompileFast(std::move(product));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->presses.size(), 1U);
  const simulation::PressedPair& pair = model->presses[0];
  EXPECT_TRUE(pair.is_radial);
  EXPECT_EQ(pair.moved, OccurrenceId(1));
  EXPECT_EQ(pair.support, OccurrenceId(0));
  const double radial = fits::CalcSlitPinForce({4.5e-3, 0.8e-3, kDepth, 206e9, 1.4e9}, 0.25e-3);
  EXPECT_NEAR(pair.force, pair.curve->friction * radial, 0.05 * pair.force);
  // Half way in, half of it.
  const haptics::GivingLoad half = haptics::CalcGivingLoad(*pair.curve, 0.5 * kDepth);
  EXPECT_NEAR(half.in, 0.5 * pair.curve->friction * radial, 0.05 * half.in);
  // It stays where it is left: friction holds more than it is pushed out by.
  EXPECT_GT(half.out, 5 * half.spring);

  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  const simulation::PartResult result = ResultOf(session, OccurrenceId(1));
  EXPECT_TRUE(result.is_seated) << result.reason;
  EXPECT_NEAR(result.fit_true, pair.force, 0.1 * pair.force);
  EXPECT_PRED_FORMAT2(IsSubstring, "joint/roll pin is squeezed by ", result.note);
}

// With nothing in it, the sleeve goes into its hole as a ring; the shaft that comes last squeezes
// its wall.
TEST(SqueezedPairs, ASleeveOfRubberIsSqueezedByTheShaftThatComesLast) {
  constexpr double kLength = 20e-3;
  Product product;
  product.name = "mount";
  const auto eye = sequence::testing::AddPart(
      &product, "eye", contact::testing::Cup(9e-3, 15e-3, 5e-3, 5e-3 + kLength));
  const auto sleeve = sequence::testing::AddPart(
      &product, "rubber bushing", contact::testing::Bushing(5e-3, 9e-3, kLength, 10e-6));
  const auto bolt =
      sequence::testing::AddPart(&product, "axle", contact::testing::Shaft(5e-3, 40e-3, 10e-6));
  sequence::testing::Place(&product, eye, "eye");
  sequence::testing::Place(&product, sleeve, "rubber bushing", Pose(Vec3(0, 0, 5e-3)));
  sequence::testing::Place(&product, bolt, "axle", Pose(Vec3(0, 0, 5e-3)));
  const auto set = mates::SetElasticParts({FreeLength("rubber bushing", 19e-3)}, &product);
  ASSERT_TRUE(set) << set.error().message;
  sequence::testing::Complete(&product);
  const auto model = simulation::testing::CompileFast(std::move(product));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->presses.size(), 2U);
  const simulation::PressedPair& ring = model->presses[0];
  const simulation::PressedPair& wall = model->presses[1];
  const fits::RubberSleeve law{5e-3, 9.5e-3, kLength, 5e6};
  EXPECT_NEAR(ring.compression, 0.5e-3, 1e-6);
  EXPECT_NEAR(ring.curve->stiffness, fits::CalcSleeveHoopStiffness(law),
              0.01 * ring.curve->stiffness);
  EXPECT_EQ(wall.moved, OccurrenceId(2));
  EXPECT_NEAR(wall.compression, 0.5e-3, 1e-6);
  EXPECT_NEAR(wall.curve->stiffness, fits::CalcSleeveStiffness(law), 0.01 * wall.curve->stiffness);
  EXPECT_GT(wall.force, 3 * ring.force);
  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  for (const std::uint32_t id : {1U, 2U}) {
    const simulation::PartResult result = ResultOf(session, OccurrenceId(id));
    EXPECT_TRUE(result.is_seated) << result.reason;
    ASSERT_EQ(result.presses.size(), 1U);
    EXPECT_NEAR(result.fit_true, result.presses[0].force, 0.15 * result.presses[0].force) << id;
  }
}

}  // namespace
}  // namespace hvas::person
