#include "simulation/haptic_loop.h"

#include <cmath>

#include "base/clock.h"
#include "simulation/flight_recorder.h"
#include "simulation/tick_log.h"
#include "spatial/rounding.h"

namespace hvas::simulation {
namespace {

/** A tick after which the last second is worth keeping. */
bool IsFault(const device::DeviceState& before, std::uint32_t actions_before,
             const device::DeviceState& device, const haptics::TickOutput& out) noexcept {
  // What the flight recorder is for.
  constexpr std::uint32_t kFaults = haptics::kGateNotFinite | haptics::kGateLateModel |
                                    haptics::kGateLostClient | haptics::kGateNoDevice |
                                    haptics::kGateStopped | haptics::kGateBuzz |
                                    haptics::kGateKick | haptics::kGateStalled;
  const std::uint32_t begun = out.gate_actions & ~actions_before;
  return (begun & kFaults) != 0 ||
         (device.condition != before.condition && device::IsFault(device.condition));
}

}  // namespace

std::int64_t CalcPeriod(const Simulation& simulation) {
  return std::llround(1e9 * simulation.options().dt);
}

HapticLoop::HapticLoop(const Execution& execution, ExecutionReport* report)
    : execution_(execution),
      haptics_(execution.simulation->haptics()),
      report_(report),
      period_ns_(CalcPeriod(*execution.simulation)),
      shedder_(period_ns_) {
  for (std::size_t i = 0; i < hands_.size() && execution.hands[i] != nullptr; ++i) {
    ++hand_count_;
    hands_[i].person = execution.hands[i];
    haptics::TickOutput& last = hands_[i].last;
    last.workspace = haptics_.options(i).workspace.mapping;
    last.X_WH = last.workspace.X_WD;
  }
}

OperatorInput HapticLoop::MakeInput(Hand* hand, std::int64_t t_ns,
                                    std::int64_t period_ns) noexcept {
  const haptics::TickOutput& last = hand->last;
  OperatorInput input;
  input.t_ns = t_ns;
  input.dt = 1e-9 * static_cast<double>(period_ns);
  input.F_H_D = last.F_H_D;
  input.hears_seated = last.state == haptics::HoldState::kSeated;
  input.hears_capture = last.state == haptics::HoldState::kCaptured &&
                        hand->state_before != haptics::HoldState::kCaptured;
  input.sees_part = last.occurrence.is_valid();
  input.X_WD = last.X_WD;
  input.X_WH = last.X_WH;
  input.workspace = last.workspace;
  hand->state_before = last.state;
  return input;
}

std::int64_t HapticLoop::Tick(std::int64_t wake_up_ns) noexcept {
  std::int64_t compute_ns = 0;
  for (std::size_t i = 0; i < hand_count_; ++i) {
    compute_ns += TickHand(i, wake_up_ns);
  }
  report_->compute.Add(compute_ns);
  report_->overruns += compute_ns > period_ns_ ? 1 : 0;
  if (execution_.sheds_load) {
    ++report_->ticks_at_level[static_cast<std::size_t>(shedder_.level())];
    haptics_.SetEffortLevel(shedder_.Update(compute_ns));
  }
  ++report_->ticks;
  t_ns_ += period_ns_;
  return compute_ns;
}

std::int64_t HapticLoop::TickHand(std::size_t i, std::int64_t wake_up_ns) noexcept {
  Hand& hand = hands_[i];
  device::DeviceState device = hand.person->Step(MakeInput(&hand, t_ns_, period_ns_));
  device.t_ns = t_ns_;
  device.X_DH = spatial::Rounded(device.X_DH);
  device.V_DH = spatial::Rounded(device.V_DH);
  const std::int64_t since_write_ns = hand.pace.Begin(NowNs());
  const std::int64_t start_ns = ThreadCpuNs();
  hand.last = haptics_.Tick(i, device, since_write_ns);
  const std::int64_t compute_ns = ThreadCpuNs() - start_ns;
  hand.person->Apply(hand.pace.Admit(hand.last.F_H_D, NowNs()));
  report_->slowest.Add({t_ns_, i, compute_ns, hand.last.occurrence, hand.last.state,
                        hand.last.points_tested, hand.last.contact_count});
  report_->contact_limits.Add(hand.last);
  if (execution_.log != nullptr) {
    execution_.log->SetComputeOfLast(compute_ns);
  }
  KeepFlight(&hand, {device, hand.last, wake_up_ns, compute_ns, shedder_.level(), i});
  if (execution_.sink != nullptr) {
    execution_.sink->OnTick(i, device, hand.last);
  }
  return compute_ns;
}

void HapticLoop::KeepFlight(Hand* hand, FlightTick tick) noexcept {
  const bool is_fault = IsFault(hand->device_before, hand->actions_before, tick.device, tick.out);
  hand->device_before = tick.device;
  hand->actions_before = tick.out.gate_actions;
  if (execution_.flight == nullptr) {
    return;
  }
  if (!execution_.is_live) {  // the same bytes every time
    tick.wake_up_ns = 0;
    tick.compute_ns = 0;
  }
  execution_.flight->Keep(tick);
  if (is_fault) {
    execution_.flight->Trigger();
  }
}

}  // namespace hvas::simulation
