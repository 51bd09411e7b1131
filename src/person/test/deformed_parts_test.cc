// The parts of products that are drawn deformed while others are on their way.

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "mates/elastic_parts.h"
#include "person/test/session.h"
#include "product/test/coil_mesh.h"
#include "simulation/deformation.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;

constexpr double kBufferFloor = 5e-3;  // [m]
const product::testing::Coil kBufferCoil{2e-3, 14e-3, 5, 4e-3, 1};

std::shared_ptr<const simulation::Model> CompileDeformed(Product product) {
  Diagnostics diagnostics;
  auto model = simulation::Compile(std::make_shared<Product>(std::move(product)),
                                   simulation::testing::FastOptions(), &diagnostics);
  EXPECT_TRUE(model) << model.error().message;
  for (const sequence::SequenceGap& gap : (*model)->sequence.gaps) {
    ADD_FAILURE() << gap.reason;
  }
  return *model;
}

std::vector<Pose> PosesInPlace(const simulation::Model& model) {
  std::vector<Pose> poses;
  for (const simulation::Body& body : model.bodies) {
    poses.push_back(body.X_WB_goal);
  }
  return poses;
}

/** Amounts with one part so far on its way out, and all others in their place. */
std::vector<double> AmountsAt(const simulation::Model& model, OccurrenceId id, double travel,
                              const Vec3& aside_W = Vec3::Zero()) {
  std::vector<Pose> poses = PosesInPlace(model);
  const sequence::SequenceStep* step = sequence::FindInsertion(model.sequence, id);
  Pose& X_WB = poses[id.index()];
  X_WB = Pose(X_WB.q(), X_WB.p() + travel * step->extraction_W + aside_W);
  return simulation::CalcDeformations(*model.product, model.deformables, poses);
}

/** A cylinder, a coil spring in it, and a piston on the spring. */
Product PistonOnLongSpring(double longer) {
  Product product;
  product.name = "buffer";
  const auto mesh = product::testing::MakeCoil(kBufferCoil);
  contact::ShapeSource coil{mesh.vertices, mesh.triangles, {}, {}};
  coil.triangle_face.assign(coil.triangles.size(), 0);
  spatial::Surface surface;
  surface.kind = spatial::SurfaceKind::kFreeform;
  coil.faces.push_back(surface);
  const auto cylinder = sequence::testing::AddPart(
      &product, "cylinder", contact::testing::Cup(10e-3, 16e-3, kBufferFloor, 50e-3));
  const auto spring = sequence::testing::AddPart(&product, "spring", coil);
  const auto piston =
      sequence::testing::AddPart(&product, "piston", contact::testing::Shaft(10e-3, 40e-3, 20e-6));
  sequence::testing::Place(&product, cylinder, "cylinder");
  sequence::testing::Place(&product, spring, "spring", Pose(Vec3(0, 0, kBufferFloor)));
  sequence::testing::Place(&product, piston, "piston",
                           Pose(Vec3(0, 0, kBufferFloor + mesh.length)));
  sequence::testing::Complete(&product);
  mates::StatedElastic stated;
  stated.part = "spring";
  stated.free_size = mesh.length + longer;
  const auto set = mates::SetElasticParts({stated}, &product);
  EXPECT_TRUE(set) << set.error().message;
  return product;
}

/** A block, two equal gaskets on it, each 2 mm thick as drawn, and a lid. */
Product LidOnThickGaskets(double free_thickness) {
  Product product;
  product.name = "box";
  const auto block = sequence::testing::AddPart(
      &product, "block", contact::testing::Bushing(15e-3, 30e-3, 20e-3, 20e-6));
  const auto gasket = sequence::testing::AddPart(
      &product, "gasket", contact::testing::Bushing(18e-3, 28e-3, 2e-3, 20e-6));
  const auto lid =
      sequence::testing::AddPart(&product, "lid", contact::testing::Shaft(30e-3, 5e-3, 20e-6));
  sequence::testing::Place(&product, block, "block");
  sequence::testing::Place(&product, gasket, "first gasket", Pose(Vec3(0, 0, 20e-3)));
  sequence::testing::Place(&product, gasket, "second gasket", Pose(Vec3(0, 0, 22e-3)));
  sequence::testing::Place(&product, lid, "lid", Pose(Vec3(0, 0, 24e-3)));
  sequence::testing::Complete(&product);
  std::vector<mates::StatedElastic> stated(2);
  stated[0].part = "first gasket";
  stated[1].part = "second gasket";
  stated[0].free_size = stated[1].free_size = free_thickness;
  const auto set = mates::SetElasticParts(stated, &product);
  EXPECT_TRUE(set) << set.error().message;
  return product;
}

