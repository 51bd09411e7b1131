#include "app/devices/device_trial.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "app/devices/devices_report.h"
#include "app/devices/latency_json.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "base/clock.h"
#include "base/histogram.h"
#include "base/triple_buffer.h"
#include "device/opened_device.h"
#include "haptics/coupling_rule.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"
#include "simulation/device_session.h"
#include "simulation/realtime_thread.h"

namespace hvas::app {
namespace {

/** What the loop tells whoever watches. */
struct TrialState {
  device::DeviceState device;
  spatial::Wrench F_H_D;
  std::uint32_t gate_actions{0};
};

/** A horizontal floor through D's origin, felt through passivity control and the gate. */
class FloorTrial {
 public:
  FloorTrial(device::Device* device, double rate_hz)
      : device_(device),
        up_D_(device->info().profile.q_UD.conjugate() * Vec3::UnitZ()),
        gains_(haptics::ChooseCoupling(device->info().profile, 1, 1 / rate_hz)),
        passivity_(haptics::MakePassivityController(device->info().profile, 1 / rate_hz)),
        gate_(haptics::MakeSafetyLimits(device->info().profile)) {}

  /** @param dt  Since the last tick began [s]: what is late must not look like a leap. */
  void Tick(double dt) noexcept {
    TrialState& state = states_.back();
    state.device = simulation::ReadDevice(device_);
    const device::DeviceState& now = state.device;
    const double depth = -up_D_.dot(now.X_DH.p());
    spatial::Wrench F;
    if (now.is_valid && depth > 0) {
      F.f = std::max(0.0, gains_.k_lin * depth - gains_.b_lin * up_D_.dot(now.V_DH.v)) * up_D_;
    }
    F = passivity_.Limit(now.X_DH, F, std::numeric_limits<double>::quiet_NaN(), 0, dt);
    state.F_H_D = gate_.Pass(haptics::MakeGateInput(now, F, dt, &last_sample_ns_));
    passivity_.Write(state.F_H_D);
    device_->Write(state.F_H_D);
    state.gate_actions = gate_.actions();
    states_.Publish();
  }

  /** The newest state, for one other thread. */
  const TrialState& ReadState() {
    states_.Update();
    return states_.value();
  }

  [[nodiscard]] const haptics::CouplingGains& gains() const { return gains_; }

 private:
  device::Device* device_;
  std::int64_t last_sample_ns_{0};
  Vec3 up_D_;
  haptics::CouplingGains gains_;
  haptics::PassivityController passivity_;
  haptics::SafetyGate gate_;
  TripleBuffer<TrialState> states_;
};

/** The hand of an emulated device: slowly down into the floor and up again, in two seconds. It
 takes the handle anew each time, as a person would after an alarm. */
void MoveEmulatedHand(device::EmulatedDevice* device, double t_s) {
  constexpr double kDepth = 0.012;            // [m] that it would go without the floor
  constexpr double kTurn = std::numbers::pi;  // [rad/s]: down and up in 2 s.
  const Vec3 down_D = device->profile().q_UD.conjugate() * -Vec3::UnitZ();
  device::HandIntent hand;
  hand.X_DR = spatial::Pose(Vec3(0.5 * kDepth * (1 - std::cos(kTurn * t_s)) * down_D));
  hand.V_DR.v = 0.5 * kDepth * kTurn * std::sin(kTurn * t_s) * down_D;
  // The button is held so much of each 2 s, so that both ways are seen.
  constexpr double kHoldTime = 1.8;
  hand.buttons = std::fmod(t_s, 2) < kHoldTime ? 1 : 0;
  device->SetHand(hand);
}

void PrintState(const TrialState& state, const device::Device& device, double t_s) {
  const Vec3 p_mm = 1e3 * state.device.X_DH.p();
  std::string text = fmt::format("{:6.1f} s  at {:7.2f} {:7.2f} {:7.2f} mm  force {:5.2f} N  {}",
                                 t_s, p_mm.x(), p_mm.y(), p_mm.z(), state.F_H_D.f.norm(),
                                 device::ToString(state.device.condition));
  for (const haptics::GateAction action : haptics::ListNewActions(0, state.gate_actions)) {
    text += fmt::format("; {}", haptics::ToString(action));
  }
  if (state.device.condition != device::Condition::kReady) {
    text += fmt::format("; {}", device.Explain(state.device));
  }
  fmt::print("{}", Fold(text));
  std::fflush(stdout);
}

}  // namespace

int RunDeviceTrial(const DeviceTrialOptions& options) {
  auto opened = device::OpenAnyDevice(options.address, true);
  if (!opened) {
    return ReportFailure(opened.error());
  }
  device::Device& device = *opened->device;
  fmt::print("{}", DescribeDevice(device.info()));
  FloorTrial trial(&device, options.rate_hz);
  fmt::print("A horizontal floor of {:.0f} N/m is in the middle of the workspace. Press on it.\n",
             trial.gains().k_lin);
  std::atomic<bool> is_stopping{false};
  simulation::RealtimeGrant grant;
  LatencyHistogram wake_up;
  LatencyHistogram work;
  std::thread loop([&] {
    grant = simulation::RequestRealtime();
    simulation::Pacer pacer(std::llround(1e9 / options.rate_hz));
    std::int64_t last_ns = MonotonicNs();
    while (!is_stopping.load(std::memory_order_relaxed)) {
      wake_up.Add(pacer.Wait());
      const std::int64_t start_ns = MonotonicNs();
      trial.Tick(1e-9 * static_cast<double>(start_ns - last_ns));
      last_ns = start_ns;
      work.Add(MonotonicNs() - start_ns);
    }
  });
  constexpr double kStep = 0.002;     // [s]: the eye and the hand follow no faster. A choice.
  constexpr int kStepsPerLine = 500;  // A line a second.
  simulation::Pacer pacer(std::llround(1e9 * kStep));
  for (int i = 0; i * kStep < options.seconds; ++i) {
    if (opened->emulator != nullptr) {
      MoveEmulatedHand(&opened->emulator->device(), i * kStep);
    }
    if (i % kStepsPerLine == kStepsPerLine / 2) {
      PrintState(trial.ReadState(), device, i * kStep);
    }
    (void)pacer.Wait();
  }
  is_stopping = true;
  loop.join();
  simulation::ReleaseRealtime();
  fmt::print("{}", Fold(grant.ToString()));
  PrintLatencyHistogram("wake-up after the deadline", wake_up);
  PrintLatencyHistogram("reading, computing and writing", work);
  return 0;
}

}  // namespace hvas::app
