// Force and moment of a peg that a spring leads into a hole beside the axis and tilted: felt in our
// tick, and in MuJoCo, against the equilibrium with exact geometry. Quasi-static, one point of
// contact and then two; the pair of haptics/test/insertion_force_test.cc.
//
//     insertion_bench

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "haptics/test/led_peg.h"

namespace {

using namespace hvas;                    // NOLINT: a program of one file.
using namespace hvas::haptics;           // NOLINT
using namespace hvas::haptics::testing;  // NOLINT

constexpr double kSpeed = 1e-3;  // [m/s]
constexpr double kLast = 34e-3;  // Deepest tip [m].
constexpr double kEvery = 1e-3;  // Of depth between two comparisons [m].
constexpr double kStart = 5e-3;  // [m]

/** Largest difference from the equilibrium, in shares of the largest of each. */
struct Errors {
  double f_x{0}, f_z{0}, m{0};
  int one_point{0}, two_points{0};

  void Add(const PlanarLoad& found, const PlanarLoad& expected) {
    constexpr double kLargest[] = {1.15, 0.5, 0.025};  // Of the insertion [N, N, N m].
    f_x = std::max(f_x, std::abs(found.f_x - expected.f_x) / kLargest[0]);
    f_z = std::max(f_z, std::abs(found.f_z - expected.f_z) / kLargest[1]);
    m = std::max(m, std::abs(found.m - expected.m) / kLargest[2]);
  }

  void Print(const char* name) const {
    fmt::print(
        "{:24} one point {:2}, two {:2}: off by {:.2f} % across, {:.2f} % along, {:.2f} % of the "
        "moment\n",
        name, one_point, two_points, 100 * f_x, 100 * f_z, 100 * m);
  }
};

PlanarSpring LedBy(double k_x, double k_t) {
  return {k_x, k_t, kHoleRadius - kPegRadius + kOffset + kCentre * std::sin(kTilt)};
}

/** The depth from which on two points touch. */
double FindTwoPointDepth(const PlanarSpring& spring) {
  constexpr double kStep = 10e-6;  // [m]
  for (int i = 0; kStart + i * kStep < kLast; ++i) {
    const double depth = kStart + i * kStep;
    // The tip has come to the other side of the hole.
    const double tilt = FindTiltOnRim(spring, depth);
    if (fits::CalcTipDepth(kPair, tilt) <= depth) {
      return depth;
    }
  }
  return kLast;
}

void Compare(const PlanarLoad& found, const PlanarSpring& spring, double depth, double two_point,
             Errors* errors) {
  constexpr double kBetween = 0.2e-3;  // Neither of the two is exact there [m].
  if (std::abs(depth - two_point) < kBetween) {
    return;
  }
  const bool is_one = depth < two_point;
  ++(is_one ? errors->one_point : errors->two_points);
  errors->Add(found, is_one ? CalcOnePoint(spring, depth) : CalcTwoPoint(spring, depth));
}

Errors RunOurs() {
  PegRig rig(kStart, kMu);
  const PlanarSpring spring = LedBy(rig.options.coupling.k_lin, rig.options.coupling.k_rot);
  rig.hand->MoveSoftly(Vec3(spring.x, 0, kCentre * (std::cos(kTilt) - 1)), 0.5, Vec3(0, kTilt, 0));
  const double two_point = FindTwoPointDepth(spring);
  Errors errors;
  while (rig.CalcTipDepth() < kLast) {
    rig.hand->MoveEvenly(Vec3(0, 0, -kEvery), kEvery / kSpeed);
    const spatial::Wrench& F = rig.hand->last().F_felt_W;
    Compare({F.f.x(), F.f.z(), F.t.y()}, spring, rig.CalcTipDepth(), two_point, &errors);
  }
  return errors;
}

/** The hole as a ring of boxes whose faces touch its circle, with the mouth at z = 0. */
std::string MakeModel(int walls, const PlanarSpring& spring) {
  const double half_width = kHoleRadius * std::tan(std::numbers::pi / walls);
  std::string boxes;
  for (int i = 0; i < walls; ++i) {
    const double angle = 2 * std::numbers::pi * i / walls;
    constexpr double kWall = 4e-3;  // Half of its thickness [m].
    const double middle = kHoleRadius + kWall;
    boxes += fmt::format("<geom type='box' size='{} {} {}' pos='{} {} {}' euler='0 0 {}'/>\n",
                         kWall, half_width, 0.5 * kHoleDepth, middle * std::cos(angle),
                         middle * std::sin(angle), -0.5 * kHoleDepth, angle);
  }
  // The hardest contacts that stay stable with this step.
  return fmt::format(
      R"(<mujoco><compiler angle='radian'/>
      <option timestep='0.0002' gravity='0 0 0' cone='elliptic' impratio='100' iterations='200' tolerance='1e-14'/>
      <default><geom friction='{} 0 0' condim='3' solref='0.0004 1' solimp='0.999 0.9999 0.00001'/></default>
      <worldbody>{}
      <body name='peg' pos='0 0 {}'><joint name='x' type='slide' axis='1 0 0' stiffness='{}' springref='{}' damping='20'/>
      <joint name='z' type='slide' axis='0 0 1' damping='600'/>
      <joint name='y' type='hinge' axis='0 1 0' stiffness='{}' springref='{}' damping='0.05'/>
      <geom type='cylinder' size='{} {}' mass='0.1'/></body></worldbody>
      <actuator><position joint='z' kp='1e6'/></actuator></mujoco>)",
      kMu, boxes, kCentre - kStart, spring.k_x, spring.x, spring.k_t, kTilt, kPegRadius,
      0.5 * kPegLength);
}

