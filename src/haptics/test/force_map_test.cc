// The map from true to felt newtons: W9, N4.

#include "haptics/force_map.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace hvas::haptics {
namespace {

/** Magnitudes from 1 mN to 1 MN, `n` per decade. */
std::vector<double> Decades(int n) {
  std::vector<double> out;
  for (int i = -3 * n; i <= 6 * n; ++i) {
    out.push_back(std::pow(10.0, static_cast<double>(i) / n));
  }
  return out;
}

const ForceMap kMaps[] = {ForceMap(100e3, 7.11), ForceMap(100e3, 2.97), ForceMap(5e3, 0.36),
                          ForceMap(20, 7.9)};

// N4: small forces are felt as they are, to the last bit.
TEST(ForceMap, IsTheIdentityInItsLinearPart) {
  for (const ForceMap& map : kMaps) {
    for (const double share : {0.0, 1e-9, 0.1, 0.5, 0.999, 1.0}) {
      const double force = share * map.linear_limit();
      EXPECT_EQ(map.Felt(force), force);
      EXPECT_EQ(map.True(force), force);
    }
    EXPECT_GT(map.linear_limit(), 0);
  }
}

// N4: the true newtons are always known.
TEST(ForceMap, InverseReturnsTheTrueForceToTwelveDigits) {
  double worst = 0;
  for (const ForceMap& map : kMaps) {
    for (const double force : Decades(200)) {
      worst = std::max(worst, std::abs(map.True(map.Felt(force)) / force - 1));
    }
  }
  RecordProperty("worst_relative", std::to_string(worst));
  EXPECT_LT(worst, 1e-12);
}

// N4: two forces that differ by a thousandth can be told apart, over nine decades.
TEST(ForceMap, RisesStrictlyAndNeverAmplifies) {
  for (const ForceMap& map : kMaps) {
    double before = 0;
    for (const double force : Decades(2000)) {
      const double felt = map.Felt(force);
      ASSERT_GT(felt, before) << force;
      ASSERT_LE(felt, force * (1 + 1e-15));
      before = felt;
    }
  }
}

// The slope is L/F above L and 1 below: no kink where they meet.
TEST(ForceMap, SlopeIsContinuousAtTheJoint) {
  for (const ForceMap& map : kMaps) {
    const double limit = map.linear_limit();
    for (const double h : {1e-3, 1e-4, 1e-5}) {
      const double above = (map.Felt(limit * (1 + h)) - map.Felt(limit)) / (limit * h);
      const double below = (map.Felt(limit) - map.Felt(limit * (1 - h))) / (limit * h);
      EXPECT_NEAR(above, below, 0.51 * h);  // (1 - slope) is h / 2 to first order.
    }
    for (const double ratio : {2.0, 30.0, 1e4}) {
      const double force = ratio * limit;
      const double slope =
          (map.Felt(force * (1 + 1e-6)) - map.Felt(force * (1 - 1e-6))) / (2e-6 * force);
      EXPECT_NEAR(slope * ratio, 1, 1e-6);
    }
  }
}

// W9: one statement about the device fixes the map.
TEST(ForceMap, W9FeelsTheLargestTrueForceAsTheLargestFeltOne) {
  for (const double largest_true : {8.0, 100.0, 77931.13, 1e5, 1e7}) {
    for (const double largest_felt : {0.36, 2.97, 7.11}) {
      const ForceMap map(largest_true, largest_felt);
      EXPECT_NEAR(map.Felt(largest_true) / largest_felt, 1, 1e-14);
      EXPECT_GT(map.linear_limit(), 0);
      EXPECT_LT(map.linear_limit(), largest_felt);
    }
  }
}

// The bisection ends at the root that Newton's method finds for L (1 + ln(T/L)) = f.
TEST(ForceMap, LinearLimitAgreesWithNewtonsMethod) {
  for (const double ratio : {1.001, 1.5, 10.0, 1e4, 1e9}) {
    const double largest_felt = 7.11;
    const double largest_true = ratio * largest_felt;
    double limit = 1e-3 * largest_felt;
    for (int i = 0; i < 200; ++i) {
      const double value = limit * (1 + std::log(largest_true / limit)) - largest_felt;
      limit -= value / std::log(largest_true / limit);
    }
    // The root is double where T = f, hence known to fewer digits near it.
    const double tolerance = ratio < 1.01 ? 1e-12 : 1e-14;
    EXPECT_NEAR(ForceMap(largest_true, largest_felt).linear_limit() / limit, 1, tolerance) << ratio;
  }
}

// W10's press fit: of what a table of W(8) gives, the hand can tell 1 % at any depth from the next.
TEST(ForceMap, W9PressForcesStayWithinTheDeviceAndApart) {
  const ForceMap map(100e3, 7.11);
  for (const double force : {100.0, 3711.01, 39893.3, 77931.13}) {
    EXPECT_LT(map.Felt(force), 7.11);
    EXPECT_NEAR(map.Felt(1.01 * force) - map.Felt(force), map.linear_limit() * std::log(1.01),
                1e-12);
  }
}

// N4: the device alone sets the map; a transition fit and an interference fit are two or more just
// noticeable differences of 10 % apart at the end of their way, wherever they end.
TEST(ForceMap, DeviceAloneSetsTheMapAndFitsStayApart) {
  for (const double max_force : {3.3, 7.9, 22.0}) {
    device::DeviceProfile device;
    device.max_force = max_force;
    const ForceMap map = MakeForceMap(device);
    EXPECT_NEAR(map.Felt(kLargestTrueForce), kLargestFeltShare * max_force, 1e-12 * max_force);
    // H7/k6 of equal sizes and H7/p6 in mid zone, fits-and-insertion 2.4.
    EXPECT_GT(map.Felt(39893.3) / map.Felt(2329), 1.25);
    EXPECT_GT(map.Felt(2329) / map.Felt(0.3), 5);
  }
  device::DeviceProfile three_axes;
  three_axes.max_torque = 0;
  EXPECT_EQ(MakeTorqueMap(three_axes).Felt(1000), 0);
}

}  // namespace
}  // namespace hvas::haptics
