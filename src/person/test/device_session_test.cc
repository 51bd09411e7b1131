#include "simulation/device_session.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "person/person_at_device.h"
#include "person/test/direct_emulator.h"
#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using simulation::testing::PegInBlockModel;
using testing::DirectDevice;
using testing::DirectEmulator;
using testing::Watch;

/** A person with an emulated device in the hand, and a model. */
struct DeviceSession {
  DeviceSession(std::shared_ptr<const simulation::Model> model, const std::string& profile_id,
                std::uint64_t seed = 1, const simulation::RenderOptions& render = {})
      : emulator(device::FindProfile(profile_id)->profile),
        device(&emulator.device()),
        options(simulation::MakeTickOptions(device.info(), *model, render)),
        simulation(model, options),
        person(MakePersonOptions(options), seed, simulation::StartOfHand(*model)),
        hand(&person, &emulator, &device, false),
        run(&simulation, &person, &watch) {}

  [[nodiscard]] simulation::Execution MakeExecution(double limit_s) {
    return run.MakeExecution(&hand, limit_s);
  }

  simulation::ExecutionReport Run(double limit_s) {
    return simulation::RunLockstep(MakeExecution(limit_s));
  }

  DirectEmulator emulator;
  DirectDevice device;
  haptics::TickOptions options;
  simulation::Simulation simulation;
  SimulatedPerson person;
  PersonAtDevice hand;
  Watch watch;
  simulation::AssemblyRun run;
};

TEST(DeviceSessionTest, APersonAssemblesThroughADevice) {  // N8
  for (const char* profile : {"touch_x", "touch", "sigma7", "virtuose", "inverse3"}) {
    SCOPED_TRACE(profile);
    DeviceSession session(PegInBlockModel(), profile);
    (void)session.Run(60);
    ASSERT_EQ(session.run.results().size(), 2u);
    EXPECT_TRUE(session.run.results()[1].is_seated) << session.run.results()[1].reason;
    EXPECT_TRUE(session.watch.is_finite);
    EXPECT_LE(session.watch.largest_force, session.device.info().profile.max_force + 1e-9);
    for (const simulation::SimulationEvent& event : session.watch.events) {
      constexpr std::uint32_t kAlarms = haptics::kGateKick | haptics::kGateBuzz |
                                        haptics::kGateNotFinite | haptics::kGateLateModel;
      EXPECT_EQ(event.gate_actions & kAlarms, 0u) << "at " << event.t_ns << " ns";
    }
  }
}

// The handle comes to the border on the way there, and has little room left to press into.
TEST(DeviceSessionTest, APressFitGoesInFromTheBorderOfADevice) {
  const auto& model = simulation::testing::PressedPegModel();
  for (const char* profile : {"sigma7", "inverse3", "network", "touch"}) {
    SCOPED_TRACE(profile);
    DeviceSession session(model, profile);
    (void)session.Run(30);
    const simulation::PartResult& peg = session.run.results()[1];
    EXPECT_TRUE(peg.is_seated) << peg.reason;
    EXPECT_GT(peg.fit_true, 300) << "there was something to press";
    EXPECT_LE(session.watch.largest_force, session.device.info().profile.max_force + 1e-9);
  }
}

TEST(DeviceSessionTest, HabitsAndInertiaFollowTheStrengthOfADevice) {
  const auto model = PegInBlockModel();
  const auto make = [&](const char* id) {
    DeviceSession session(model, id);
    return std::pair{MakePersonOptions(session.options), session.options.max_virtual_mass};
  };
  const PersonOptions alone;
  const auto [weak, weak_mass] = make("network");
  EXPECT_LT(weak.push_limit, alone.first_push);
  EXPECT_LT(weak.first_push, weak.push_limit) << "what is tried first can be felt in full";
  EXPECT_LT(weak_mass, 0.5);
  const auto [strong, strong_mass] = make("virtuose");
  EXPECT_GT(strong.push_limit, 20);
  EXPECT_EQ(strong.unguided_limit, alone.unguided_limit) << "what lies loose needs no force";
  EXPECT_EQ(strong_mass, haptics::TickOptions().max_virtual_mass);
}

TEST(DeviceSessionTest, TheSameSeedGivesTheSameBytes) {
  std::string digests[2];
  for (std::string& digest : digests) {
    DeviceSession session(PegInBlockModel(), "touch_x", 3);
    (void)session.Run(10);
    digest = session.watch.Hex();
  }
  EXPECT_EQ(digests[0], digests[1]);
}

TEST(DeviceSessionTest, X4RunsAtTheRateOfTheDevice) {  // 1 to 8 kHz
  for (const double rate_hz : {2000.0, 4000.0, 8000.0}) {
    SCOPED_TRACE(rate_hz);
    simulation::RenderOptions render;
    render.rate_hz = rate_hz;
    DeviceSession session(PegInBlockModel(), "sigma7", 1, render);
    const simulation::ExecutionReport report = session.Run(20);
    EXPECT_NEAR(static_cast<double>(report.ticks) / (1e-9 * static_cast<double>(report.session_ns)),
                rate_hz, 1e-6 * rate_hz);
    EXPECT_TRUE(session.run.results()[1].is_seated) << session.run.results()[1].reason;
  }
}

