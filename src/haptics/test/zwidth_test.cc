// Which walls hold still: a small version of bench/zwidth_bench. N6.

#include <gtest/gtest.h>

#include "haptics/coupling_rule.h"
#include "haptics/test/values.h"
#include "haptics/test/wall_rig.h"

namespace hvas::haptics {
namespace {

using testing::kGrips;
using testing::kProfiles;
using testing::Press;

constexpr double kStiffness[] = {0.25, 0.5, 1, 2, 4, 8, 16};  // of the device's maximum

/** Up to where all walls without damping are stable, times the device's maximum; 0: none is. */
double FindLargest(const device::DeviceProfile& profile, const testing::Grip& grip,
                   bool is_controlled) {
  double largest = 0;
  for (const double k : kStiffness) {
    if (!Press(profile, grip, k * profile.max_stiffness, 0, is_controlled).is_stable()) {
      break;
    }
    largest = k;
  }
  return largest;
}

TEST(ZWidth, TheControllerNeverTakesAWallAwayAndAddsStifferOnes) {
  for (const char* id : kProfiles) {
    const device::DeviceProfile& profile = device::FindProfile(id)->profile;
    int stiffer = 0;
    int within = 0;  // Grips with a border inside the sweep.
    for (const testing::Grip& grip : kGrips) {
      const double plain = FindLargest(profile, grip, false);
      const double controlled = FindLargest(profile, grip, true);
      EXPECT_GE(controlled, plain) << id << ", " << grip.name;
      stiffer += controlled > plain ? 1 : 0;
      within += plain < kStiffness[std::size(kStiffness) - 1] ? 1 : 0;
    }
    EXPECT_GE(within, 1) << id;
    EXPECT_GE(stiffer, 1) << id;
  }
}

// The chosen gains, and twice as stiff, are stable in every hand, without the controller.
TEST(ZWidth, ChosenGainsLieWellInTheStableRegion) {
  for (const char* id : kProfiles) {
    const device::DeviceProfile& profile = device::FindProfile(id)->profile;
    const CouplingGains gains = ChooseCoupling(profile, 1, 1 / profile.rate_hz);
    for (const testing::Grip& grip : kGrips) {
      for (const double factor : {1.0, 2.0}) {
        const testing::PressRun run =
            Press(profile, grip, factor * gains.k_lin, gains.b_lin, false);
        EXPECT_TRUE(run.is_stable()) << id << ", " << grip.name << ", " << factor << ": swing "
                                     << run.swing << " m, " << run.force << " N";
      }
    }
  }
}

}  // namespace
}  // namespace hvas::haptics
