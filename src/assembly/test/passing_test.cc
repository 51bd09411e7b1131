// Parts that are moved aside within the product, to let another one pass, and back.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "orders/order_search.h"
#include "paths/test/pairs.h"
#include "person/simulated_person.h"
#include "person/test/session.h"
#include "sequence/step_check.h"
#include "simulation/disassembly_run.h"
#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using Kind = sequence::SequenceStep::Kind;
using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;

/** A box along the axes [mm]. */
struct Box {
  Vec3 low_mm;
  Vec3 high_mm;
};

/** A solid of boxes, without others. */
contact::ShapeSource MakeSolid(const std::vector<Box>& full, const std::vector<Box>& empty = {}) {
  constexpr double kMm = 1e-3;
  std::array<std::vector<double>, 3> steps;
  for (std::size_t k = 0; k < 3; ++k) {
    std::set<double> planes;
    for (const std::vector<Box>* boxes : {&full, &empty}) {
      for (const Box& box : *boxes) {
        planes.insert(kMm * box.low_mm[static_cast<Eigen::Index>(k)]);
        planes.insert(kMm * box.high_mm[static_cast<Eigen::Index>(k)]);
      }
    }
    steps[k].assign(planes.begin(), planes.end());
  }
  paths::testing::CellSolid solid(steps);
  for (const Box& box : full) {
    solid.Set(kMm * box.low_mm, kMm * box.high_mm);
  }
  for (const Box& box : empty) {
    solid.Set(kMm * box.low_mm, kMm * box.high_mm, false);
  }
  return sequence::testing::SortByFace(solid.Make());
}

void PlaceSolid(Product* product, const std::string& name, const Pose& X_WP,
                const contact::ShapeSource& source) {
  sequence::testing::Place(product, sequence::testing::AddPart(product, name, source), name, X_WP);
}

/** A bolt of T section in a slot that is open at one end, and a plate in a pocket across the slot,
 with a window for the bolt's tip: the bolt does not pass the window, and the tip keeps the plate.
 */
Product Latch(const Pose& X_WP) {
  Product product;
  product.name = "latch";
  PlaceSolid(&product, "housing", X_WP,
             MakeSolid({{{-10, -20, -10}, {100, 20, 30}}}, {{{0, -8, 5}, {100, 8, 12}},
                                                            {{0, -4, 12}, {100, 4, 30}},
                                                            {{80, -14, -5}, {85, 14, 30}}}));
  PlaceSolid(&product, "bolt", X_WP,
             MakeSolid({{{30, -7.9, 5.1}, {75, 7.9, 11.9}},
                        {{30, -3.9, 11.9}, {75, 3.9, 18}},
                        {{75, -3, 6}, {92, 3, 11}}}));
  PlaceSolid(
      &product, "plate", X_WP,
      MakeSolid({{{80.1, -13.9, -5}, {84.9, 13.9, 36}}}, {{{79, -3.1, 5.9}, {86, 3.1, 11.1}}}));
  sequence::testing::Complete(&product);
  return product;
}

/** A drawer, and a stop that hangs through the ceiling of its cabinet behind the drawer's front: a
 tongue of the drawer holds the stop until the drawer is opened a little, and the stop holds the
 drawer. */
Product Drawer(const Pose& X_WP) {
  Product product;
  product.name = "desk";
  PlaceSolid(&product, "cabinet", X_WP,
             MakeSolid({{{0, 0, 0}, {100, 60, 50}}},
                       {{{5, 5, 5}, {100, 55, 45}}, {{60, 20, 45}, {71, 40, 50}}}));
  PlaceSolid(&product, "drawer", X_WP,
             MakeSolid({{{5, 5.1, 5}, {10, 54.9, 44.8}},
                        {{10, 5.1, 5}, {90, 54.9, 8}},
                        {{10, 5.1, 8}, {90, 10, 40}},
                        {{10, 50, 8}, {90, 54.9, 40}},
                        {{90, 5.1, 5}, {105, 54.9, 44.8}},
                        {{67, 21, 15}, {90, 39, 19}}}));
  PlaceSolid(&product, "stop", X_WP,
             MakeSolid({{{60.1, 20.1, 9}, {70.9, 39.9, 55}}}, {{{65, 20, 14}, {72, 40, 20}}}));
  sequence::testing::Complete(&product);
  return product;
}