/** Looks at what the motors give after something has happened at a time. */
class AfterFault final : public simulation::Sink {
 public:
  AfterFault(simulation::Sink* next, device::EmulatedDevice* device, device::Fault fault,
             std::int64_t at_ns)
      : next_(next), device_(device), fault_(fault), at_ns_(at_ns) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override {
    const double force = device_->truth().F_H_D.f.norm();
    if (device.t_ns == at_ns_) {
      force_before = force;
      device_->SetFault(fault_);
    }
    if (device.t_ns == at_ns_ + kDuration_ns) {
      device_->SetFault(device::Fault::kNone);
    }
    const std::int64_t since_ns = device.t_ns - at_ns_;
    if (since_ns >= 5'000'000 && since_ns < kDuration_ns) {
      is_decaying = is_decaying && force <= force_last_ + 1e-9;
    }
    if (since_ns == 20'000'000) {
      force_after = force;
    }
    if (since_ns > kDuration_ns + 1'000'000'000) {
      force_later = std::max(force_later, force);
    }
    force_last_ = force;
    next_->OnTick(hand, device, out);
  }

  void OnEvent(const simulation::SimulationEvent& event) override { next_->OnEvent(event); }

  double force_before{0};
  double force_after{0};
  double force_later{0};
  bool is_decaying{true};

 private:
  static constexpr std::int64_t kDuration_ns = 60'000'000;

  simulation::Sink* next_;
  device::EmulatedDevice* device_;
  device::Fault fault_;
  std::int64_t at_ns_;
  double force_last_{0};
};

TEST(DeviceSessionTest, AFaultWhileAPartIsHeldTakesTheForceAwayAndItComesBack) {  // N6
  for (const device::Fault fault : device::kFaults) {
    if (fault == device::Fault::kSignFlipped) {
      continue;  // what a kick is, and how fast it is found: haptics' kick_test
    }
    SCOPED_TRACE(device::ToString(fault));
    DeviceSession session(PegInBlockModel(), "touch_x");
    AfterFault sink(&session.run, &session.emulator.device(), fault, 1'800'000'000);
    simulation::Execution execution = session.MakeExecution(60);
    execution.sink = &sink;
    simulation::FlightRecorder flight(1000);
    execution.flight = &flight;
    (void)simulation::RunLockstep(execution);
    EXPECT_GT(sink.force_before, 0.1) << "something was felt before";
    EXPECT_TRUE(sink.is_decaying);
    EXPECT_EQ(sink.force_after, 0);
    EXPECT_GT(sink.force_later, 0.1) << "and again later";
    EXPECT_TRUE(session.run.results()[1].is_seated) << session.run.results()[1].reason;
  }
}

TEST(DeviceSessionTest, ADeadPhysicsLoopTakesTheForceAway) {  // N6: late model
  DeviceSession session(PegInBlockModel(), "touch_x");
  simulation::Execution execution = session.MakeExecution(4);
  std::int64_t dead_since_ns = 0;
  execution.is_physics_late = [&](std::int64_t t_ns) {
    dead_since_ns = t_ns > 1'600'000'000 ? t_ns : 0;
    return dead_since_ns > 0;
  };
  (void)simulation::RunLockstep(execution);
  EXPECT_EQ(session.emulator.device().truth().F_H_D.f.norm(), 0);
}

TEST(DeviceSessionTest, WhoeverStopsTheForcesStopsThem) {  // N6: emergency stop in software
  DeviceSession session(PegInBlockModel(), "touch_x");
  simulation::Execution execution = session.MakeExecution(3);
  execution.advance = [&] {
    session.run.Advance();
    session.simulation.StopForces(session.emulator.device().truth().t_ns > 1'600'000'000);
  };
  (void)simulation::RunLockstep(execution);
  EXPECT_EQ(session.emulator.device().truth().F_H_D.f.norm(), 0);
  bool was_told = false;
  for (const simulation::SimulationEvent& event : session.watch.events) {
    was_told = was_told || (event.gate_actions & haptics::kGateStopped) != 0;
  }
  EXPECT_TRUE(was_told);
}

TEST(DeviceSessionTest, SaysHowADeviceIsRenderedTo) {  // N8: no lies about what it cannot do
  const auto model = PegInBlockModel();
  device::DeviceInfo info;
  info.profile = device::FindProfile("touch")->profile;
  info.capabilities.force_axes = 3;
  info.capabilities.senses_rotation = true;
  const haptics::TickOptions touch = simulation::MakeTickOptions(info, *model, {});
  EXPECT_TRUE(touch.controls_passivity);
  EXPECT_GT(touch.p_HG.norm(), 0);
  EXPECT_LE(touch.coupling.k_lin, 0.5 * info.profile.max_stiffness);
  const std::string about_torque = simulation::DescribeRendering(info, touch).front();
  EXPECT_NE(about_torque.find("no torques"), std::string::npos) << about_torque;

  constexpr int kMostTicks = haptics::PassivityChannel::kMaxDelay;
  for (const int ticks : {kMostTicks, kMostTicks + 1}) {
    haptics::TickOptions late = touch;
    late.device.delay = ticks * late.dt;
    const std::vector<std::string> notes = simulation::DescribeRendering(info, late);
    EXPECT_EQ(std::any_of(notes.begin(), notes.end(),
                          [](const std::string& note) {
                            return note.find("its delay is 31 ticks") != std::string::npos;
                          }),
              ticks > kMostTicks);
  }

  info.capabilities.force_axes = 0;
  const haptics::TickOptions mouse = simulation::MakeTickOptions(info, *model, {});
  EXPECT_EQ(mouse.limits->max_force, 0);
  EXPECT_GT(mouse.device.max_force, 1) << "parts resist on the screen all the same";
  const std::string about_force = simulation::DescribeRendering(info, mouse).front();
  EXPECT_NE(about_force.find("no forces"), std::string::npos) << about_force;
}

}  // namespace
}  // namespace hvas::person
