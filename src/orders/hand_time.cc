#include "orders/hand_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace hvas::orders {
namespace {

struct MoveClass {
  int mods;
  double distance;  // [m]
};

// Heyde's classes of a move: finger, hand, forearm, arm, arm stretched out, with the trunk.
constexpr std::array<MoveClass, 7> kMoveClasses{
    {{0, 0}, {1, 0.025}, {2, 0.05}, {3, 0.15}, {4, 0.3}, {5, 0.45}, {7, 0.75}}};

// Parts smaller or thinner than this are hard to grasp: the limits by which Boothroyd and Dewhurst
// tell parts apart (Product Design for Assembly, 1989) [m].
constexpr double kSmall = 15e-3;
constexpr double kThin = 2e-3;

constexpr int kLook = 2;  // E2, before a get or a put that needs care [MOD].

}  // namespace

int SumMods(const std::vector<HandMotion>& motions) {
  return std::accumulate(motions.begin(), motions.end(), 0,
                         [](int sum, const HandMotion& motion) { return sum + motion.mods; });
}

int CalcMoveMods(double distance) {
  const auto nearest = std::min_element(
      kMoveClasses.begin(), kMoveClasses.end(), [distance](const MoveClass& a, const MoveClass& b) {
        return std::abs(a.distance - distance) < std::abs(b.distance - distance);
      });
  return nearest->mods;
}

int CalcGetMods(const Vec3& size) {
  const bool is_hard = size.maxCoeff() < kSmall || size.minCoeff() < kThin;
  return is_hard ? kLook + 3 : 1;
}

int CalcPutMods(PutCare care) {
  switch (care) {
    case PutCare::kNone:
      return 0;
    case PutCare::kSome:
      return kLook + 2;
    case PutCare::kExact:
      return kLook + 5;
  }
  return 0;
}

int CalcLoadMods(double mass) {
  return mass < 2 ? 0 : 1 + static_cast<int>(std::ceil(std::max(0.0, mass - 6) / 4));
}

}  // namespace hvas::orders