/** A cover that slides in grooves over a block whose neck stands in a keyhole of the cover. */
Product Cover(const Pose& X_WP) {
  Product product;
  product.name = "case";
  PlaceSolid(&product, "box", X_WP,
             MakeSolid({{{0, 0, 0}, {100, 50, 40}}}, {{{41.9, 13.9, 5}, {64.1, 36.1, 34}},
                                                      {{3, 3, 30}, {100, 47, 34}},
                                                      {{3, 6, 34}, {100, 44, 40}}}));
  PlaceSolid(&product, "cover", X_WP,
             MakeSolid({{{3, 3.1, 30.1}, {78, 46.9, 33.9}}},
                       {{{10, 10, 30}, {40, 40, 35}}, {{40, 20, 30}, {60, 30, 35}}}));
  PlaceSolid(&product, "block", X_WP,
             MakeSolid({{{48, 21, 6}, {58, 29, 40}},
                        {{42, 14, 6}, {64, 36, 28}},
                        {{42, 14, 36}, {64, 36, 44}}}));
  sequence::testing::Complete(&product);
  return product;
}

/** One solid of two that reach into each other. */
contact::ShapeSource Join(contact::ShapeSource solid, const contact::ShapeSource& other) {
  const auto vertices = static_cast<std::uint32_t>(solid.vertices.size());
  const auto faces = static_cast<std::uint32_t>(solid.faces.size());
  solid.vertices.insert(solid.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) {
    solid.triangles.push_back({a + vertices, b + vertices, c + vertices});
  }
  for (const std::uint32_t face : other.triangle_face) {
    solid.triangle_face.push_back(face + faces);
  }
  solid.faces.insert(solid.faces.end(), other.faces.begin(), other.faces.end());
  return solid;
}

const Vec3 kArmLow(-8e-3, -6e-3, 0.05e-3);
const Vec3 kArmHigh(42e-3, 6e-3, 6e-3);

/** Faces 0 to 3 of a bar are its sides, 4 is below, 5 above, 6 the hole. */
std::vector<spatial::Surface> MakeArmFaces(double hole_radius) {
  std::vector<spatial::Surface> faces;
  for (const Vec3& n : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(-Vec3::UnitX()),
                        Vec3(-Vec3::UnitY()), Vec3(-Vec3::UnitZ()), Vec3(Vec3::UnitZ())}) {
    const Vec3& corner = n.sum() > 0 ? kArmHigh : kArmLow;
    faces.push_back({spatial::SurfaceKind::kPlane, n.cwiseAbs().cwiseProduct(corner), n, 0, 0, 1});
  }
  faces.push_back(contact::testing::CylinderZ(hole_radius, -1));
  return faces;
}

