#include "simulation/device_session.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulation/test/direct_emulator.h"
#include "simulation/test/session.h"
#include "simulation/test/small_products.h"

namespace hvas::simulation {
namespace {

using testing::DirectDevice;
using testing::DirectEmulator;
using testing::PegInBlockModel;
using testing::Watch;

class Trace final : public Sink {
 public:
  explicit Trace(Sink* next) : next_(next) {}

  void OnTick(const device::DeviceState& device, const haptics::TickOutput& out) noexcept override {
    if (std::getenv("TRACE") && double(device.t_ns) > 1e6 * std::atof(std::getenv("TRACE")) &&
        double(device.t_ns) < 1e6 * std::atof(std::getenv("TRACE")) + 40e6)
      std::printf(
          "%6.3f p %8.3f %8.3f %8.3f v %6.3f %6.3f %6.3f want %6.3f %6.3f %6.3f F %6.3f %6.3f "
          "%6.3f D %8.3f %8.3f %8.3f st %d c %d\n",
          1e-9 * double(device.t_ns), 1e3 * device.X_DH.p().x(), 1e3 * device.X_DH.p().y(),
          1e3 * device.X_DH.p().z(), device.V_DH.v.x(), device.V_DH.v.y(), device.V_DH.v.z(),
          out.F_felt_W.f.x(), out.F_felt_W.f.y(), out.F_felt_W.f.z(), out.F_H_D.f.x(),
          out.F_H_D.f.y(), out.F_H_D.f.z(), 1e3 * out.X_WD.p().x(), 1e3 * out.X_WD.p().y(),
          1e3 * out.X_WD.p().z(), int(out.state), out.contact_count);
    next_->OnTick(device, out);
  }

  void OnEvent(const SimulationEvent& event) override { next_->OnEvent(event); }

  Sink* next_;
};

/** A person with an emulated device in the hand, and a model. */
struct DeviceSession {
  DeviceSession(std::shared_ptr<const Model> model, const std::string& profile_id,
                std::uint64_t seed = 1, const RenderOptions& render = {})
      : emulator(device::FindProfile(profile_id)->profile),
        device(&emulator.device()),
        options(MakeTickOptions(device.info(), *model, render)),
        simulation(model, options),
        person({}, seed, StartOfHand(*model)),
        hand(&person, &emulator, &device, false),
        run(&simulation, &person, &watch) {}

  ExecutionReport Run(double limit_s) {
    Execution execution;
    execution.simulation = &simulation;
    execution.hand = &hand;
    Trace trace(&run);
    execution.sink = &trace;
    execution.advance = [this] { run.Advance(); };
    execution.is_done = [this] { return run.is_done(); };
    execution.limit_ns = static_cast<std::int64_t>(1e9 * limit_s);
    return RunLockstep(execution);
  }

  DirectEmulator emulator;
  DirectDevice device;
  haptics::TickOptions options;
  Simulation simulation;
  SimulatedPerson person;
  PersonAtDevice hand;
  Watch watch;
  AssemblyRun run;
};

TEST(DeviceSessionTest, APersonAssemblesThroughADevice) {  // N8
  for (const char* profile : {"touch_x", "touch", "sigma7", "virtuose", "inverse3"}) {
    SCOPED_TRACE(profile);
    DeviceSession session(PegInBlockModel(), profile);
    const ExecutionReport report = session.Run(60);
    ASSERT_EQ(session.run.results().size(), 2u);
    EXPECT_TRUE(session.run.results()[1].is_seated) << session.run.results()[1].reason;
    EXPECT_TRUE(session.watch.is_finite);
    const device::DeviceProfile& limits = session.device.info().profile;
    EXPECT_LE(session.watch.largest_force, limits.max_force + 1e-9);
    const auto truth = session.emulator.device().truth();
    std::printf("%s %.1f s, peak %.2f N, work %.4f J, turning %.4f J\n", profile,
                1e-9 * double(report.session_ns), session.watch.largest_force, truth.work,
                truth.turning_work);
    for (const SimulationEvent& event : session.watch.events) {
      if (event.kind == SimulationEvent::Kind::kSafety) {
        for (const auto action : haptics::ListNewActions(0, event.gate_actions)) {
          std::printf("  %.3f %s %s\n", 1e-9 * double(event.t_ns), haptics::ToString(action),
                      haptics::ToString(event.state));
        }
      }
    }
  }
}

}  // namespace
}  // namespace hvas::simulation
