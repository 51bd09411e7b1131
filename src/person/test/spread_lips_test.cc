// Lips of seals that a shaft spreads on its way.

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fits/elastic_parts.h"
#include "mates/elastic_parts.h"
#include "person/test/session.h"
#include "simulation/deformation.h"
#include "simulation/pressed_pairs.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using contact::testing::CylinderZ;
using contact::testing::Lathe;
using contact::testing::PlaneAt;
using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;
using ::testing::IsSubstring;

constexpr double kShaftRadius = 10e-3;  // [m]
constexpr double kChamfer = 1.5e-3;     // [m] along the axis, half of it across.
constexpr double kSealSeat = 14e-3;     // [m]: where the seal stands.
constexpr int kTurn = 200;              // Segments of a turn.

spatial::Surface ConeThrough(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double outward) {
  spatial::Surface cone;
  cone.kind = spatial::SurfaceKind::kCone;
  const double rise = (b.x() - a.x()) / (b.y() - a.y());
  cone.origin = Vec3(0, 0, a.y() - a.x() / rise);
  cone.axis = Vec3(0, 0, rise > 0 ? 1 : -1);
  cone.second = std::atan(std::abs(rise));
  cone.outward = outward;
  return cone;
}

/** A blind hole for the shaft, and above it the seat of the seal. */
contact::ShapeSource Housing() {
  return Lathe({{{{0, 0}, {25e-3, 0}}, PlaneAt(0, -1)},
                {{{25e-3, 0}, {25e-3, 30e-3}}, CylinderZ(25e-3, 1)},
                {{{25e-3, 30e-3}, {17.52e-3, 30e-3}}, PlaneAt(30e-3, 1)},
                {{{17.52e-3, 30e-3}, {17.52e-3, kSealSeat}}, CylinderZ(17.52e-3, -1)},
                {{{17.52e-3, kSealSeat}, {10.02e-3, kSealSeat}}, PlaneAt(kSealSeat, 1)},
                {{{10.02e-3, kSealSeat}, {10.02e-3, 4e-3}}, CylinderZ(10.02e-3, -1)},
                {{{10.02e-3, 4e-3}, {0, 4e-3}}, PlaneAt(4e-3, 1)}},
               kTurn);
}

/** A casing, its floor and a lip that stands on it; the edge of the lip at `edge` [m]. */
contact::ShapeSource Seal(double edge) {
  const Eigen::Vector2d foot{13.2e-3, 1.2e-3};
  const Eigen::Vector2d head{edge + 1.2e-3, 6e-3};
  const Eigen::Vector2d tip{edge, 5e-3};
  const Eigen::Vector2d root{12e-3, 0};
  return Lathe({{{root, {17.5e-3, 0}}, PlaneAt(0, -1)},
                {{{17.5e-3, 0}, {17.5e-3, 8e-3}}, CylinderZ(17.5e-3, 1)},
                {{{17.5e-3, 8e-3}, {16.5e-3, 8e-3}}, PlaneAt(8e-3, 1)},
                {{{16.5e-3, 8e-3}, {16.5e-3, 1.2e-3}}, CylinderZ(16.5e-3, -1)},
                {{{16.5e-3, 1.2e-3}, foot}, PlaneAt(1.2e-3, 1)},
                {{foot, head}, ConeThrough(foot, head, 1)},
                {{head, tip}, ConeThrough(head, tip, -1)},
                {{tip, root}, ConeThrough(tip, root, -1)}},
               kTurn);
}

/** A shaft from z = 0 up, with chamfers at its ends. */
contact::ShapeSource ChamferedShaft() {
  constexpr double kEnd = 60e-3;
  const Eigen::Vector2d low{kShaftRadius - 0.5 * kChamfer, 0};
  const Eigen::Vector2d from{kShaftRadius, kChamfer};
  const Eigen::Vector2d to{kShaftRadius, kEnd - kChamfer};
  const Eigen::Vector2d high{kShaftRadius - 0.5 * kChamfer, kEnd};
  return Lathe({{{{0, 0}, low}, PlaneAt(0, -1)},
                {{low, from}, ConeThrough(low, from, 1)},
                {{from, to}, CylinderZ(kShaftRadius, 1)},
                {{to, high}, ConeThrough(to, high, 1)},
                {{high, {0, kEnd}}, PlaneAt(kEnd, 1)}},
               kTurn);
}

Product ShaftThroughSeal(double edge, const std::vector<mates::StatedElastic>& stated) {
  Product product;
  product.name = "drive";
  const auto housing = sequence::testing::AddPart(&product, "housing", Housing());
  const auto seal = sequence::testing::AddPart(&product, "lip seal", Seal(edge));
  const auto shaft = sequence::testing::AddPart(&product, "shaft", ChamferedShaft());
  sequence::testing::Place(&product, housing, "housing");
  sequence::testing::Place(&product, seal, "lip seal", Pose(Vec3(0, 0, kSealSeat)));
  sequence::testing::Place(&product, shaft, "shaft", Pose(Vec3(0, 0, 4e-3)));
  const auto flexible = product::ClassifyFlexible(product.parts[1]);
  EXPECT_TRUE(flexible);
  product.flexible.push_back(*flexible);
  product.flexible.back().occurrence = OccurrenceId(1);
  sequence::testing::Complete(&product);
  const auto set = mates::SetElasticParts(stated, &product);
  EXPECT_TRUE(set) << set.error().message;
  return product;
}

