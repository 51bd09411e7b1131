#include "app/devices/device_trial.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <thread>

#include <fmt/format.h>

#include "app/devices/devices_report.h"
#include "app/devices/floor_trial.h"
#include "app/devices/latency_json.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "base/histogram.h"
#include "base/loop_clock.h"
#include "device/opened_device.h"
#include "haptics/safety_gate.h"
#include "simulation/realtime_thread.h"

namespace hvas::app {
namespace {

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
  const LoopClock& clock = MachineClock();
  FloorTrial trial(&device, options.rate_hz, clock);
  fmt::print("A horizontal floor of {:.0f} N/m is in the middle of the workspace. Press on it.\n",
             trial.gains().k_lin);
  std::atomic<bool> is_stopping{false};
  simulation::RealtimeGrant grant;
  LatencyHistogram wake_up;
  LatencyHistogram work;
  std::thread loop([&] {
    grant = simulation::RequestRealtime();
    simulation::Pacer pacer(std::llround(1e9 / options.rate_hz));
    while (!is_stopping.load(std::memory_order_relaxed)) {
      wake_up.Add(pacer.Wait());
      const std::int64_t start_ns = clock.NowNs();
      trial.Tick();
      work.Add(clock.NowNs() - start_ns);
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