Errors RunMuJoCo(int walls, const PlanarSpring& spring) {
  const std::string text = MakeModel(walls, spring);
  mjVFS vfs;
  mj_defaultVFS(&vfs);
  mj_makeEmptyFileVFS(&vfs, "peg.xml", static_cast<int>(text.size()));
  std::copy(text.begin(), text.end(), static_cast<char*>(vfs.filedata[0]));
  std::array<char, 1000> error{};
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
      mj_loadXML("peg.xml", &vfs, error.data(), static_cast<int>(error.size())), mj_deleteModel);
  mj_deleteVFS(&vfs);
  if (model == nullptr) {
    fmt::print(stderr, "{}\n", error.data());
    std::exit(1);
  }
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  const double two_point = FindTwoPointDepth(spring);
  constexpr double kSettle = 0.5;  // [s] until it leans on the rim.
  // Its contact chatters: from step to step the force is anything between none and twice what it is
  // in the mean of a fifth of a second, which is what is compared.
  constexpr double kMean = 0.2;  // [s]
  double next = kStart + kEvery;
  std::array<double, 3> sum{};
  int steps = 0;
  Errors errors;
  for (double depth = kStart; depth < kLast;) {
    const double led = kSpeed * std::max(0.0, data->time - kSettle);
    data->ctrl[0] = -led;
    mj_step(model.get(), data.get());
    const double centre = kCentre - kStart + data->qpos[1];
    depth = kCentre * std::cos(data->qpos[2]) - centre;
    if (data->time < kSettle || depth < next - kMean * kSpeed) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += data->qfrc_constraint[k];
    }
    ++steps;
    if (depth > next) {
      Compare({sum[0] / steps, sum[1] / steps, sum[2] / steps}, spring, next - 0.5 * kMean * kSpeed,
              two_point, &errors);
      next += kEvery;
      sum = {};
      steps = 0;
    }
  }
  return errors;
}

}  // namespace

int main() {
  const PlanarSpring spring = LedBy(CouplingGains().k_lin, CouplingGains().k_rot);
  RunOurs().Print("hvas");
  for (const int walls : {16, 64}) {
    RunMuJoCo(walls, spring).Print(fmt::format("MuJoCo, {} walls", walls).c_str());
  }
  return 0;
}