double TopOf(const simulation::Model& model, const simulation::Deformable& part, double amount) {
  double top = -1;
  for (const Vec3& vertex : model.product->part_of(part.occurrence).mesh.vertices) {
    top = std::max(top, simulation::Deform(part.form, amount, vertex).z());
  }
  return top;
}

TEST(DeformedParts, ASpringIsDrawnLongerUntilItIsPressed) {
  const auto model = CompileDeformed(PistonOnLongSpring(6e-3));
  ASSERT_EQ(model->deformables.size(), 1U);
  const simulation::Deformable& spring = model->deformables[0];
  EXPECT_EQ(spring.occurrence, OccurrenceId(1));
  EXPECT_EQ(spring.form.kind, simulation::DeformationKind::kPress);
  const OccurrenceId piston(2);
  const double length = product::testing::MakeCoil(kBufferCoil).length;
  // Free, half way, in its place, and with the piston beside its way.
  EXPECT_NEAR(AmountsAt(*model, piston, 20e-3)[0], 6e-3, 1e-9);
  EXPECT_NEAR(AmountsAt(*model, piston, 2e-3)[0], 2e-3, 1e-9);
  EXPECT_EQ(AmountsAt(*model, piston, 0)[0], 0);
  EXPECT_NEAR(AmountsAt(*model, piston, 2e-3, Vec3(0.1, 0, 0))[0], 6e-3, 1e-9);
  EXPECT_NEAR(TopOf(*model, spring, 2e-3), length + 2e-3, 1e-9);
  // What holds it stays: its lower end.
  const Vec3 foot(7e-3, 0, 0);
  EXPECT_LT((simulation::Deform(spring.form, 6e-3, foot) - foot).norm(), 1e-9);
  // The whole product moved somewhere else is the same.
  std::vector<Pose> poses = PosesInPlace(*model);
  const Pose away(spatial::RotationTaking(Vec3::UnitX(), Vec3::UnitY()), Vec3(1, 2, 3));
  for (Pose& X_WB : poses) {
    X_WB = away * X_WB;
  }
  EXPECT_EQ(simulation::CalcDeformations(*model->product, model->deformables, poses)[0], 0);
  // A piston that is not there presses nothing.
  const std::vector<bool> present{true, true, false};
  EXPECT_NEAR(simulation::CalcDeformations(*model->product, model->deformables,
                                           PosesInPlace(*model), &present)[0],
              6e-3, 1e-9);
}

TEST(DeformedParts, TheUpperOneOfTwoGasketsLiesOnTheLowerOne) {
  const auto model = CompileDeformed(LidOnThickGaskets(2.2e-3));
  ASSERT_EQ(model->deformables.size(), 3U);
  const OccurrenceId lid(3);
  // Equal ones are pressed by as much as one another; the upper one comes down by what the lower
  // one gets thinner.
  for (const double travel : {0.1, 0.2e-3, 0.0}) {
    const auto amounts = AmountsAt(*model, lid, travel);
    for (std::size_t i = 0; i < 3; ++i) {
      const simulation::Deformable& part = model->deformables[i];
      EXPECT_EQ(part.occurrence, OccurrenceId(part.form.kind == simulation::DeformationKind::kShift
                                                  ? 2
                                                  : 1 + (i > 0 ? 1U : 0U)));
      EXPECT_NEAR(amounts[i], 0.5 * std::min(travel, 0.4e-3), 1e-8) << i << " " << travel;
    }
  }
  // On its way down the upper one rests on the lower one 0.2 mm before its place.
  std::vector<Pose> poses = PosesInPlace(*model);
  poses[lid.index()] = Pose(Vec3(0, 0, 1));
  for (const double before : {0.05e-3, 0.3e-3}) {
    poses[2] = Pose(Vec3(0, 0, 22e-3 + before));
    const auto amounts = simulation::CalcDeformations(*model->product, model->deformables, poses);
    for (std::size_t i = 0; i < 3; ++i) {
      if (model->deformables[i].form.kind == simulation::DeformationKind::kShift) {
        EXPECT_NEAR(amounts[i], std::max(0.0, 0.2e-3 - before), 1e-9);
      }
    }
  }
}

