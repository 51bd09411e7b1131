// Does the haptic loop keep its deadlines on this machine, hour by hour? The simulated person
// assembles a product again and again in real time, with somebody watching (every frame is packed
// as a viewer would get it) and another thread that keeps a core busy. Prints wake-up, compute and
// age of the frames; runs every session again in virtual time, and counts a tick that took longer
// than its period as ours when it is slow again then: the host of a virtual machine takes the
// processor away for milliseconds, and its time is charged to the thread.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/devices/latency_json.h"
#include "assembly/assembly_setup.h"
#include "base/clock.h"
#include "load_model.h"
#include "simulation/executors.h"

namespace hvas {
namespace {

using simulation::Model;

struct BenchOptions {
  std::string file;
  double seconds{600};
  double rate_hz{1000};
  bool is_alone{false};
};

/** All that is told about the time that ticks took. */
struct Totals {
  LatencyHistogram compute, wake_up, frame_age, replayed;
  std::uint64_t ticks{0}, late{0}, missed{0}, overruns{0}, ours{0}, different{0}, frame_bytes{0};
  std::size_t parts{0}, seated{0};
  std::uint64_t ticks_at_level[simulation::kEffortLevels.size()]{};
  std::string scheduling;
};

/** Keeps a core busy until it is told to stop. */
class BusyThread {
 public:
  BusyThread() : thread_([this] { Work(); }) {}

  ~BusyThread() {
    is_stopping_ = true;
    thread_.join();
  }

  BusyThread(const BusyThread&) = delete;
  BusyThread& operator=(const BusyThread&) = delete;

 private:
  void Work() {
    volatile double x = 1;
    while (!is_stopping_.load(std::memory_order_relaxed)) {
      for (int i = 0; i < 100'000; ++i) {
        x = x * 1.0000001 + 1e-9;
      }
    }
  }

  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

/** The bytes of a frame that a viewer gets: a pose for each part that has moved. */
class FramePacker {
 public:
  std::size_t Pack(const simulation::Frame& frame) {
    bytes_.clear();
    const auto add = [this](double value) {
      const auto number = static_cast<float>(value);
      const auto* raw = reinterpret_cast<const std::byte*>(&number);
      bytes_.insert(bytes_.end(), raw, raw + sizeof(number));
    };
    last_.resize(frame.X_WB.size());
    for (std::size_t i = 0; i < frame.X_WB.size(); ++i) {
      const spatial::Pose& X = frame.X_WB[i];
      if (X.p() == last_[i].p() && X.q().coeffs() == last_[i].q().coeffs()) {
        continue;
      }
      last_[i] = X;
      add(static_cast<double>(i));
      for (int k = 0; k < 3; ++k) {
        add(X.p()[k]);
      }
      for (int k = 0; k < 4; ++k) {
        add(X.q().coeffs()[k]);
      }
    }
    return bytes_.size();
  }

