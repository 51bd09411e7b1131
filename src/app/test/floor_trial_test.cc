// The floor of `hvas devices --try` on emulated devices in virtual time, through their real
// drivers.
#include "app/devices/floor_trial.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "device/driver.h"
#include "device/emulation/emulator.h"

namespace hvas::app {
namespace {

/** An emulated device whose hand presses on the floor of a trial. */
class PressedTrial {
 public:
  PressedTrial(const std::string& driver, double rate_hz)
      : period_ns_(std::llround(1e9 / rate_hz)) {
    device::EmulatorOptions options;
    const device::SourcedProfile* known = device::FindProfileOfDriver(driver);
    options.profile = known != nullptr ? known->profile : device::FindProfile("touch_x")->profile;
    options.profile.rate_hz = std::max(options.profile.rate_hz, rate_hz);
    auto emulator = device::StartEmulator(driver, options);
    EXPECT_TRUE(emulator) << emulator.error().ToString();
    emulator_ = std::move(*emulator);
    auto device = device::OpenDevice(emulator_->address(), emulator_->surroundings());
    EXPECT_TRUE(device) << device.error().ToString();
    device_ = std::move(*device);
    trial_ = std::make_unique<FloorTrial>(device_.get(), rate_hz, *emulator_->surroundings().clock);
  }

  /** Lifts the hand off the floor with an open grip, and presses it down: a floor that has let go
   of the hand owes it nothing. */
  void Press() {
    constexpr double kReach = 0.02;   // [m] of the hand's way, either way.
    constexpr double kLower = -0.01;  // [m]: the middle of it.
    const Quat q_DU = device_->info().profile.q_UD.conjugate();
    for (double t = 0; t < 2; t += period_s()) {
      device::HandIntent hand;
      // Up in a second, down in the next.
      const double phase = std::numbers::pi * t;
      hand.X_DR = spatial::Pose(Vec3(q_DU * Vec3(0, 0, kLower - kReach * std::cos(phase))));
      hand.V_DR.v = q_DU * Vec3(0, 0, kReach * std::numbers::pi * std::sin(phase));
      hand.buttons = t < 1 ? 0 : 1;
      emulator_->device().SetHand(hand);
      (void)Tick();
    }
  }

  /** One tick on time. @returns the force that the device was given [N]. */
  double Tick() {
    emulator_->Advance(period_ns_);
    trial_->Tick();
    return force();
  }

  void Run(double time_s) {
    for (std::int64_t t_ns = 0; t_ns < std::llround(1e9 * time_s); t_ns += period_ns_) {
      (void)Tick();
    }
  }

  /** The loop does not run, and the device and its hand do. */
  void StandStill(double time_s) { emulator_->Advance(std::llround(1e9 * time_s)); }

  /** Force of the last write [N]. */
  [[nodiscard]] double force() { return trial_->ReadState().F_H_D.f.norm(); }

  [[nodiscard]] double period_s() const { return 1e-9 * static_cast<double>(period_ns_); }

 private:
  std::int64_t period_ns_;
  std::unique_ptr<device::Emulator> emulator_;
  std::unique_ptr<device::Device> device_;
  std::unique_ptr<FloorTrial> trial_;
};

/** Stands still again and again while the floor pushes, and looks at what is written afterwards. */
void ExpectSoftStarts(PressedTrial* trial, std::initializer_list<double> gaps) {
  constexpr double kLeast = 0.5;           // [N] of the weakest device.
  constexpr double kRate = 50;             // [N/s] of a soft start.
  constexpr double kFirst = kRate * 2e-3;  // [N]: what a late write counts for.
  for (const double gap : gaps) {
    SCOPED_TRACE(gap);
    trial->Press();
    ASSERT_GT(trial->force(), kLeast) << "it presses";
    trial->StandStill(gap);
    double before = trial->Tick();
    EXPECT_LE(before, kFirst + 1e-9);
    for (int i = 0; i * trial->period_s() < 0.05; ++i) {
      const double force = trial->Tick();
      ASSERT_LE(force - before, kRate * trial->period_s() + 1e-9) << i;
      before = force;
    }
  }
}

class FloorTrialRateTest : public ::testing::TestWithParam<double> {};

TEST_P(FloorTrialRateTest, ForceStartsFromZeroAfterEveryGap) {  // N6
  PressedTrial trial("plugin", GetParam());
  ExpectSoftStarts(&trial, {0.021, 0.05, 0.2, 1.0, 5.0});
}

INSTANTIATE_TEST_SUITE_P(Rates, FloorTrialRateTest,
                         ::testing::Values(1000.0, 2000.0, 4000.0, 8000.0));

class FloorTrialDriverTest : public ::testing::TestWithParam<const char*> {};

TEST_P(FloorTrialDriverTest, ForceStartsFromZeroAfterEveryGap) {
  PressedTrial trial(GetParam(), 1000);
  if (std::string(GetParam()) == "virtuose") {
    trial.Run(4);  // Its relays close first.
  }
  ExpectSoftStarts(&trial, {0.03, 0.3});
}

INSTANTIATE_TEST_SUITE_P(Drivers, FloorTrialDriverTest,
                         ::testing::Values("openhaptics", "forcedimension", "virtuose", "haply",
                                           "network", "plugin"),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace hvas::app
