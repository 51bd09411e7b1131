// A nut with a modelled thread on its bolt in the hand, by contact alone.

#include "haptics/test/turned_nut.h"

#include <cstddef>
#include <numbers>

#include <gtest/gtest.h>

#include "contact/test/thread_mesh.h"

namespace hvas::haptics {
namespace {

using contact::testing::ThreadMesh;
using contact::testing::ThreadSize;

/** Takes a nut of four turns, three pitches above the lower end of its bolt. */
void TakeNut(const ThreadSize& size, double clearance, testing::HeldRig* rig) {
  constexpr double kOutside = 7e-3;  // [m]
  rig->scene.Add(contact::testing::Build(ThreadMesh(size, 12 * size.pitch, 0, 0)), {});
  rig->Place(contact::testing::Build(ThreadMesh(size, 4 * size.pitch, clearance, kOutside)),
             spatial::Pose(Vec3(0, 0, 4 * size.pitch)));
  rig->part.mass = 0.02;
  rig->part.I_BBcm_B = 1e-6 * Mat3::Identity();
  rig->part.X_WB_goal = spatial::Pose(Vec3(1, 1, 1));
  rig->Take();
  rig->hand->Wait(0.2);
}

TickOptions NutAlone() {
  TickOptions options;
  options.condition = Condition::kCollision;
  options.gravity_W.setZero();
  return options;
}

TEST(TurnedNut, RunsOnItsBoltByContactAloneAndAdvancesByThePitch) {
  for (const double handed : {1.0, -1.0}) {
    ThreadSize size;
    size.sense = handed;
    testing::HeldRig rig(NutAlone());
    TakeNut(size, 60e-6, &rig);
    testing::TurnedNut script;
    script.turns = 1.5;
    script.handed = handed;
    for (const double way : {-1.0, 1.0}) {
      const auto before = static_cast<std::ptrdiff_t>(rig.hand->samples.size());
      const testing::NutLeg leg = testing::Turn(script, way, &rig);
      EXPECT_NEAR(leg.turns, handed * way * script.turns, 0.02);
      EXPECT_NEAR(leg.advanced / leg.turns, handed * size.pitch, 0.01 * size.pitch);
      // But for the blow with which the script turns round from one tick to the next.
      const std::ptrdiff_t run_in = 250;  // Ticks.
      EXPECT_LT(testing::CalcDeepest(
                    {rig.hand->samples.begin() + before + run_in, rig.hand->samples.end()}),
                2e-6);
    }
  }
}

TEST(TurnedNut, DoesNotComeOffWithoutTurning) {
  testing::HeldRig rig(NutAlone());
  TakeNut({}, 60e-6, &rig);
  const double before = rig.hand->last().X_WD.p().z();
  const Vec3 start = rig.hand->last().X_WD * rig.part.p_BoBcm_B;
  for (int i = 0; i < 500; ++i) {
    rig.hand->LeadTo(start + Vec3(0, 0, 4e-3), Vec3::Zero());
  }
  // Pulled by 4 N it goes as far as its play, c tan 30 to either side of the middle.
  const double play = 60e-6 / std::numbers::sqrt3;
  EXPECT_LT(rig.hand->last().X_WD.p().z() - before, 2 * play + 5e-6);
  EXPECT_GT(rig.hand->last().F_felt_W.f.norm(), 3);
}

}  // namespace
}  // namespace hvas::haptics