/** Angles of the corners are among those of the points, so that each piece has one side. */
std::vector<double> ListArmAngles() {
  constexpr int kPoints = 180;
  std::vector<double> angles;
  for (int i = 0; i < kPoints; ++i) {
    angles.push_back(2 * std::numbers::pi * i / kPoints);
  }
  for (const Vec3& corner : {kArmHigh, Vec3(kArmLow.x(), kArmHigh.y(), 0), kArmLow,
                             Vec3(kArmHigh.x(), kArmLow.y(), 0)}) {
    const double angle = std::atan2(corner.y(), corner.x());
    angles.push_back(angle < 0 ? angle + 2 * std::numbers::pi : angle);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

/** Distance from the axis to the outline of the bar in a direction [m]. */
double CalcArmRadius(const Vec3& d) {
  const double to_x = d.x() == 0 ? 1 : (d.x() > 0 ? kArmHigh.x() : kArmLow.x()) / d.x();
  const double to_y = d.y() == 0 ? 1 : (d.y() > 0 ? kArmHigh.y() : kArmLow.y()) / d.y();
  return std::min(to_x, to_y);
}

std::uint32_t FindArmSide(const std::vector<spatial::Surface>& faces, const Vec3& p) {
  const auto distance = [&](std::uint32_t f) {
    return std::abs(faces[f].axis.dot(p - faces[f].origin));
  };
  std::uint32_t nearest = 0;
  for (std::uint32_t face = 1; face < 4; ++face) {
    nearest = distance(face) < distance(nearest) ? face : nearest;
  }
  return nearest;
}

/** A bar [m] along x from -8 to 42 mm, 12 mm wide, from z = 0.05 to 6 mm, with a hole about z. */
contact::ShapeSource MakeArm(double hole_radius) {
  contact::ShapeSource arm;
  arm.faces = MakeArmFaces(hole_radius);
  const std::vector<double> angles = ListArmAngles();
  const auto n = static_cast<std::uint32_t>(angles.size());
  for (const double z : {kArmLow.z(), kArmHigh.z()}) {
    for (const bool is_outline : {true, false}) {
      for (const double angle : angles) {
        const Vec3 d(std::cos(angle), std::sin(angle), 0);
        const double r = is_outline ? CalcArmRadius(d) : hole_radius;
        arm.vertices.emplace_back(r * d + z * Vec3::UnitZ());
      }
    }
  }
  std::vector<std::uint32_t> side;
  for (std::uint32_t i = 0; i < n; ++i) {
    side.push_back(FindArmSide(arm.faces, 0.5 * (arm.vertices[i] + arm.vertices[(i + 1) % n])));
  }
  const auto add_band = [&](std::uint32_t a, std::uint32_t b, std::uint32_t face, bool is_side) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      if (is_side && side[i] != face) {
        continue;
      }
      arm.triangles.push_back({a * n + i, a * n + j, b * n + j});
      arm.triangles.push_back({a * n + i, b * n + j, b * n + i});
      arm.triangle_face.insert(arm.triangle_face.end(), 2, face);
    }
  };
  for (std::uint32_t face = 0; face < 4; ++face) {
    add_band(0, 2, face, true);
  }
  add_band(1, 0, 4, false);
  add_band(2, 3, 5, false);
  add_band(3, 1, 6, false);
  return arm;
}

/** An arm on a boss, under a roof, and a keeper in a pocket with a wall beside the arm and a lip
 over it: the arm keeps the keeper in its pocket until it is turned out of it, and the wall keeps
 the arm from being turned out from under the roof. */
Product Gate(const Pose& X_WP) {
  constexpr double kBoss = 4e-3;
  Product product;
  product.name = "gate";
  contact::ShapeSource boss = contact::testing::Shaft(kBoss, 15e-3);
  for (Vec3& vertex : boss.vertices) {
    vertex.z() -= 6e-3;
  }
  boss.faces[0].origin.z() -= 6e-3;
  boss.faces[2].origin.z() -= 6e-3;
  PlaceSolid(&product, "plate", X_WP,
             Join(MakeSolid({{{-20, -25, -12}, {50, 25, 0}},
                             {{10, -3, 6.2}, {24, 25, 9}},
                             {{10, 22, 0}, {24, 25, 6.2}}},
                            {{{24.9, -8.1, -8}, {37.1, 8.1, 0}}}),
                  boss));
  PlaceSolid(&product, "arm", X_WP, MakeArm(kBoss + 0.05e-3));
  PlaceSolid(&product, "keeper", X_WP,
             MakeSolid({{{25, -8, -8}, {37, 8, -0.1}},
                        {{25, -8, -0.1}, {37, -6.2, 6.2}},
                        {{25, -8, 6.2}, {37, 3, 10}}}));
  sequence::testing::Complete(&product);
  return product;
}

std::shared_ptr<const simulation::Model> Compiled(Product product, std::uint64_t way_looks = 0) {
  Diagnostics diagnostics;
  simulation::CompileOptions options = simulation::testing::FastOptions();
  options.way_looks = way_looks;
  auto model =
      simulation::Compile(std::make_shared<Product>(std::move(product)), options, &diagnostics);
  EXPECT_TRUE(model.has_value());
  return *model;
}

const std::shared_ptr<const simulation::Model>& LatchModel() {
  static const std::shared_ptr<const simulation::Model> model = Compiled(Latch(Pose()));
  return model;
}

