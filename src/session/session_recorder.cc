#include "session/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "haptics/safety_gate.h"
#include "haptics/write_pace.h"
#include "session/command_json.h"
#include "session/flight_json.h"
#include "session/recorded_model.h"

namespace hvas::session {
namespace {

const char* ToString(simulation::SimulationEvent::Kind kind) {
  switch (kind) {
    case simulation::SimulationEvent::Kind::kTaken:
      return "taken";
    case simulation::SimulationEvent::Kind::kState:
      return "state";
    case simulation::SimulationEvent::Kind::kDropped:
      return "dropped";
    case simulation::SimulationEvent::Kind::kSafety:
      return "safety";
    case simulation::SimulationEvent::Kind::kDevice:
      return "device";
    case simulation::SimulationEvent::Kind::kEffort:
      return "effort";
    case simulation::SimulationEvent::Kind::kEnergy:
      return "energy";
  }
  return "unknown";
}

nlohmann::ordered_json ToJson(const haptics::PassivityAccount& account) {
  return {{"in_j", account.in},
          {"out_j", account.out},
          {"credited_j", account.credited},
          {"withheld_j", account.withheld}};
}

std::uint32_t FlagsOf(const device::DeviceState& device) noexcept {
  return (device.is_gripping ? record::kDeviceGripping : 0u) |
         (device.is_clutching ? record::kDeviceClutching : 0u) |
         (device.is_valid ? 0u : record::kDeviceNotValid);
}

std::uint32_t StatusOf(const haptics::TickOutput& out) noexcept {
  return out.gate_actions | (out.is_truncated ? kTruncatedStatus : 0u) |
         (out.context.is_stopped ? kStoppedStatus : 0u) | (out.is_crowded ? kCrowdedStatus : 0u);
}

}  // namespace

record::TickRecord MakeTickRecord(std::size_t hand, const device::DeviceState& device,
                                  const haptics::TickOutput& out, std::uint32_t commands) noexcept {
  record::TickRecord tick;
  tick.hand = static_cast<std::uint8_t>(hand);
  tick.t_ns = device.t_ns;
  tick.device_pose = device.X_DH;
  tick.device_twist = device.V_DH;
  tick.device_flags = FlagsOf(device);
  tick.sample_ns = device.sample_ns;
  tick.device_buttons = device.buttons;
  tick.device_condition = static_cast<std::uint8_t>(device.condition);
  tick.vendor_code = device.vendor_code;
  tick.device_grip = device.grip;
  tick.model_age_ns = out.context.model_age_ns;
  tick.client_age_ns = device.client_age_ns;
  tick.effort_level = static_cast<std::uint8_t>(out.context.effort_level);
  tick.status = StatusOf(out);
  tick.X_WH = out.X_WT;
  tick.X_WD = out.X_WD;
  tick.F_true_W = out.F_true_W;
  tick.F_felt_W = out.F_H_W;
  tick.held = out.occurrence.value();
  tick.state = static_cast<std::uint8_t>(out.state);
  tick.contact_count = static_cast<std::uint16_t>(
      std::clamp(out.contact_count, 0, int{std::numeric_limits<std::uint16_t>::max()}));
  tick.depth = out.insertion_depth;
  tick.deepest = out.deepest;
  if (out.contact_count > 0) {
    tick.contacts[0].p_WC = out.p_WC.cast<float>();
    tick.contacts[0].nhat_W = out.f_C_W.normalized().cast<float>();
    tick.contacts[0].distance = static_cast<float>(out.deepest);
  }
  tick.commands = commands;
  return record::Rounded(tick);
}

SessionRecorder::SessionRecorder(record::Recorder* recorder, const simulation::Model& model)
    : recorder_(recorder) {
  AttachModel(model, recorder);
}

void SessionRecorder::Begin(simulation::Simulation* simulation) {
  haptics_ = &simulation->haptics();
  start_ns_ = t_ns();
  period_ns_ = std::llround(1e9 * simulation->options().dt);
  told_ = simulation->physics().parts();
  Beginning beginning;
  beginning.parts = told_;
  for (std::size_t hand = 0; hand < simulation->hand_count(); ++hand) {
    beginning.hands.push_back(simulation->options(hand));
  }
  recorder_->AddCommand({start_ns_, 0, kBeginKind, MakeBeginningJson(beginning)});
  simulation->physics().SetCommandListener(
      [this](const simulation::GivenCommand& given) { OnCommand(given); });
}

void SessionRecorder::OnCommand(const simulation::GivenCommand& given) {
  record::Command command = MakeCommand(given, told_);
  command.t_ns += start_ns_;
  recorder_->AddCommand(std::move(command));
  told_ = given.parts;
}

void SessionRecorder::OnTick(std::size_t hand, const device::DeviceState& device,
                             const haptics::TickOutput& out) noexcept {
  record::TickRecord tick = MakeTickRecord(hand, device, out, haptics_->applied_commands());
  tick.t_ns += start_ns_;
  t_ns_.store(tick.t_ns + period_ns_, std::memory_order_relaxed);
  recorder_->AddTick(tick);
}

void SessionRecorder::OnEvent(const simulation::SimulationEvent& event) {
  nlohmann::ordered_json details;
  details["hand"] = event.hand;
  details["state"] = haptics::ToString(event.state);
  if (event.kind == simulation::SimulationEvent::Kind::kDropped) {
    details["seated"] = event.was_seated;
    const Vec3& p = event.X_WB.p();
    const Quat& q = event.X_WB.q();
    details["position_m"] = {p.x(), p.y(), p.z()};
    details["rotation_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
    details["path_m"] = event.metrics.path;
    details["peak_true_n"] = event.metrics.peak_true;
    details["peak_felt_n"] = event.metrics.peak_felt;
  } else if (event.kind == simulation::SimulationEvent::Kind::kSafety) {
    nlohmann::ordered_json& reasons = details["reasons"] = nlohmann::ordered_json::array();
    for (const haptics::GateAction action : haptics::ListNewActions(0, event.gate_actions)) {
      reasons.push_back(haptics::ToString(action));
    }
  } else if (event.kind == simulation::SimulationEvent::Kind::kDevice) {
    details["condition"] = device::ToString(event.condition);
    details["vendor_code"] = event.vendor_code;
  } else if (event.kind == simulation::SimulationEvent::Kind::kEffort) {
    details["level"] = event.effort_level;
  } else if (event.kind == simulation::SimulationEvent::Kind::kEnergy) {
    details["force"] = ToJson(event.energy);
    details["torque"] = ToJson(event.turning_energy);
  }
  recorder_->AddEvent(
      {start_ns_ + event.t_ns, ToString(event.kind), event.occurrence.value(), details.dump()});
}

void SessionRecorder::OnFlight(const std::vector<simulation::FlightTick>& ticks) {
  std::vector<simulation::FlightTick> in_session = ticks;
  for (simulation::FlightTick& tick : in_session) {
    tick.device.t_ns += start_ns_;
  }
  recorder_->AddEvent({in_session.back().device.t_ns, "flight",
                       in_session.back().out.occurrence.value(), MakeFlightJson(in_session)});
}

device::DeviceState MakeDeviceState(const record::TickRecord& tick) {
  device::DeviceState device;
  device.t_ns = tick.t_ns;
  device.sample_ns = tick.sample_ns;
  device.X_DH = tick.device_pose;
  device.V_DH = tick.device_twist;
  device.is_gripping = (tick.device_flags & record::kDeviceGripping) != 0;
  device.is_valid = (tick.device_flags & record::kDeviceNotValid) == 0;
  device.is_clutching = (tick.device_flags & record::kDeviceClutching) != 0;
  device.buttons = tick.device_buttons;
  device.grip = tick.device_grip;
  device.condition = static_cast<device::Condition>(tick.device_condition);
  device.vendor_code = tick.vendor_code;
  device.client_age_ns = tick.client_age_ns;
  return device;
}

haptics::TickContext MakeTickContext(const record::TickRecord& tick) {
  haptics::TickContext context;
  context.model_age_ns = tick.model_age_ns;
  context.is_stopped = (tick.status & kStoppedStatus) != 0;
  context.effort_level = tick.effort_level;
  context.since_write_ns =
      (tick.status & haptics::kGateStalled) != 0 ? haptics::WritePace::kUnknownNs : 0;
  return context;
}

}  // namespace hvas::session
