#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/triple_buffer.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/simulated_person.h"
#include "studio/pointer.h"

namespace hvas::studio {

/** How far an assembly has come, to go on from. */
struct LiveState {
  std::vector<simulation::PartState> parts;  ///< By OccurrenceId; empty: all on the table.
  std::size_t next_step{0};
};

/** Who is told of what. All but on_frame are called on the physics thread. */
struct LiveListeners {
  std::function<void(const simulation::SimulationEvent&)> on_event;
  std::function<void(product::OccurrenceId, simulation::Placement)> on_placement;
  std::function<void(std::size_t step)> on_step;
  std::function<void(const simulation::Frame&, double peak_felt)> on_frame;  ///< Publish thread.
};

struct LiveOptions {
  bool has_person{false};  ///< The simulated person works, instead of whoever holds the pointer.
  spatial::Pose X_WH;      ///< Where the hand is at first.
  std::uint64_t seed{1};
  double rate_hz{1000};
};

/** One stretch of a live assembly: a simulation of a model, run in real time until it is destroyed.
 What changes the model, who steers, or what was done begins a new one from the old one's state. */
class LiveRun final : private simulation::Sink {
 public:
  LiveRun(std::shared_ptr<const simulation::Model> model, const LiveState& start,
          const LiveOptions& options, LiveListeners listeners);
  ~LiveRun() override;

  /** Has the hand go to a part and close on it. Any thread. */
  void Take(const simulation::SequenceStep& step, const spatial::Pose& X_WH);

  /** Where the pointer wants the hand. Any thread. */
  void Move(const spatial::Pose& X_WH, bool is_gripping);

  void StopForces(bool is_stopped) { simulation_.StopForces(is_stopped); }

  /** As of the last physics step. Any thread. */
  [[nodiscard]] LiveState state() const;
  [[nodiscard]] bool is_holding() const;

  /** Of the last second, when one has ended since the last call. One thread. */
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  [[nodiscard]] const simulation::Model& model() const { return simulation_.model(); }

 private:
  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void Advance();
  void Observe();
  void Run(const LiveOptions& options);

  LiveListeners listeners_;
  simulation::Simulation simulation_;
  PointerOperator pointer_;
  std::unique_ptr<simulation::SimulatedPerson> person_;
  simulation::AssemblyRun assembly_;
  TripleBuffer<simulation::LoopStatus> status_;
  std::atomic<double> peak_felt_{0};
  std::atomic<bool> is_stopping_{false};

  mutable std::mutex mutex_;  ///< Of what follows; never taken by the haptic thread.
  std::vector<std::function<void()>> tasks_;
  LiveState observed_;
  bool is_holding_{false};

  std::thread thread_;
};

/** Options of the tick for a hand that is moved from afar: as for the simulated device, with full
 safety limits, and the force taken back when nothing is heard from the client. */
[[nodiscard]] haptics::TickOptions MakePointerOptions(double rate_hz);

}  // namespace hvas::studio
