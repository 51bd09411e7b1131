// Is a device ever given energy, force or a step of force that it should not be, whatever happens
// around the loop? A simulated person assembles one part of the product after the other (each run
// one, the parts before it in place) with an emulated device of each driver in the hand, through
// the real driver. Meanwhile the device's forces arrive late, by 0 to 20 ms, which the session
// knows, and the physics loop comes late or drops out for up to 0.4 s. Prints a row for each
// driver; exit status 1 when a run breaks a limit. Times are virtual: the same seed, the same rows.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "assembly/assembly_setup.h"
#include "base/random.h"
#include "device/driver.h"
#include "device/emulation/emulator.h"
#include "haptics/passivity_controller.h"
#include "load_model.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"

namespace hvas {
namespace {

using simulation::Model;

struct StormOptions {
  std::string file;
  int runs{1000};
  int first_seed{1};
  double limit_s{12};
  double longest_delay_ms{20};
};

/** What came of the forces of one run, in newtons and joules. */
struct Outcome {
  bool is_seated{false};
  double largest_share{0};     ///< Of the profile's peak, at the motors.
  double largest_step{0};      ///< From tick to tick, over what is allowed.
  double energy_excess{-1e9};  ///< Work of the motors on the hand, less the bound [J].
  double turning_excess{-1e9};
  double net_work{0};  ///< [J]
  bool is_finite{true};
};

/** Watches what the gate lets through. */
class ForceWatch final : public simulation::Sink {
 public:
  explicit ForceWatch(const haptics::TickOptions& options) : options_(options) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override {
    (void)hand;
    (void)device;
    constexpr std::uint32_t kCuts = haptics::kGateNoDevice | haptics::kGateNotHeld |
                                    haptics::kGateStopped | haptics::kGateBuzz | haptics::kGateKick;
    const haptics::SafetyLimits& limits = *options_.limits;
    const bool is_cut = (out.gate_actions & kCuts) != 0;
    const double cut = is_cut ? limits.max_force / limits.cut_time : 0.0;
    const double allowed = options_.dt * std::max(limits.max_force_rate, cut);
    const double step = (out.F_H_D.f - last_.f).norm();
    outcome.largest_step = std::max(outcome.largest_step, step / allowed);
    outcome.is_finite = outcome.is_finite && out.F_H_D.f.allFinite() && out.F_H_D.t.allFinite();
    variation_ += step;
    turning_variation_ += (out.F_H_D.t - last_.t).norm();
    last_ = out.F_H_D;
    credited_ = out.energy.credited;
    turning_credited_ = out.turning_energy.credited;
  }

  void OnEvent(const simulation::SimulationEvent& event) override { (void)event; }

  /** The bound of docs/algorithms/stability.md: what is owed, the reserve, and what the encoders'
   steps may hide, sqrt(3)/2 of a step times the total variation of the force. */
  [[nodiscard]] double Bound(const device::DeviceProfile& profile) const {
    constexpr double kHarmless = 0.3;  // [m/s]; the reserve is the mechanism's energy at it
    return credited_ + 0.5 * profile.mass * kHarmless * kHarmless +
           0.5 * std::sqrt(3.0) * profile.position_resolution * variation_;
  }

  [[nodiscard]] double TurningBound(const device::DeviceProfile& profile) const {
    return turning_credited_ + haptics::PassivityLimits().reserve +
           0.5 * std::sqrt(3.0) * profile.rotation_resolution * turning_variation_;
  }

  Outcome outcome;

 private:
  haptics::TickOptions options_;
  spatial::Wrench last_;
  double variation_{0};
  double turning_variation_{0};
  double credited_{0};
  double turning_credited_{0};
};

/** A physics loop that is late now and then, and sometimes gone for a while. */
class LatePhysics {
 public:
  explicit LatePhysics(std::uint64_t seed) : random_(seed) {}

  bool operator()(std::int64_t t_ns) {
    if (t_ns < back_ns_) {
      return true;
    }
    const double dice = random_.Uniform();
    if (dice < 0.01) {
      back_ns_ = t_ns + static_cast<std::int64_t>(random_.Uniform(0, 0.4e9));
    }
    return dice < 0.3;  // up to 20 ms and more, as it goes on
  }