TEST(DeformedParts, ACapAroundABeadOpensAllAroundByWhatTheTwoOverlap) {
  const auto model = CompileDeformed(sequence::testing::CapOnBead(11.6e-3));
  ASSERT_EQ(model->deformables.size(), 1U);
  const simulation::Deformable& cap = model->deformables[0];
  EXPECT_EQ(cap.form.kind, simulation::DeformationKind::kFlare);
  EXPECT_EQ(cap.form.shares[0], 1);
  EXPECT_EQ(AmountsAt(*model, OccurrenceId(1), 0.1)[0], 0);
  double most = 0;
  for (int i = 0; i < 500; ++i) {
    const double travel = 20e-6 * i;
    most = std::max(most, AmountsAt(*model, OccurrenceId(1), travel)[0]);
  }
  EXPECT_NEAR(most, model->sequence.gives[0].width, 0.05 * most);
  // Every point of its rim goes outwards by about as much, and its top stays.
  for (const Vec3& vertex : model->product->part_of(cap.occurrence).mesh.vertices) {
    const Vec3 moved = simulation::Deform(cap.form, most, vertex) - vertex;
    EXPECT_LT(moved.norm(), 1.3 * most);
    EXPECT_GE(moved.head<2>().dot(vertex.head<2>()), -1e-12);
  }
}

/** A plate in a frame, and a lid over it on two arms whose hooks grip 1 mm under it. */
Product LidOnTwoHooks() {
  Product product;
  product.name = "box";
  const auto plate = sequence::testing::AddPart(&product, "plate",
                                                contact::testing::Block(Vec3(10e-3, 30e-3, 4e-3)));
  const auto frame = sequence::testing::AddPart(
      &product, "frame",
      contact::testing::Frame(Vec3(20e-3, 50e-3, 10e-3), Eigen::Vector2d(10.5e-3, 35e-3)));
  const auto lid = sequence::testing::AddPart(&product, "lid",
                                              contact::testing::Prism({{-33.4e-3, -3e-3},
                                                                       {-30.4e-3, -3e-3},
                                                                       {-29e-3, -0.8e-3},
                                                                       {-29e-3, -0.2e-3},
                                                                       {-30.4e-3, -0.2e-3},
                                                                       {-30.4e-3, 20e-3},
                                                                       {30.4e-3, 20e-3},
                                                                       {30.4e-3, -0.2e-3},
                                                                       {29e-3, -0.2e-3},
                                                                       {29e-3, -0.8e-3},
                                                                       {30.4e-3, -3e-3},
                                                                       {33.4e-3, -3e-3},
                                                                       {33.4e-3, 23e-3},
                                                                       {-33.4e-3, 23e-3}},
                                                                      6e-3));
  sequence::testing::Place(&product, plate, "plate", Pose(Vec3(0, 0, 4e-3)));
  sequence::testing::Place(&product, lid, "lid");
  sequence::testing::Place(&product, frame, "frame", Pose(Vec3(0, 0, 4e-3)));
  sequence::testing::Complete(&product);
  return product;
}

