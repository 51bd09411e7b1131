// A screw drawn at its outer diameter goes into a hole drawn for its core, and its head still stops
// it: X2, N10.

#include <numbers>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "sequence/mate_faces.h"
#include "sequence/thread_faces.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using contact::testing::CylinderZ;
using contact::testing::PlaneAt;

constexpr double kCore = 2.1e-3;   // Radius of the hole: M5.
constexpr double kOuter = 2.5e-3;  // Of the thread.
constexpr double kHead = 4.25e-3;
constexpr double kTip = -12e-3;
constexpr double kHeadTop = 5e-3;
constexpr int kSegments = 64;

/** An M5 screw with a chamfered tip in a round plate 20 mm thick; its head is on the plate's top,
 in the plane z = 0. */
product::Product ScrewInCoreHole() {
  product::Product product;
  product.name = "tapped";
  const auto plate = sequence::testing::AddPart(
      &product, "plate",
      contact::testing::Lathe({{{{kCore, -20e-3}, {15e-3, -20e-3}}, PlaneAt(-20e-3, -1)},
                               {{{15e-3, -20e-3}, {15e-3, 0}}, CylinderZ(15e-3, 1)},
                               {{{15e-3, 0}, {kCore, 0}}, PlaneAt(0, 1)},
                               {{{kCore, 0}, {kCore, -20e-3}}, CylinderZ(kCore, -1)}},
                              kSegments));
  constexpr double kChamfer = 0.6e-3;
  const spatial::Surface chamfer{spatial::SurfaceKind::kCone,
                                 Vec3(0, 0, kTip - (kOuter - kChamfer)),
                                 Vec3::UnitZ(),
                                 0,
                                 std::numbers::pi / 4,
                                 1};
  const auto screw = sequence::testing::AddPart(
      &product, "screw M5x12",
      contact::testing::Lathe({{{{0, kTip}, {kOuter - kChamfer, kTip}}, PlaneAt(kTip, -1)},
                               {{{kOuter - kChamfer, kTip}, {kOuter, kTip + kChamfer}}, chamfer},
                               {{{kOuter, kTip + kChamfer}, {kOuter, 0}}, CylinderZ(kOuter, 1)},
                               {{{kOuter, 0}, {kHead, 0}}, PlaneAt(0, -1)},
                               {{{kHead, 0}, {kHead, kHeadTop}}, CylinderZ(kHead, 1)},
                               {{{kHead, kHeadTop}, {0, kHeadTop}}, PlaneAt(kHeadTop, 1)}},
                              kSegments));
  sequence::testing::Place(&product, plate, "plate");
  sequence::testing::Place(&product, screw, "screw");
  sequence::testing::Complete(&product);
  return product;
}

TEST(ThreadTest, ScrewGoesIntoTheHoleOfItsCoreAndItsHeadStopsIt) {
  auto product = std::make_shared<product::Product>(ScrewInCoreHole());
  ASSERT_EQ(product->mates.size(), 2U);
  ASSERT_TRUE(sequence::IsDrawnThread(product->mates[0]) ||
              sequence::IsDrawnThread(product->mates[1]));
  Diagnostics diagnostics;
  const auto model = simulation::Compile(product, simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value());
  EXPECT_TRUE((*model)->sequence.overlaps.empty());
  ASSERT_TRUE((*model)->sequence.gaps.empty()) << (*model)->sequence.gaps[0].reason;
  for (const std::uint64_t seed : {1, 2}) {
    testing::Session session(*model, seed);
    (void)simulation::RunLockstep(session.MakeExecution(60));
    ASSERT_EQ(session.run.results().size(), 2U);
    const simulation::PartResult& screw = session.run.results()[1];
    EXPECT_TRUE(screw.is_seated) << screw.reason;
    EXPECT_LT(screw.pose_error, 1e-6);
    EXPECT_LE(screw.deepest, 50e-6);  // Of all but the thread.
    EXPECT_LE(session.watch.largest_jump, 0.5);
  }
}

TEST(ThreadTest, WidenedFacesLeaveOutWhatThePartsRestOn) {
  const product::Product product = ScrewInCoreHole();
  const product::Mate& thread =
      sequence::IsDrawnThread(product.mates[0]) ? product.mates[0] : product.mates[1];
  const auto widened = [&](const product::Connector& side) {
    const product::Part& part = product.part_of(side.occurrence);
    const haptics::MateFaces faces =
        sequence::CollectMateFaces(part, part.features[side.feature.index()].faces);
    return *sequence::WidenForThread(product, thread, side, faces);
  };
  // Faces as listed above. The hole: itself and the bottom, not the top; the thread: itself and its
  // chamfer, not the head's lower side.
  EXPECT_EQ(widened(thread.a).mating, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(widened(thread.b).mating, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(widened(thread.a).with_neighbours, (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(widened(thread.b).with_neighbours, (std::vector<std::uint32_t>{1, 2, 3}));
}

}  // namespace
}  // namespace hvas::person