const std::string& NameOf(const simulation::Model& model, OccurrenceId id) {
  return model.product->occurrences[id.index()].name;
}

std::vector<Kind> KindsOf(const std::vector<sequence::SequenceStep>& steps) {
  std::vector<Kind> kinds;
  kinds.reserve(steps.size());
  for (const sequence::SequenceStep& step : steps) {
    kinds.push_back(step.kind);
  }
  return kinds;
}

const std::vector<Kind> kPassing{Kind::kBase, Kind::kInsert, Kind::kAside, Kind::kInsert,
                                 Kind::kReturn};

/** Assembles a model, and expects all parts in their places by ways that are free. @returns the
 digest of the ticks. */
std::string Assemble(const std::shared_ptr<const simulation::Model>& model, std::uint64_t seed) {
  person::testing::Session session(model, seed);
  (void)simulation::RunLockstep(session.MakeExecution(240));
  EXPECT_TRUE(session.run.is_done());
  EXPECT_EQ(session.run.results().size(), model->bodies.size());
  for (const simulation::PartResult& part : session.run.results()) {
    EXPECT_TRUE(part.is_seated) << NameOf(*model, part.occurrence) << ": " << part.reason;
    EXPECT_LT(part.passage.depth, 0.2e-3) << NameOf(*model, part.occurrence);
    EXPECT_LT(part.pose_error, 0.2e-3) << NameOf(*model, part.occurrence);
  }
  return session.watch.Hex();
}

struct Case {
  const char* name;
  Product (*make)(const Pose&);
  const char* moved;
  const char* passing;
  Vec3 turn;                   ///< The product's [rad].
  std::uint64_t way_looks{0};  ///< For the part that is moved to turn its way out.
};

class PassingTest : public ::testing::TestWithParam<Case> {};

TEST_P(PassingTest, APartIsMovedAsideAndBackAndThePersonDoesSo) {
  const Case& c = GetParam();
  const Pose X_WP(spatial::RotationFromVector(c.turn), Vec3(0.02, -0.03, 0.1));
  const auto model = Compiled(c.make(X_WP), c.way_looks);
  const std::vector<sequence::SequenceStep>& steps = model->sequence.steps;
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(KindsOf(steps), kPassing);
  EXPECT_EQ(NameOf(*model, steps[1].occurrence), c.moved);
  EXPECT_EQ(steps[2].occurrence, steps[1].occurrence);
  EXPECT_EQ(NameOf(*model, steps[3].occurrence), c.passing);
  EXPECT_EQ(steps[4].occurrence, steps[1].occurrence);
  if (steps[2].way.empty()) {
    EXPECT_NEAR(steps[2].offset_W.norm(), steps[4].engage_distance, 1e-9);
  }
  EXPECT_TRUE(sequence::CheckSteps(steps, model->bodies.size()).has_value());
  (void)Assemble(model, 1);
}

constexpr double kQuarter = 0.5 * std::numbers::pi;  // [rad]

