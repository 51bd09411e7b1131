// Parts that give by their form, whatever they are called: split rings, and walls with and without
// the room that they need behind them.

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "mates/flexible_parts.h"
#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

using contact::testing::CylinderZ;
using contact::testing::Lathe;
using contact::testing::PlaneAt;
using sequence::GivingPair;
using ::testing::IsSubstring;
using testing::OccurrenceId;
using testing::Pose;
using testing::Product;

/** A ring about z from z = 0 on, split by a gap about the x axis. */
contact::ShapeSource MakeSplitRing(double inner, double outer, double height, double gap) {
  constexpr int kPieces = 180;
  const double end = std::asin(0.5 * gap / inner);
  contact::ShapeSource source;
  source.faces = {PlaneAt(0, -1), CylinderZ(outer, 1), PlaneAt(height, 1), CylinderZ(inner, -1)};
  const auto corner = [&](int i, int k) {
    const double angle = end + i * (2 * std::numbers::pi - 2 * end) / kPieces;
    const double r = k == 1 || k == 2 ? outer : inner;
    return Vec3(r * std::cos(angle), r * std::sin(angle), k < 2 ? 0 : height);
  };
  const auto add_quad = [&source](const std::array<Vec3, 4>& p, std::uint32_t face) {
    const auto first = static_cast<std::uint32_t>(source.vertices.size());
    source.vertices.insert(source.vertices.end(), p.begin(), p.end());
    source.triangles.push_back({first, first + 1, first + 2});
    source.triangles.push_back({first, first + 2, first + 3});
    source.triangle_face.insert(source.triangle_face.end(), 2, face);
  };
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < kPieces; ++i) {
      const int next = (k + 1) % 4;
      add_quad({corner(i, k), corner(i + 1, k), corner(i + 1, next), corner(i, next)},
               static_cast<std::uint32_t>(k));
    }
  }
  for (const int i : {0, kPieces}) {
    std::array<Vec3, 4> p{corner(i, 0), corner(i, 1), corner(i, 2), corner(i, 3)};
    if (i == kPieces) {
      std::swap(p[1], p[3]);
    }
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    source.faces.push_back({spatial::SurfaceKind::kPlane, p[0], normal, 0, 0, 1});
    add_quad(p, static_cast<std::uint32_t>(source.faces.size() - 1));
  }
  return source;
}

void Recognise(Product* product) {
  Diagnostics diagnostics;
  const auto set = mates::SetFlexibleParts({}, {}, product, &diagnostics);
  ASSERT_TRUE(set) << set.error().ToString();
}

/** A plunger with a groove of 2 mm below its crown, and a split ring in it that has to open by 1.6
 mm. */
Product RingOnPlunger(const std::string& name) {
  constexpr double kFloor = 18.2e-3;
  constexpr double kCrown = 20e-3;
  Product product;
  product.name = "plunger";
  const auto plunger =
      testing::AddPart(&product, "body",
                       Lathe({{{{0, 0}, {kCrown, 0}}, PlaneAt(0, -1)},
                              {{{kCrown, 0}, {kCrown, 20e-3}}, CylinderZ(kCrown, 1)},
                              {{{kCrown, 20e-3}, {kFloor, 20e-3}}, PlaneAt(20e-3, 1)},
                              {{{kFloor, 20e-3}, {kFloor, 22e-3}}, CylinderZ(kFloor, 1)},
                              {{{kFloor, 22e-3}, {kCrown, 22e-3}}, PlaneAt(22e-3, -1)},
                              {{{kCrown, 22e-3}, {kCrown, 26e-3}}, CylinderZ(kCrown, 1)},
                              {{{kCrown, 26e-3}, {0, 26e-3}}, PlaneAt(26e-3, 1)}},
                             180));
  const auto ring =
      testing::AddPart(&product, name, MakeSplitRing(18.4e-3, kCrown, 1.95e-3, 0.4e-3));
  testing::Place(&product, plunger, "body");
  testing::Place(&product, ring, name, Pose(Vec3(0, 0, 20.02e-3)));
  Recognise(&product);
  testing::Complete(&product);
  return product;
}

TEST(YieldingTest, ASplitRingOpensOverTheCrownWhateverItIsCalled) {
  for (const char* name : {"piston ring", "compression seal", "part 2"}) {
    const auto model = testing::CompileFast(RingOnPlunger(name));
    ASSERT_TRUE(model->sequence.gaps.empty()) << name << ": " << model->sequence.gaps[0].reason;
    ASSERT_EQ(model->sequence.gives.size(), 1U) << name;
    const GivingPair& give = model->sequence.gives[0];
    EXPECT_EQ(give.flexible, OccurrenceId(1)) << name;
    EXPECT_EQ(give.kind, product::FlexibleKind::kRetainingRing) << name;
    EXPECT_NEAR(give.width, 1.6e-3, 0.35e-3) << name;
    // w / 2 (1 / r - 1 / (r + y)) = 0.8 (1 / 19.2 - 1 / 20.8).
    EXPECT_NEAR(give.strain, 3.2e-3, 0.7e-3) << name;
    EXPECT_DOUBLE_EQ(give.bearable_strain, 0.02) << name;
  }
}

