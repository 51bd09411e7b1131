// Contact never gives energy: dropped, pressed and sliding parts. X7, N2.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/test/rig.h"
#include "haptics/test/table.h"

namespace hvas::haptics {
namespace {

using contact::testing::Block;
using contact::testing::Build;
using contact::testing::Bushing;
using contact::testing::Shaft;
using spatial::Pose;
using testing::BlockRig;
using testing::BoxInertia;
using testing::kDt;
using testing::Table;

/** Of a body that moves by itself: of motion and height [J]. */
double CalcEnergy(const FreeBody& body, double mass, const Mat3& I_BBcm_B, double gravity) {
  const Mat3 R = body.X_WB.R();
  return 0.5 * mass * body.V.v.squaredNorm() +
         0.5 * body.V.w.dot(R * I_BBcm_B * R.transpose() * body.V.w) +
         mass * gravity * body.X_WB.p().z();
}

// 20 blocks dropped on their corners, edges and sides, with and without friction: the energy of
// motion and height never rises over its lowest value by more than a contact that was struck gives
// back (the recovery speed's 40 uJ, and 2 uJ per um of height), and never above what there was.
TEST(Energy, DroppedBlockOnlyLosesIt) {
  const Vec3 half(0.03, 0.02, 0.01);
  const double mass = 0.2;
  const Mat3 inertia = BoxInertia(mass, half);
  const auto shape = Build(Block(half));
  Random random(5);
  double largest_rise = 0;
  constexpr double kStored = 100e-6;  // [J]
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    Table table(i % 2 == 0 ? 0.0 : 0.3);
    const Quat q =
        Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal()).normalized();
    const auto id = table.AddLoose(shape, Pose(q, Vec3(0, 0, 0.06)), mass, inertia);
    table.Drop(id, shape, mass, inertia);
    const double g = table.options.gravity_W.norm();
    const double first = mass * g * 0.06;
    double lowest = first;
    for (int k = 0; k < 400 && !table.tick->awake().empty(); ++k) {
      table.Wait(kDt);
      if (table.tick->awake().empty()) {
        break;
      }
      const double energy = CalcEnergy(table.tick->awake()[0], mass, inertia, g);
      lowest = std::min(lowest, energy);
      largest_rise = std::max(largest_rise, energy - lowest);
      ASSERT_LE(energy, first);
      ASSERT_LE(energy, lowest + kStored);
    }
    EXPECT_LT(lowest, 0.7 * first);
  }
}

// Pressed onto a block and slid over it and its edges at up to 0.3 m/s, and back to where it was:
// the hand has put in more than it got, whatever the way, and so at every moment but for what the
// coupling stores.
TEST(Energy, PressedAndSlidPartGivesNone) {
  const Vec3 half(0.01, 0.01, 0.01);
  Random random(9);
  const auto shape = Build(Block(half));
  for (int draw = 0; draw < 6; ++draw) {
    SCOPED_TRACE(draw);
    BlockRig rig(shape, 0.1, Pose(Vec3(0.09, 0, 0.0105)));
    rig.hand->Wait(0.5);
    const std::size_t first = rig.hand->samples.size();
    Vec3 there = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
      const Vec3 d(random.Uniform(-0.02, 0.02), random.Uniform(-0.02, 0.02),
                   random.Uniform(-6e-3, 0));
      const Vec3 move = i == 7 ? Vec3(-there) : Vec3(d - there);
      rig.hand->MoveSoftly(move, std::max(0.1, move.norm() / 0.15));
      there += move;
    }
    rig.hand->Wait(0.5);
    double work = 0;  // By the hand.
    double least = 0;
    for (std::size_t i = first; i < rig.hand->samples.size(); ++i) {
      const auto& s = rig.hand->samples[i];
      work -= kDt * s.out.F_felt_W.f.dot(s.hand.V_DH.v);
      // The coupling holds at most F^2 / 2k, the part its weight's height; less cannot be owed.
      const double stored = s.out.F_felt_W.f.squaredNorm() / (2 * rig.options.coupling.k_lin);
      least = std::min(least, work + stored);
    }
    EXPECT_GT(work, 0);
    EXPECT_GT(least, -0.1 * 9.81 * 0.01);
  }
}

}  // namespace
}  // namespace hvas::haptics