 private:
  std::vector<std::byte> bytes_;
  std::vector<spatial::Pose> last_;
};

/** Runs a session's ticks again; returns those of `slow` that took longer than a period again. */
std::vector<std::size_t> Replay(const std::shared_ptr<const Model>& model,
                                const haptics::TickOptions& options, const simulation::TickLog& log,
                                const std::vector<std::size_t>& slow, Totals* totals) {
  simulation::Simulation again(model, options);
  const std::int64_t period_ns = std::llround(1e9 * options.dt);
  std::vector<std::size_t> slow_again;
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    const std::int64_t start_ns = ThreadCpuNs();
    const haptics::TickOutput out = again.haptics().ReplayTick(log, i);
    const std::int64_t compute_ns = ThreadCpuNs() - start_ns;
    totals->replayed.Add(compute_ns);
    totals->different += out.F_H_D.f == log.tick(i).F_H_D.f ? 0 : 1;
    if (compute_ns > period_ns && std::binary_search(slow.begin(), slow.end(), i)) {
      slow_again.push_back(i);
    }
  }
  return slow_again;
}

/** Counts the slow ticks that are ours: the host may steal from one that is run again, too, but
 hardly from the same one every time. */
void CountOurs(const std::shared_ptr<const Model>& model, const haptics::TickOptions& options,
               const simulation::TickLog& log, Totals* totals) {
  constexpr int kReplays = 3;
  const std::int64_t period_ns = std::llround(1e9 * options.dt);
  std::vector<std::size_t> slow;
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    if (log.tick(i).compute_ns > period_ns) {
      slow.push_back(i);
    }
  }
  slow = Replay(model, options, log, slow, totals);
  for (int i = 1; i < kReplays && !slow.empty(); ++i) {
    slow = Replay(model, options, log, slow, totals);
  }
  totals->ours += slow.size();
}

void RunSession(const std::shared_ptr<const Model>& model, const BenchOptions& bench,
                std::uint64_t seed, double limit_s, Totals* totals) {
  const haptics::TickOptions options = assembly::MakePersonTick({0, bench.rate_hz});
  simulation::TickLog log(static_cast<std::size_t>(bench.rate_hz * limit_s) + 1000);
  assembly::AssemblySetup setup(model, assembly::MakePersonHand(*model, options, {}, seed),
                                nullptr);
  setup.simulation().KeepLog(&log);
  simulation::FlightRecorder flight(bench.rate_hz);
  FramePacker packer;
  simulation::Execution execution = setup.MakeExecution(limit_s);
  execution.flight = &flight;
  execution.log = &log;
  execution.on_frame = [&](const simulation::Frame& frame) {
    totals->frame_bytes += packer.Pack(frame);
  };
  const simulation::ExecutionReport report = RunRealtime(execution);
  totals->compute.Merge(report.compute);
  totals->wake_up.Merge(report.wake_up);
  totals->frame_age.Merge(report.frame_age);
  totals->ticks += report.ticks;
  totals->late += report.late_wake_ups;
  totals->missed += report.missed_periods;
  totals->overruns += report.overruns;
  for (std::size_t level = 0; level < report.ticks_at_level.size(); ++level) {
    totals->ticks_at_level[level] += report.ticks_at_level[level];
  }
  totals->scheduling = report.scheduling;
  const std::vector<simulation::PartResult>& parts = setup.run().results();
  totals->parts += parts.size();
  totals->seated += static_cast<std::size_t>(
      std::count_if(parts.begin(), parts.end(),
                    [](const simulation::PartResult& part) { return part.is_seated; }));
  CountOurs(model, options, log, totals);
}

void Print(const Totals& totals, double wall_s) {
  fmt::print("{} ticks in {:.0f} s of real time; {}\n", totals.ticks, wall_s, totals.scheduling);
  app::PrintLatencyHistogram("compute of a tick", totals.compute);
  app::PrintLatencyHistogram("the same ticks in virtual time", totals.replayed);
  app::PrintLatencyHistogram("wake-up after the deadline", totals.wake_up);
  app::PrintLatencyHistogram("age of a frame when it is published", totals.frame_age);
  fmt::print("late wake-ups (more than a period): {}, periods passed over: {}\n", totals.late,
             totals.missed);
  fmt::print("ticks that computed longer than a period: {}, of which ours (slow again): {}\n",
             totals.overruns, totals.ours);
  fmt::print("ticks at effort level 0, 1, 2, 3: {}, {}, {}, {}\n", totals.ticks_at_level[0],
             totals.ticks_at_level[1], totals.ticks_at_level[2], totals.ticks_at_level[3]);
  fmt::print("parts that had their turn: {}, of which seated: {}\n", totals.parts, totals.seated);
  fmt::print("ticks that gave another force when run again: {}; frames: {:.1f} kB/s\n",
             totals.different, 1e-3 * static_cast<double>(totals.frame_bytes) / wall_s);
}

int RunBench(const BenchOptions& bench) {
  const auto model = bench::LoadModel(bench.file);
  if (!model) {
    fmt::print(stderr, "realtime_bench: {}\n", model.error().ToString());
    return 1;
  }
  Totals totals;
  double wall_s = 0;
  for (std::uint64_t seed = 1; wall_s < bench.seconds; ++seed) {
    const std::int64_t start_ns = MonotonicNs();
    {
      const auto busy = bench.is_alone ? nullptr : std::make_unique<BusyThread>();
      RunSession(*model, bench, seed, bench.seconds - wall_s, &totals);
    }
    wall_s = static_cast<double>(totals.ticks) / bench.rate_hz;
    fmt::print(stderr, "session {}: {:.0f} s, replayed; {:.0f} of {:.0f} s done\n", seed,
               1e-9 * static_cast<double>(MonotonicNs() - start_ns), wall_s, bench.seconds);
  }
  Print(totals, wall_s);
  return totals.ours == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hvas

int main(int argc, char** argv) {
  CLI::App app("realtime_bench: the haptic loop in real time, and its slow ticks again");
  hvas::BenchOptions bench;
  app.add_option("file", bench.file, "Product, as products/gear_pump.step")->required();
  app.add_option("--seconds", bench.seconds, "Of real time");
  app.add_option("--rate", bench.rate_hz, "Of the loop [Hz]")->check(CLI::Range(1000.0, 8000.0));
  app.add_flag("--alone", bench.is_alone, "Without a thread that keeps a core busy");
  CLI11_PARSE(app, argc, argv);
  return hvas::RunBench(bench);
}