TEST(DeformedParts, BothArmsOfALidBendOutwardsAndTheLidStays) {
  const auto model = CompileDeformed(LidOnTwoHooks());
  ASSERT_EQ(model->sequence.gives.size(), 1U);
  const double width = model->sequence.gives[0].width;
  ASSERT_EQ(model->deformables.size(), 2U);
  double most = 0;
  double at = 0;
  for (int i = 0; i < 500; ++i) {
    const double travel = 20e-6 * i;
    const auto amounts = AmountsAt(*model, OccurrenceId(1), travel);
    EXPECT_EQ(amounts[0], amounts[1]);
    at = amounts[0] > most ? travel : at;
    most = std::max(most, amounts[0]);
  }
  EXPECT_NEAR(most, width, 0.05 * width);
  EXPECT_EQ(AmountsAt(*model, OccurrenceId(1), 0)[0], 0);
  for (const Vec3& vertex : model->product->part_of(OccurrenceId(1)).mesh.vertices) {
    Vec3 p = vertex;
    for (const simulation::Deformable& arm : model->deformables) {
      p = simulation::Deform(arm.form, most, p);
    }
    const Vec3 moved = p - vertex;
    EXPECT_NEAR(moved.x(), 0, 1e-12);
    EXPECT_NEAR(moved.z(), 0, 1e-12);
    if (vertex.z() > 20e-3 - 1e-9) {
      EXPECT_LT(moved.norm(), 1e-3 * most);  // The lid, down to the roots of the arms.
    } else {
      EXPECT_GT(moved.y() * vertex.y(), 0);
      EXPECT_NEAR(moved.norm(), most, 0.35 * most);  // The hooks, at the ends of the arms.
    }
  }
}

// Drawn at its nominal 4 mm, a pin of ISO 8752 is free 0.25 mm wider in radius; its hole has 4 mm.
TEST(DeformedParts, ASlitPinIsDrawnAsWideAsItIsFreeUntilItsHoleClosesIt) {
  constexpr double kDepth = 12e-3;
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
  const auto model = CompileDeformed(std::move(product));
  ASSERT_EQ(model->deformables.size(), 1U);
  const simulation::Deformable& part = model->deformables[0];
  const auto radius = [&](double travel) {
    const double amount = AmountsAt(*model, OccurrenceId(1), travel)[0];
    return simulation::Deform(part.form, amount, Vec3(2e-3, 0, 1e-3)).head<2>().norm();
  };
  // The mesh is 5 um off the circle.
  EXPECT_NEAR(radius(30e-3), 2.25e-3, 6e-6);
  EXPECT_NEAR(radius(0.5 * kDepth), 2.125e-3, 10e-6);
  EXPECT_NEAR(radius(0), 2e-3, 6e-6);
}

// Its hole makes a sleeve narrower all through; the shaft that comes last widens its bore again.
TEST(DeformedParts, ASleeveIsNarrowedByItsHoleAndItsWallIsSqueezedByTheShaft) {
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
  mates::StatedElastic stated;
  stated.part = "rubber bushing";
  stated.free_size = 19e-3;
  ASSERT_TRUE(mates::SetElasticParts({stated}, &product));
  sequence::testing::Complete(&product);
  const auto model = CompileDeformed(std::move(product));
  const OccurrenceId id(1);
  const auto radii = [&](const std::vector<double>& amounts) {
    const auto map = MakePointMap(model->deformables, amounts, id);
    const auto radius = [&](double r) {
      const Vec3 p(0, r, 3e-3);
      return (map ? map(p) : p).head<2>().norm();
    };
    return std::array{radius(5e-3), radius(9e-3)};
  };
  std::vector<bool> without_bolt{true, true, false};
  std::vector<Pose> poses = PosesInPlace(*model);
  const auto in_hole = radii(
      simulation::CalcDeformations(*model->product, model->deformables, poses, &without_bolt));
  EXPECT_NEAR(in_hole[0], 4.5e-3, 20e-6);
  EXPECT_NEAR(in_hole[1], 9e-3, 20e-6);
  const auto in_place =
      radii(simulation::CalcDeformations(*model->product, model->deformables, poses));
  EXPECT_NEAR(in_place[0], 5e-3, 20e-6);
  EXPECT_NEAR(in_place[1], 9e-3, 20e-6);
  poses[id.index()] = Pose(Vec3(1, 0, 0));
  const auto free = radii(simulation::CalcDeformations(*model->product, model->deformables, poses));
  EXPECT_NEAR(free[0], 5e-3, 20e-6);
  EXPECT_NEAR(free[1], 9.5e-3, 20e-6);
}

}  // namespace
}  // namespace hvas::person