/** A neck with a bead that is 0.25 mm wider than the lip of its cap, and a wall around the cap.
 @param room  Between cap and wall [m]. */
Product CapInCollar(double room, const std::string& name) {
  constexpr double kCap = 11.6e-3;
  const double wall = kCap + room;
  Product product;
  product.name = "bottle";
  const auto neck =
      testing::AddPart(&product, "neck",
                       Lathe({{{{0, 0}, {16e-3, 0}}, PlaneAt(0, -1)},
                              {{{16e-3, 0}, {16e-3, 13e-3}}, CylinderZ(16e-3, 1)},
                              {{{16e-3, 13e-3}, {wall, 13e-3}}, PlaneAt(13e-3, 1)},
                              {{{wall, 13e-3}, {wall, 4e-3}}, CylinderZ(wall, -1)},
                              {{{wall, 4e-3}, {10e-3, 4e-3}}, PlaneAt(4e-3, 1)},
                              {{{10e-3, 4e-3}, {10e-3, 12e-3}}, CylinderZ(10e-3, 1)},
                              {{{10e-3, 12e-3}, {10.3e-3, 12e-3}}, PlaneAt(12e-3, -1)},
                              {{{10.3e-3, 12e-3}, {10.3e-3, 13e-3}}, CylinderZ(10.3e-3, 1)},
                              {{{10.3e-3, 13e-3}, {10e-3, 13e-3}}, PlaneAt(13e-3, 1)},
                              {{{10e-3, 13e-3}, {10e-3, 17e-3}}, CylinderZ(10e-3, 1)},
                              {{{10e-3, 17e-3}, {0, 17e-3}}, PlaneAt(17e-3, 1)}},
                             64));
  const auto cap =
      testing::AddPart(&product, name,
                       Lathe({{{{0, 17e-3}, {10.4e-3, 17e-3}}, PlaneAt(17e-3, -1)},
                              {{{10.4e-3, 17e-3}, {10.4e-3, 11e-3}}, CylinderZ(10.4e-3, -1)},
                              {{{10.4e-3, 11e-3}, {10.05e-3, 11e-3}}, PlaneAt(11e-3, 1)},
                              {{{10.05e-3, 11e-3}, {10.05e-3, 10e-3}}, CylinderZ(10.05e-3, -1)},
                              {{{10.05e-3, 10e-3}, {kCap, 10e-3}}, PlaneAt(10e-3, -1)},
                              {{{kCap, 10e-3}, {kCap, 19e-3}}, CylinderZ(kCap, 1)},
                              {{{kCap, 19e-3}, {0, 19e-3}}, PlaneAt(19e-3, 1)}},
                             64));
  testing::Place(&product, neck, "neck");
  testing::Place(&product, cap, name);
  Recognise(&product);
  testing::Complete(&product);
  return product;
}

TEST(YieldingTest, AWallWithRoomBehindItBendsWhateverItIsCalled) {
  for (const char* name : {"snap clip", "part 2"}) {
    const auto model = testing::CompileFast(CapInCollar(1.5e-3, name));
    ASSERT_TRUE(model->sequence.gaps.empty()) << name << ": " << model->sequence.gaps[0].reason;
    ASSERT_EQ(model->sequence.gives.size(), 1U) << name;
    const GivingPair& give = model->sequence.gives[0];
    EXPECT_EQ(give.kind, product::FlexibleKind::kForm) << name;
    EXPECT_EQ(give.flexible, OccurrenceId(1)) << name;
    EXPECT_GT(give.strain, 0) << name;
    EXPECT_LT(give.strain, give.bearable_strain) << name;
  }
}

TEST(YieldingTest, AWallWithoutTheRoomBehindItIsRefusedForThatReasonWhateverItIsCalled) {
  std::string first;
  for (const char* name : {"snap clip", "part 2"}) {
    const auto model = testing::CompileFast(CapInCollar(0.1e-3, name));
    ASSERT_EQ(model->sequence.gaps.size(), 1U) << name;
    const std::string& reason = model->sequence.gaps[0].reason;
    EXPECT_PRED_FORMAT2(IsSubstring, "no room to bend", reason);
    EXPECT_PRED_FORMAT2(IsSubstring, "bottle/neck leaves 0.1", reason);
    EXPECT_TRUE(model->sequence.gives.empty()) << name;
    first = first.empty() ? reason : first;
    EXPECT_EQ(reason, first);
  }
}

}  // namespace
}  // namespace hvas::simulation
