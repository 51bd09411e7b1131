// How smooth the force in the hand is while parts slide on each other, N2: tests C, A and P of the
// contact study, the force of the coupling (1 N/mm) instead of a pooled one.
// HVAS_TOL_SCALE=0 prints what there is.

#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "contact/test/accuracy_cases.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using contact::testing::AccuracyCase;
using spatial::Pose;
using testing::kDt;

/** A part in weightless and frictionless contact, led along a path of its own poses. */
class SlidingRig : public testing::HeldRig {
 public:
  SlidingRig(const AccuracyCase& test, const Pose& X_WB_start) : HeldRig(MakeOptions()) {
    scene.Add(contact::testing::Build(test.other(1e-6)), {});
    Place(contact::testing::Build(test.held(1e-6)), X_WB_start);
    part.mass = 0.5;
    part.I_BBcm_B = 2e-4 * Mat3::Identity();
    part.p_BoBcm_B = 0.5 * (part.shape->box_B().low + part.shape->box_B().high);
    part.X_WB_goal = Pose(Vec3(1, 1, 1));
    Take();
    X_WB_ = X_WB_start;
  }

  /** A millisecond later the hand has led the tracked part here. */
  TickOutput MoveTo(const Pose& X_WB) {
    device::DeviceState state;
    state.t_ns = ++count_ * 1'000'000;
    state.X_DH = {X_WB.q(), X_WB * part.p_BoBcm_B};
    state.V_DH.v = (X_WB * part.p_BoBcm_B - X_WB_ * part.p_BoBcm_B) / kDt;
    state.V_DH.w = spatial::RotationBetween(X_WB_.q(), X_WB.q()) / kDt;
    X_WB_ = X_WB;
    return tick->Tick(state);
  }

 private:
  static TickOptions MakeOptions() {
    TickOptions options;
    options.gravity_W.setZero();
    options.contact.friction.static_coefficient = 0;
    options.contact.friction.kinetic_coefficient = 0;
    return options;
  }

  Pose X_WB_;
  std::int64_t count_{0};
};

/** Largest change of the coupling's force from one tick to the next along the case's path [N],
 after it has been pressed softly and has settled. Not along the way that the hand slides, where the
 part swings in its coupling after the hand has started: what presses. */
double CalcLargestChange(const AccuracyCase& test, const Pose& X_WB_free, const Vec3& way) {
  SlidingRig rig(test, X_WB_free);
  const Pose first = test.pose(0);
  constexpr int kPress = 300, kSettle = 400, kRunIn = 150;
  for (int i = 0; i < kPress + kSettle; ++i) {
    const double s = std::min(1.0, static_cast<double>(i) / kPress);
    rig.MoveTo(Pose(first.q(), (1 - s) * X_WB_free.p() + s * first.p()));
  }
  double largest = 0;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < test.steps; ++i) {
    const Vec3 force = rig.MoveTo(test.pose(i)).F_true_W.f;
    const Vec3 change = force - last;
    largest = i > kRunIn ? std::max(largest, (change - change.dot(way) * way).norm()) : 0;
    last = force;
  }
  if (std::getenv("HVAS_TOL_SCALE") != nullptr) {
    std::printf("  %s: %.3f N, largest change %.4f mN per ms\n", test.name, last.norm(),
                1e3 * largest);
  }
  return largest;
}

// 0.1 N that turns by 2.5 mrad in a millisecond changes by 0.25 mN.
TEST(Smoothness, OfAShaftTurningInABore) {
  const AccuracyCase test = contact::testing::CaseC();
  const Pose centred(Vec3(0, 0, test.pose(0).p().z()));
  EXPECT_LE(CalcLargestChange(test, centred, Vec3::Zero()), 0.35e-3);
}

// As far as where the shaft's rim meets the bore's, 219 steps on: sharp rims catch on one another
// by the 0.06 um that contact gives way under 0.1 N.
TEST(Smoothness, OfAShaftSlidingOverAGroove) {
  AccuracyCase test = contact::testing::CaseA();
  test.steps = 215;
  const Pose centred(Vec3(0, 0, test.pose(0).p().z()));
  EXPECT_LE(CalcLargestChange(test, centred, Vec3::UnitZ()), 2e-3);
}

TEST(Smoothness, OfAPlateSlidingOnAnother) {
  const AccuracyCase test = contact::testing::CaseP();
  const Pose lifted(test.pose(0).p() + Vec3(0, 0, 0.2e-3));
  const Vec3 way = (test.pose(1).p() - test.pose(0).p()).normalized();
  EXPECT_LE(CalcLargestChange(test, lifted, way), 0.1e-3);
}

}  // namespace
}  // namespace hvas::haptics
