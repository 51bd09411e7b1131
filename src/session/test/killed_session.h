#pragma once

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <new>
#include <thread>

#include "base/clock.h"
#include "person/simulated_person.h"
#include "record/recorder.h"
#include "session/session_recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"

/** Sessions that are killed while they are recorded. */
namespace hvas::session::testing {

/** Tells the process that will kill this one how far the session has come. */
class Teller final : public simulation::Sink {
 public:
  using Counter = std::atomic<std::int64_t>;

  Teller(SessionRecorder* sink, Counter* ticks) : sink_(sink), ticks_(ticks) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override {
    sink_->OnTick(hand, device, out);
    ticks_->fetch_add(1, std::memory_order_relaxed);
  }

  void OnEvent(const simulation::SimulationEvent& event) override { sink_->OnEvent(event); }

 private:
  SessionRecorder* sink_;
  Counter* ticks_;
};

/** The child: one session after the other, until it is killed. Frames as a viewer is shown them. */
[[noreturn]] inline void RecordForEver(const std::shared_ptr<const simulation::Model>& model,
                                       const std::filesystem::path& path, bool is_realtime,
                                       Teller::Counter* ticks) {
  record::RecorderOptions options;
  options.path = path;
  options.is_threaded = is_realtime;
  const auto recorder = record::Recorder::Create(options, {});
  if (!recorder) {
    ::_exit(1);
  }
  SessionRecorder sink(recorder->get(), *model);
  Teller teller(&sink, ticks);
  for (std::uint64_t seed = 1;; ++seed) {
    simulation::Simulation simulation(model, haptics::TickOptions());
    person::SimulatedPerson person({}, seed, simulation::StartOfHand(*model));
    simulation::AssemblyRun run(&simulation, &person, &teller);
    sink.Begin(&simulation);
    simulation::Execution execution = run.MakeExecution(&person, 1e6);
    execution.on_frame = [&](const simulation::Frame& frame) {
      const auto bytes = std::as_bytes(std::span(frame.X_WB));
      (*recorder)->AddFrame({sink.t_ns(), {bytes.begin(), bytes.end()}});
    };
    (void)(is_realtime ? RunRealtime(execution) : RunLockstep(execution));
  }
}

/** Records a session in a process of its own and kills that after a while; returns the ticks that
 it had run by then, or -1 where it ended by itself.
 @pre this process has one thread. */
inline std::int64_t RecordAndKill(const std::shared_ptr<const simulation::Model>& model,
                                  const std::filesystem::path& path, bool is_realtime,
                                  std::chrono::milliseconds after) {
  static_assert(Teller::Counter::is_always_lock_free);
  void* shared = ::mmap(nullptr, sizeof(Teller::Counter), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* ticks = new (shared) Teller::Counter(0);
  const pid_t child = ::fork();
  if (child == 0) {
    RecordForEver(model, path, is_realtime, ticks);
  }
  std::this_thread::sleep_for(after);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  const std::int64_t count = WIFSIGNALED(status) ? ticks->load() : -1;
  ::munmap(shared, sizeof(Teller::Counter));
  return count;
}

}  // namespace hvas::session::testing