const simulation::PartResult* FindResult(const testing::Session& session, OccurrenceId id) {
  const auto& results = session.run.results();
  const auto found =
      std::find_if(results.begin(), results.end(),
                   [id](const simulation::PartResult& result) { return result.occurrence == id; });
  return found == results.end() ? nullptr : &*found;
}

/** Looks at the force of the pair that has a lip in it, and puts it together. */
void ExpectSpread(const std::shared_ptr<const simulation::Model>& model, double spread) {
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->presses.size(), 1U);
  const simulation::PressedPair& pair = model->presses[0];
  EXPECT_TRUE(pair.is_radial);
  EXPECT_EQ(pair.parts, std::vector{OccurrenceId(1)});
  EXPECT_NEAR(pair.compression, spread, 2e-6);
  const product::ElasticPart* seal = FindElastic(*model->product, OccurrenceId(1));
  ASSERT_NE(seal, nullptr);
  const double stiffness = fits::CalcLipStiffness(
      {kShaftRadius - spread, seal->lip_length(), seal->thickness, seal->modulus});
  EXPECT_NEAR(pair.curve->stiffness, stiffness, 1e-9 * stiffness);
  // On the cylinder it takes the friction of the whole lip, and the spring has no part in it.
  const haptics::GivingLoad inside = haptics::CalcGivingLoad(*pair.curve, 1e-3);
  EXPECT_NEAR(inside.in, pair.curve->friction * stiffness * spread, 1e-3 * inside.in);
  EXPECT_NEAR(inside.spring, 0, 1e-9);
  // Over the chamfer, 1 in 2, Bayer's ratio of the force across it.
  const double climb = fits::CalcSlidingRatio(pair.curve->friction, 0.5) * stiffness * spread;
  EXPECT_GT(pair.force, 0.8 * climb);
  EXPECT_LT(pair.force, 1.02 * climb);

  testing::Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(120));
  const simulation::PartResult* result = FindResult(session, pair.moved);
  ASSERT_NE(result, nullptr);
  EXPECT_TRUE(result->is_seated) << result->reason;
  EXPECT_NEAR(result->fit_true, pair.force, 0.25 * pair.force);
  EXPECT_PRED_FORMAT2(IsSubstring,
                      "the lip of drive/lip seal is spread by 0.40 mm: ", result->note);
}

TEST(SpreadLips, AShaftSpreadsALipThatIsDrawnNarrower) {
  ExpectSpread(simulation::testing::CompileFast(ShaftThroughSeal(kShaftRadius - 0.4e-3, {})),
               0.4e-3);
}

TEST(SpreadLips, ALipThatIsDrawnOnItsShaftIsSpreadByWhatIsStated) {
  EXPECT_TRUE(
      simulation::testing::CompileFast(ShaftThroughSeal(kShaftRadius, {}))->presses.empty());
  mates::StatedElastic stated;
  stated.part = "lip seal";
  stated.free_size = 19.2e-3;
  const auto model = simulation::testing::CompileFast(ShaftThroughSeal(kShaftRadius, {stated}));
  ExpectSpread(model, 0.4e-3);

  // It is drawn 0.4 mm narrower until its shaft is there, and then as in the file.
  const auto deformables =
      simulation::ListDeformables(*model->product, model->sequence, model->presses);
  ASSERT_EQ(deformables.size(), 1U);
  EXPECT_EQ(deformables[0].form.kind, simulation::DeformationKind::kFlare);
  std::vector<Pose> X_WB;
  for (const auto& occurrence : model->product->occurrences) {
    X_WB.push_back(occurrence.X_WB);
  }
  EXPECT_NEAR(simulation::CalcDeformations(*model->product, deformables, X_WB)[0], 0, 2e-6);
  X_WB[model->presses[0].moved.index()] =
      Pose(Vec3(0, 0, 0.2)) * X_WB[model->presses[0].moved.index()];
  const std::vector<double> free = simulation::CalcDeformations(*model->product, deformables, X_WB);
  EXPECT_NEAR(free[0], -0.4e-3, 2e-6);
  const auto move = MakePointMap(deformables, free, OccurrenceId(1));
  ASSERT_TRUE(move);
  EXPECT_NEAR(move(Vec3(kShaftRadius, 0, 5e-3)).x(), kShaftRadius - 0.4e-3, 20e-6);
  EXPECT_EQ(move(Vec3(17.5e-3, 0, 5e-3)), Vec3(17.5e-3, 0, 5e-3));
  EXPECT_EQ(move(Vec3(13e-3, 0, 0.5e-3)), Vec3(13e-3, 0, 0.5e-3));
}

}  // namespace
}  // namespace hvas::person