 private:
  Random random_;
  std::int64_t back_ns_{0};
};

Result<Outcome> Run(const std::shared_ptr<const Model>& model, const std::string& driver,
                    std::uint64_t seed, const StormOptions& storm) {
  Random random(seed);
  device::EmulatorOptions emulation;
  if (const auto* known = device::FindProfileOfDriver(driver); known != nullptr) {
    emulation.profile = known->profile;
  }
  // Not by an address: the emulator has this profile, and its forces arrive late.
  auto emulator = device::StartEmulator(driver, emulation);
  if (!emulator) {
    return Unexpected(emulator.error());
  }
  auto device = device::OpenDevice((*emulator)->address(), (*emulator)->surroundings());
  if (!device) {
    return Unexpected(device.error());
  }
  const double delay = 1e-3 * random.Uniform(0, storm.longest_delay_ms);
  (*emulator)->device().SetDelay(std::llround(1e9 * delay));
  device::DeviceInfo info = (*device)->info();
  info.profile.delay += delay;
  const haptics::TickOptions options = simulation::MakeTickOptions(info, *model, {});
  ForceWatch watch(options);
  const device::EmulatedDevice& emulated = (*emulator)->device();
  assembly::AssemblySetup setup(
      model,
      assembly::MakeDeviceHand(*model, {std::move(*emulator), std::move(*device)}, options, seed,
                               false),
      &watch);
  const std::size_t steps = model->sequence.steps.size();
  setup.run().Only(1 + seed % (steps - 1), 1);
  simulation::Execution execution = setup.MakeExecution(storm.limit_s);
  double largest_motor = 0;
  execution.is_done = [&] {
    largest_motor = std::max(largest_motor, emulated.truth().F_H_D.f.norm());
    return setup.run().is_done();
  };
  execution.is_physics_late = LatePhysics(seed + 1'000'000);
  (void)RunLockstep(execution);
  const auto truth = emulated.truth();
  Outcome outcome = watch.outcome;
  outcome.net_work = truth.work;
  outcome.energy_excess = truth.work - watch.Bound(info.profile);
  outcome.turning_excess = truth.turning_work - watch.TurningBound(info.profile);
  outcome.largest_share = info.profile.max_force > 0 ? largest_motor / info.profile.max_force : 0;
  const product::OccurrenceId part = model->sequence.steps[1 + seed % (steps - 1)].occurrence;
  outcome.is_seated =
      setup.simulation().physics().placement(part) == simulation::Placement::kPlaced;
  return outcome;
}

struct Row {
  int runs{0};
  int seated{0};
  int broken{0};
  double largest_share{0};
  double largest_step{0};
  double energy_excess{-1e9};
  double turning_excess{-1e9};
  double most_work{-1e9};
};

void Add(const Outcome& outcome, std::uint64_t seed, const std::string& driver, Row* row) {
  constexpr double kRounding = 1e-9;
  ++row->runs;
  row->seated += outcome.is_seated ? 1 : 0;
  row->largest_share = std::max(row->largest_share, outcome.largest_share);
  row->largest_step = std::max(row->largest_step, outcome.largest_step);
  row->energy_excess = std::max(row->energy_excess, outcome.energy_excess);
  row->turning_excess = std::max(row->turning_excess, outcome.turning_excess);
  row->most_work = std::max(row->most_work, outcome.net_work);
  const bool is_broken = !outcome.is_finite || outcome.largest_share > 1 + kRounding ||
                         outcome.largest_step > 1 + kRounding || outcome.energy_excess > 0 ||
                         outcome.turning_excess > 0;
  if (is_broken) {
    ++row->broken;
    fmt::print(stderr,
               "{} seed {}: share {:.3f}, step {:.3f}, energy {:+.2e} J, turning {:+.2e} J\n",
               driver, seed, outcome.largest_share, outcome.largest_step, outcome.energy_excess,
               outcome.turning_excess);
  }
}

int RunStorm(const StormOptions& storm) {
  const auto model = bench::LoadModel(storm.file);
  if (!model) {
    fmt::print(stderr, "device_storm: {}\n", model.error().ToString());
    return 1;
  }
  const std::vector<std::string> drivers = device::EmulatedDrivers();
  std::vector<Row> rows(drivers.size());
  for (int i = 0; i < storm.runs; ++i) {
    const auto seed = static_cast<std::uint64_t>(storm.first_seed + i);
    const std::size_t k = static_cast<std::size_t>(i) % drivers.size();
    const auto outcome = Run(*model, drivers[k], seed, storm);
    if (!outcome) {
      fmt::print(stderr, "device_storm: {}\n", outcome.error().ToString());
      return 1;
    }
    Add(*outcome, seed, drivers[k], &rows[k]);
  }
  fmt::print("{:<15} {:>5} {:>7} {:>7} {:>10} {:>10} {:>12} {:>14} {:>14}\n", "driver", "runs",
             "seated", "broken", "force/peak", "step/limit", "most work J", "over bound J",
             "turning J");
  int broken = 0;
  for (std::size_t k = 0; k < drivers.size(); ++k) {
    const Row& row = rows[k];
    if (row.runs == 0) {
      continue;
    }
    fmt::print("{:<15} {:>5} {:>7} {:>7} {:>10.3f} {:>10.3f} {:>12.4f} {:>14.4f} {:>14.4f}\n",
               drivers[k], row.runs, row.seated, row.broken, row.largest_share, row.largest_step,
               row.most_work, row.energy_excess, row.turning_excess);
    broken += row.broken;
  }
  return broken == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hvas

int main(int argc, char** argv) {
  CLI::App app("device_storm: emulated devices, late forces and a late physics loop");
  hvas::StormOptions storm;
  app.add_option("file", storm.file, "Product, as products/gear_pump.step")->required();
  app.add_option("--runs", storm.runs, "In all")->check(CLI::Range(1, 1'000'000));
  app.add_option("--seed", storm.first_seed, "Of the first run");
  app.add_option("--limit", storm.limit_s, "Session time of a run [s]");
  app.add_option("--delay", storm.longest_delay_ms, "Longest delay of the forces [ms]")
      ->check(CLI::Range(0.0, 20.0));
  CLI11_PARSE(app, argc, argv);
  return hvas::RunStorm(storm);
}
