#include "dynamics/world.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/digest.h"
#include "base/random.h"

namespace hvas::dynamics {
namespace {

constexpr double kDensity = 7850;  // Steel [kg/m3].
constexpr double kGravity = 9.81;

struct Solid {
  std::vector<Vec3> vertices;
  MassProperties properties;
};

// Box of the given size with Bo at its centre.
Solid MakeBox(const Vec3& size) {
  Solid solid;
  for (int i = 0; i < 8; ++i) {
    solid.vertices.emplace_back(((i & 1) != 0 ? 0.5 : -0.5) * size.x(),
                                ((i & 2) != 0 ? 0.5 : -0.5) * size.y(),
                                ((i & 4) != 0 ? 0.5 : -0.5) * size.z());
  }
  solid.properties.mass = kDensity * size.prod();
  const Vec3 squares = size.cwiseAbs2();
  solid.properties.I_BBcm_B =
      (solid.properties.mass / 12 *
       Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
          .asDiagonal();
  return solid;
}

// Cylinder along z with Bo at the centre of its lower end.
Solid MakeCylinder(double radius, double height) {
  Solid solid;
  for (int i = 0; i < 96; ++i) {
    const double angle = 2 * std::numbers::pi * i / 96;
    solid.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    solid.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  const double mass = kDensity * std::numbers::pi * radius * radius * height;
  const double across = mass * (3 * radius * radius + height * height) / 12;
  solid.properties = {mass, {0, 0, height / 2}, Mat3::Zero()};
  solid.properties.I_BBcm_B.diagonal() = Vec3(across, across, mass * radius * radius / 2);
  return solid;
}

BodyId Add(World* world, const Solid& solid, const spatial::Pose& X_WB) {
  const Result<BodyId> body = world->AddBody(solid.vertices, solid.properties, X_WB);
  EXPECT_TRUE(body.has_value());
  return *body;
}

spatial::Pose At(double x, double y, double z) {
  return spatial::Pose(Vec3(x, y, z));
}

// Height of a body's lowest vertex.
double Lowest(const World& world, BodyId body, const Solid& solid) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& p_B : solid.vertices) {
    lowest = std::min(lowest, (world.pose(body) * p_B).z());
  }
  return lowest;
}

// Parts of all shapes dropped over one another; the same for the same seed.
std::vector<Solid> MakeHeap(World* world, std::vector<BodyId>* ids, std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Solid> solids;
  for (int i = 0; i < count; ++i) {
    const double a = random.Uniform(0.005, 0.06);
    const double b = random.Uniform(0.005, 0.06);
    solids.push_back(i % 2 == 0 ? MakeBox({a, b, random.Uniform(0.005, 0.06)})
                                : MakeCylinder(0.5 * a, b));
    const Quat q = Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal());
    const int row = i / 4 % 3;
    const int layer = i / 12;
    const Vec3 p(0.07 * (i % 4), 0.07 * row, 0.06 + 0.1 * layer);
    ids->push_back(Add(world, solids.back(), spatial::Pose(q.normalized(), p)));
  }
  return solids;
}

std::string DigestOf(const World& world, const std::vector<BodyId>& ids) {
  Digest digest;
  for (const BodyId id : ids) {
    const spatial::Pose& X_WB = world.pose(id);
    for (const double value : {X_WB.p().x(), X_WB.p().y(), X_WB.p().z(), X_WB.q().w(), X_WB.q().x(),
                               X_WB.q().y(), X_WB.q().z()}) {
      digest.AddDouble(value);
    }
  }
  return digest.Hex();
}

double FreeFallError(double substep) {
  WorldOptions options;
  options.max_substep = substep;
  World world(options);
  const BodyId body = Add(&world, MakeBox({0.02, 0.02, 0.02}), At(0, 0, 1));
  for (int i = 0; i < 40; ++i) {
    world.Step(0.01);
  }
  return 1 - 0.5 * kGravity * 0.4 * 0.4 - world.pose(body).p().z();
}

// Bullet's integrator is of first order: it falls too far by g h t / 2 for substeps h.
TEST(World, FallsAsGalileoSaysToTheOrderOfTheIntegrator) {
  const double h = 1.0 / 500;
  EXPECT_NEAR(FreeFallError(h), 0.5 * kGravity * h * 0.4, 1e-9);
  EXPECT_NEAR(FreeFallError(h) / FreeFallError(h / 2), 2, 1e-6);
}

TEST(World, CutsAStepIntoEqualSubsteps) {
  // 100 Hz with substeps of at most 1/240 s are three of 1/300 s.
  EXPECT_NEAR(FreeFallError(1.0 / 240), 0.5 * kGravity / 300 * 0.4, 1e-9);
}

class RestingBox : public ::testing::TestWithParam<double> {};

// Sizes of 1 mm to 1 m rest on the table's surface, not in or over it.
TEST_P(RestingBox, LiesWithinATenthOfAMillimetreOfTheTableAndSleeps) {
  const double size = GetParam();
  WorldOptions options;
  options.table_z = 0.7;
  World world(options);
  const Solid box = MakeBox({size, 0.8 * size, 0.5 * size});
  const BodyId body = Add(&world, box, At(0.3, -0.2, 0.7 + 0.25 * size + 0.005));
  ASSERT_TRUE(world.Settle(3));
  EXPECT_TRUE(world.is_asleep(body));
  EXPECT_NEAR(Lowest(world, body, box), 0.7, 1e-4);
  EXPECT_LT(std::hypot(world.pose(body).p().x() - 0.3, world.pose(body).p().y() + 0.2), 1e-4);
  EXPECT_LT(spatial::RotationVector(world.pose(body).q()).norm(), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Sizes, RestingBox, ::testing::Values(0.001, 0.003, 0.01, 0.04, 0.2, 1.0));

TEST(World, NeverGainsEnergy) {
  World world({});
  std::vector<BodyId> ids;
  MakeHeap(&world, &ids, 3, 12);
  double energy = world.CalcEnergy();
  const double start = energy;
  double gained = 0;
  for (int i = 0; i < 300; ++i) {
    world.Step(0.01);
    gained = std::max(gained, world.CalcEnergy() - energy);
    energy = std::min(energy, world.CalcEnergy());
  }
  EXPECT_LT(energy, 0.5 * start) << "it did fall";
  // Pushing bodies out of one another lifts them a little.
  EXPECT_LT(gained, 1e-3 * start);
}

// A block that slides at v stops after v^2 / (2 mu g) and v / (mu g).
TEST(World, PushedCylinderSlidesAndStopsByFriction) {
  World world({});
  const Solid cylinder = MakeCylinder(0.02, 0.015);
  const BodyId body = Add(&world, cylinder, At(0, 0, 0));
  ASSERT_TRUE(world.Settle(3));
  const Vec3 start = world.pose(body).p();
  const double speed = 0.4;
  const Vec3 p_WBcm = world.pose(body) * cylinder.properties.p_BoBcm_B;
  world.ApplyImpulse(body, cylinder.properties.mass * speed * Vec3::UnitX(), p_WBcm);
  EXPECT_NEAR(world.CalcVelocity(body).v.x(), speed, 1e-9);
  EXPECT_FALSE(world.is_asleep(body));
  ASSERT_TRUE(world.Settle(3));
  const Vec3 way = world.pose(body).p() - start;
  const double expected = speed * speed / (2 * 0.3 * kGravity);
  EXPECT_NEAR(way.x(), expected, 0.1 * expected);
  EXPECT_LT(std::abs(way.y()), 0.05 * expected);
  EXPECT_LT(std::abs(way.z()), 1e-4);
}

TEST(World, RollingCylinderComesToRest) {
  World world({});
  const Solid cylinder = MakeCylinder(0.01, 0.04);
  const BodyId body = Add(&world, cylinder,
                          {spatial::RotationTaking(Vec3::UnitZ(), Vec3::UnitY()), {0, 0, 0.0101}});
  ASSERT_TRUE(world.Settle(5));
  world.ApplyImpulse(body, {cylinder.properties.mass * 0.1, 0, 0}, {0, 0.02, 0.01});
  EXPECT_TRUE(world.Settle(10));
}

// A free turning body keeps its angular momentum; here about a principal axis, so its rate, too.
TEST(World, KeepsTurningInFreeFall) {
  WorldOptions options;
  options.gravity = 0;
  World world(options);
  const Solid box = MakeBox({0.02, 0.04, 0.08});
  const BodyId body = Add(&world, box, At(0, 0, 1));
  const double impulse = 1e-3;
  world.ApplyImpulse(body, {impulse, 0, 0}, {0, 0.01, 1});
  const double rate = -impulse * 0.01 / box.properties.I_BBcm_B(2, 2);
  EXPECT_NEAR(world.CalcVelocity(body).w.z(), rate, 1e-9);
  for (int i = 0; i < 20; ++i) {
    world.Step(0.01);
  }
  EXPECT_NEAR(spatial::RotationVector(world.pose(body).q()).z(), rate * 0.2, 1e-3 * std::abs(rate));
  EXPECT_NEAR(world.pose(body).p().x(), impulse / box.properties.mass * 0.2, 1e-9);
}

// The centre of mass away from Bo, principal axes turned against B: it must balance as its twin
// described in a plain frame does.
TEST(World, DoesNotDependOnTheBodyFrame) {
  const Solid plain = MakeBox({0.01, 0.03, 0.06});
  const spatial::Pose X_BA(spatial::RotationFromVector({0.4, -0.7, 1.1}), Vec3(0.05, -0.02, 0.03));
  Solid turned;
  for (const Vec3& p_A : plain.vertices) {
    turned.vertices.push_back(X_BA * p_A);
  }
  turned.properties.mass = plain.properties.mass;
  turned.properties.p_BoBcm_B = X_BA.p();
  turned.properties.I_BBcm_B = X_BA.R() * plain.properties.I_BBcm_B * X_BA.R().transpose();
  const spatial::Pose X_WA(spatial::RotationFromVector({0.3, 0.2, 0}), Vec3(0, 0, 0.2));

  World plain_world({});
  World turned_world({});
  const BodyId a = Add(&plain_world, plain, X_WA);
  const BodyId b = Add(&turned_world, turned, X_WA * X_BA.Inverse());
  for (int i = 0; i < 15; ++i) {
    plain_world.Step(0.01);
    turned_world.Step(0.01);
  }
  EXPECT_LT((plain_world.pose(a).p() - turned_world.pose(b) * X_BA.p()).norm(), 1e-9);
  ASSERT_TRUE(plain_world.Settle(5));
  ASSERT_TRUE(turned_world.Settle(5));
  EXPECT_NEAR(Lowest(turned_world, b, turned), 0, 1e-4);
  EXPECT_NEAR(Lowest(plain_world, a, plain), 0, 1e-4);
}

TEST(World, KinematicBodyHoldsStillCarriesAndPushes) {
  World world({});
  const Solid plate = MakeBox({0.1, 0.1, 0.01});
  const Solid block = MakeBox({0.02, 0.02, 0.02});
  const BodyId shelf = Add(&world, plate, At(0, 0, 0.2));
  world.SetKinematic(shelf, true);
  const BodyId upper = Add(&world, block, At(0, 0, 0.2 + 0.005 + 0.01 + 0.002));
  const BodyId lower = Add(&world, block, At(0.2, 0, 0.01));
  ASSERT_TRUE(world.Settle(3));
  EXPECT_EQ(world.pose(shelf).p(), Vec3(0, 0, 0.2)) << "nothing moves it";
  EXPECT_NEAR(Lowest(world, upper, block), 0.205, 1e-4);
  // It sweeps sideways along the table and takes the lower block along.
  world.SetPose(shelf, At(0.1, 0, 0.015));
  for (int i = 1; i <= 50; ++i) {
    world.MoveTo(shelf, At(0.1 + 0.002 * i, 0, 0.015));
    world.Step(0.01);
  }
  EXPECT_EQ(world.pose(shelf).p(), Vec3(0.1 + 0.002 * 50, 0, 0.015));
  EXPECT_GT(world.pose(lower).p().x(), 0.2 + 0.05 + 0.01 - 1e-3);
  EXPECT_NEAR(world.pose(lower).p().z(), 0.01, 5e-4) << "it is pushed along, not up";
  // The upper one lost its support and fell.
  ASSERT_TRUE(world.Settle(3));
  EXPECT_NEAR(Lowest(world, upper, block), 0, 1e-4);
}

TEST(World, SleeperWakesWhenItsSupportIsTakenAway) {
  for (const bool is_removed : {true, false}) {
    World world({});
    const Solid block = MakeBox({0.03, 0.03, 0.03});
    const BodyId lower = Add(&world, block, At(0, 0, 0.015));
    const BodyId upper = Add(&world, block, At(0, 0, 0.046));
    ASSERT_TRUE(world.Settle(3));
    EXPECT_NEAR(Lowest(world, upper, block), 0.03, 2e-4);
    if (is_removed) {
      world.Remove(lower);
      EXPECT_EQ(world.size(), 1u);
    } else {
      world.SetPose(lower, At(0.3, 0, 0.015));
    }
    EXPECT_FALSE(world.is_asleep(upper));
    ASSERT_TRUE(world.Settle(3));
    EXPECT_NEAR(Lowest(world, upper, block), 0, 1e-4);
  }
}

TEST(World, DroppedBodyFallsAndAHeldOneDoesNot) {
  World world({});
  const Solid block = MakeBox({0.02, 0.03, 0.04});
  const BodyId body = Add(&world, block, At(0, 0, 0.02));
  ASSERT_TRUE(world.Settle(3));
  world.SetKinematic(body, true);
  const spatial::Pose held(spatial::RotationFromVector({0.1, 0.2, 0.3}), Vec3(0.01, 0.02, 0.1));
  world.SetPose(body, held);
  world.Step(0.5);
  EXPECT_EQ(world.pose(body).p(), held.p());
  EXPECT_EQ(world.pose(body).q().coeffs(), held.q().coeffs());
  world.SetKinematic(body, false);
  ASSERT_TRUE(world.Settle(5));
  EXPECT_NEAR(Lowest(world, body, block), 0, 1e-4);
}

// What sleeps keeps its pose to the bit, also while others move and when a kinematic body was put
// on it; a part dropped on it finds it.
TEST(World, SleeperKeepsItsPoseAndIsStillThere) {
  World world({});
  const Solid block = MakeBox({0.03, 0.03, 0.03});
  const BodyId sleeper = Add(&world, block, At(0, 0, 0.016));
  const BodyId far_kinematic = Add(&world, block, At(1, 0, 0.1));
  world.SetKinematic(far_kinematic, true);
  ASSERT_TRUE(world.Settle(3));
  const spatial::Pose pose = world.pose(sleeper);
  world.SetPose(far_kinematic, At(0.5, 0, 0.1));
  const BodyId on_far = Add(&world, block, At(0.5, 0, 0.14));
  ASSERT_TRUE(world.Settle(3));
  EXPECT_EQ(world.pose(sleeper).p(), pose.p());
  EXPECT_EQ(world.pose(sleeper).q().coeffs(), pose.q().coeffs());
  EXPECT_NEAR(Lowest(world, on_far, block), 0.115, 2e-4) << "it lies where the other was put";
  const BodyId on_sleeper = Add(&world, block, At(0, 0, 0.06));
  ASSERT_TRUE(world.Settle(3));
  EXPECT_NEAR(Lowest(world, on_sleeper, block), 0.03, 2e-4);
}

TEST(World, EqualCallsGiveEqualBits) {
  std::string first;
  for (int run = 0; run < 2; ++run) {
    World world({});
    std::vector<BodyId> ids;
    MakeHeap(&world, &ids, 7, 20);
    for (int i = 0; i < 150; ++i) {
      world.Step(0.01);
    }
    const std::string digest = DigestOf(world, ids);
    if (run == 0) {
      first = digest;
    }
    EXPECT_EQ(digest, first);
    world.Step(0.01);
    EXPECT_NE(DigestOf(world, ids), first) << "the digest sees motion";
  }
}

// Settles a world and prints what it took: simulated time, and time on this machine.
bool SettleAndPrint(World* world, const char* what, double max_time) {
  const auto start = std::chrono::steady_clock::now();
  double time = 0;
  while (time < max_time && !world->Settle(0.1)) {
    time += 0.1;
  }
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  std::cout << what << ": " << taken.count() << " ms for " << time << " s\n";
  return time < max_time;
}

TEST(World, ThirtyPartsLaidOutComeToRestSoon) {
  World world({});
  std::vector<BodyId> ids;
  std::vector<Solid> solids;
  for (int i = 0; i < 30; ++i) {
    const int row = i / 6;
    const double size = 0.004 + 0.002 * i;
    solids.push_back(i % 2 == 0 ? MakeBox({size, size / 2, size / 3})
                                : MakeCylinder(size / 4, size));
    const spatial::Pose X_WB(spatial::RotationFromVector({0.1 * i, 0.05 * i, 0}),
                             Vec3(0.12 * (i % 6), 0.12 * row, 0.08));
    ids.push_back(Add(&world, solids.back(), X_WB));
  }
  EXPECT_TRUE(SettleAndPrint(&world, "30 parts apart", 5));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_NEAR(Lowest(world, ids[i], solids[i]), 0, 2e-4) << i;
  }
}

TEST(World, ThirtyPartsInAHeapComeToRest) {
  World world({});
  std::vector<BodyId> ids;
  const std::vector<Solid> solids = MakeHeap(&world, &ids, 9, 30);
  EXPECT_TRUE(SettleAndPrint(&world, "30 parts in a heap", 20));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_GT(Lowest(world, ids[i], solids[i]), -3e-4) << i;
    EXPECT_LT(Lowest(world, ids[i], solids[i]), 0.1) << i;
  }
}

TEST(World, RefusesWhatHasNoMassOrShape) {
  World world({});
  const Solid box = MakeBox({0.01, 0.01, 0.01});
  const auto code = [&world](const std::vector<Vec3>& vertices, const MassProperties& properties,
                             const spatial::Pose& X_WB) {
    const Result<BodyId> body = world.AddBody(vertices, properties, X_WB);
    return body.has_value() ? ErrorCode::kInternal : body.error().code;
  };
  MassProperties massless = box.properties;
  massless.mass = 0;
  MassProperties flat = box.properties;
  flat.I_BBcm_B(1, 1) = 0;
  EXPECT_EQ(code({}, box.properties, {}), ErrorCode::kInvalid);
  EXPECT_EQ(code(box.vertices, massless, {}), ErrorCode::kInvalid);
  EXPECT_EQ(code(box.vertices, flat, {}), ErrorCode::kInvalid);
  EXPECT_EQ(code(box.vertices, box.properties, At(0, 0, std::nan(""))), ErrorCode::kInvalid);
  EXPECT_EQ(world.size(), 0u);
}

}  // namespace
}  // namespace hvas::dynamics