INSTANTIATE_TEST_SUITE_P(
    Products, PassingTest,
    ::testing::Values(Case{"latch", &Latch, "bolt", "plate", {0, 0, 0}},
                      Case{"latch_turned", &Latch, "bolt", "plate", {0.4, -0.5, 0.9}},
                      Case{"drawer", &Drawer, "drawer", "stop", {0, 0, 0}},
                      Case{"drawer_on_its_back", &Drawer, "drawer", "stop", {0, -kQuarter, 0}},
                      Case{"cover", &Cover, "cover", "block", {0, 0, 0}},
                      Case{"cover_turned", &Cover, "cover", "block", {0.3, 0.2, -2.0}},
                      Case{"gate", &Gate, "arm", "keeper", {0, 0, 0}, 10'000},
                      Case{"gate_turned", &Gate, "arm", "keeper", {0.3, 0.8, 0.5}, 10'000}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(PassingRunTest, RunsWithTheSameSeedAreTheSameBitForBit) {
  EXPECT_EQ(Assemble(LatchModel(), 7), Assemble(LatchModel(), 7));
}

TEST(PassingRunTest, ThePartThatPassedSaysWhatWasMovedAsideForIt) {
  person::testing::Session session(LatchModel());
  (void)simulation::RunLockstep(session.MakeExecution(240));
  const auto& results = session.run.results();
  const auto plate =
      std::find_if(results.begin(), results.end(), [](const simulation::PartResult& part) {
        return NameOf(*LatchModel(), part.occurrence) == "plate";
      });
  ASSERT_NE(plate, results.end());
  EXPECT_EQ(plate->note.find("goes in while latch/bolt is moved aside by "), 0U) << plate->note;
}

TEST(PassingOrderTest, MovesPastAnotherPartComeOnlyAsTheyWereFound) {
  const simulation::Model& model = *LatchModel();
  const orders::OrderRules rules = orders::FindOrderRules(model, {});
  ASSERT_EQ(rules.moves.size(), 2U);
  EXPECT_FALSE(rules.moves[0].aside.has_value());
  ASSERT_TRUE(rules.moves[1].aside.has_value());
  EXPECT_TRUE(rules.moves[1].is_bound);
  const orders::OrderSearch search = orders::FindOrders(rules, {});
  ASSERT_EQ(search.orders.size(), 1U);
  const std::vector<sequence::SequenceStep> steps = orders::ListSteps(rules, search.orders[0]);
  EXPECT_EQ(KindsOf(steps), kPassing);
  EXPECT_TRUE(sequence::CheckSteps(steps, model.bodies.size()).has_value());
  EXPECT_EQ(orders::ListSteps(rules, search.planned).size(), kPassing.size());
}

TEST(PassingOrderTest, AnOrderKeepsThePartsThatPassEachOtherTogether) {
  const simulation::Model& model = *LatchModel();
  const auto same = sequence::Reorder(*model.product, model.sequence, {"bolt", "plate"});
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(KindsOf(same->steps), kPassing);
  const auto reversed = sequence::Reorder(*model.product, model.sequence, {"plate"});
  ASSERT_FALSE(reversed.has_value());
  EXPECT_EQ(reversed.error().code, ErrorCode::kInvalid);
  EXPECT_EQ(reversed.error().message,
            "'latch/plate' cannot come before 'latch/bolt', which is moved aside to let it pass");
}

TEST(PassingOrderTest, StepsInWhichNothingPassesOrReturnsAreRefused) {
  const simulation::Model& model = *LatchModel();
  for (const int missing : {1, 2, 3, 4}) {
    std::vector<sequence::SequenceStep> steps = model.sequence.steps;
    steps.erase(steps.begin() + missing);
    EXPECT_FALSE(sequence::CheckSteps(steps, model.bodies.size()).has_value()) << missing;
  }
}

TEST(PassingDisassemblyTest, X16ABoltIsSlidAsideForThePlateAndComesOutLast) {
  const auto& model = LatchModel();
  const simulation::DisassemblyPlan plan = simulation::PlanDisassembly(*model, {});
  EXPECT_TRUE(plan.stuck.empty());
  std::vector<Kind> kinds;
  std::vector<std::string> names;
  for (const simulation::Removal& removal : plan.removals) {
    kinds.push_back(removal.step.kind);
    names.push_back(NameOf(*model, removal.step.occurrence));
  }
  EXPECT_EQ(kinds, (std::vector<Kind>{Kind::kAside, Kind::kRemove, Kind::kReturn, Kind::kRemove}));
  EXPECT_EQ(names, (std::vector<std::string>{"bolt", "plate", "bolt", "bolt"}));
  simulation::Simulation simulation(model, haptics::TickOptions());
  simulation::PutAllInPlace(&simulation);
  person::SimulatedPerson person({}, 1, simulation::StartOfHand(*model));
  simulation::DisassemblyRun run(&simulation, &plan, &person, nullptr);
  (void)simulation::RunLockstep(run.MakeExecution(&person, 240));
  ASSERT_TRUE(run.is_done());
  for (const simulation::PartResult& part : run.results()) {
    EXPECT_TRUE(part.reason.empty()) << NameOf(*model, part.occurrence) << ": " << part.reason;
    EXPECT_FALSE(part.is_seated);
  }
}

}  // namespace
}  // namespace hvas::assembly
