#pragma once

#include <array>
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
#include "studio/live_hand.h"
#include "studio/live_trial.h"
#include "studio/recording.h"

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
  /** Publish thread. */
  std::function<void(const simulation::Frame&, std::int64_t clock_ns, const PeakForces&)> on_frame;
};

struct LiveOptions {
  bool has_person{false};           ///< As in HandPurpose.
  std::vector<HandSetup> hands{1};  ///< One or two.
  std::uint64_t seed{1};
  double rate_hz{1000};
  std::shared_ptr<Recording> recording;  ///< Of what happens; may be null.
  std::shared_ptr<LiveTrial> trial;      ///< Of a study; may be null.
};

/** One stretch of a live assembly: a simulation of a model, run in real time until it is destroyed.
 What changes the model, who steers, or what was done begins a new one from the old one's state. */
class LiveRun final : private simulation::Sink {
 public:
  LiveRun(std::shared_ptr<const simulation::Model> model, const LiveState& start,
          const LiveOptions& options, LiveListeners listeners);
  ~LiveRun() override;

  /** Has a hand go to a part and close on it. Any thread.
   @pre the hand follows a pointer. */
  void Take(std::size_t hand, const simulation::SequenceStep& step, const spatial::Pose& X_WH);

  /** Where the pointer wants a hand. Any thread. */
  void Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);

  void StopForces(bool is_stopped) { simulation_->StopForces(is_stopped); }

  /** As of the last physics step. Any thread. */
  [[nodiscard]] LiveState state() const;
  [[nodiscard]] bool is_holding(std::size_t hand) const;
  /** As it was before the hand that closed last had closed. */
  [[nodiscard]] LiveState state_before_take() const;

  [[nodiscard]] std::size_t hand_count() const { return hands_.size(); }

  [[nodiscard]] const LiveHand& hand(std::size_t i) const { return *hands_[i]; }

  /** Of the last second, when one has ended since the last call. One thread. */
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  [[nodiscard]] const simulation::Model& model() const { return simulation_->model(); }

 private:
  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;
  void Advance();
  void Observe();
  void Run(const LiveOptions& options);

  LiveListeners listeners_;
  std::shared_ptr<Recording> recording_;
  std::shared_ptr<LiveTrial> trial_;
  std::vector<std::unique_ptr<LiveHand>> hands_;
  std::unique_ptr<simulation::Simulation> simulation_;
  simulation::AssemblyRun assembly_;
  TripleBuffer<simulation::LoopStatus> status_;
  std::array<std::atomic<double>, 2> peak_felt_{};
  /** When session time was 0, as its newest tick has it, by MonotonicNs(): what the loop has missed
   is no session time. */
  std::atomic<std::int64_t> begin_ns_;
  std::atomic<bool> is_stopping_{false};

  mutable std::mutex mutex_;  ///< Of what follows; never taken by the haptic thread.
  std::vector<std::function<void()>> tasks_;
  LiveState observed_;
  LiveState before_take_;
  std::array<bool, 2> is_holding_{};  ///< By hand.

  std::thread thread_;
};

}  // namespace hvas::studio
