#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>

#include "contact/scene.h"
#include "haptics/haptic_tick.h"
#include "simulation/handover.h"
#include "simulation/model.h"
#include "simulation/part_state.h"
#include "simulation/tick_log.h"

namespace hvas::simulation {

/** What the haptic thread alone touches of a simulation: the hands' ticks and the scene that they
 work in. */
class HapticSide {
 public:
  /** @param handover  To and from the physics loop; outlives this object. */
  HapticSide(const Model& model, const std::vector<haptics::TickOptions>& hands,
             Handover* handover);

  /** One tick of one hand: each hand once in a period, in their order. RT-safe.
   @param since_write_ns  TickContext::since_write_ns; 0 in virtual time. */
  haptics::TickOutput Tick(std::size_t hand, const device::DeviceState& device,
                           std::int64_t since_write_ns = 0) noexcept;

  /** Sets how much a tick does from the next one on, by the levels of kEffortLevels. RT-safe. */
  void SetEffortLevel(int level) noexcept;

  /** Any thread: no force at all from the next tick on, until it is taken back (N6). RT-safe. */
  void StopForces(bool is_stopped) noexcept {
    is_stopped_.store(is_stopped, std::memory_order_release);
  }

  /** How many commands the ticks have carried out. RT-safe. */
  [[nodiscard]] std::uint32_t applied_commands() const noexcept { return applied_commands_; }

  /** Keeps in `log` what goes into the ticks. Only before the loops run. */
  void KeepLog(TickLog* log) { log_ = log; }

  /** Goes on from where all parts were. Only before the loops run.
   @param together  Loose parts that are together; they outlive this object. */
  void Restore(const std::vector<PartState>& parts,
               const std::vector<const haptics::RigidGroup*>& together);

  /** Runs tick i of a log again, with the commands that came before it; ticks in their order, on a
   simulation that did nothing else. */
  haptics::TickOutput ReplayTick(const TickLog& log, std::size_t i) noexcept;

  /** Runs one tick again. */
  haptics::TickOutput ReplayTick(std::size_t hand, const device::DeviceState& device,
                                 const haptics::TickContext& context) noexcept;

  /** Carries a command out at once. RT-safe. */
  void Apply(const TickCommand& command, std::int64_t t_ns) noexcept;

  [[nodiscard]] std::size_t hand_count() const { return hands_.size(); }

  /** Contacts that pressed on what a hand holds in its last tick. RT-safe. */
  [[nodiscard]] std::span<const haptics::PressingContact> pressing(
      std::size_t hand) const noexcept {
    return hands_[hand].tick.pressing();
  }

  [[nodiscard]] const haptics::TickOptions& options(std::size_t hand) const {
    return hands_[hand].tick.options();
  }

 private:
  struct Hand {
    Hand(std::size_t i, const haptics::TickOptions& options, contact::Scene* scene)
        : index(i), tick(options, scene, i) {}

    const std::size_t index;
    haptics::HapticTick tick;
    haptics::HoldState last_state{haptics::HoldState::kEmpty};
    HoldMetrics metrics;
    Vec3 p_last_Cm{Vec3::Zero()};
    std::int64_t last_contact_ns{0};
    device::Condition last_condition{device::Condition::kReady};
    std::array<std::int64_t, 32> last_action_ns{};  ///< When the gate last did it, by bit.
  };

  /** What all other hands give a hand now; until the next call. */
  [[nodiscard]] std::span<const haptics::HandExchange> ListExchanges(const Hand& to) noexcept;
  /** Does something with each of the other hands. */
  template <typename Do>
  void ForOthers(const Hand& hand, Do act) noexcept;
  haptics::TickOutput RunTick(Hand* hand, const device::DeviceState& device,
                              const haptics::TickContext& context) noexcept;
  void ApplyTake(const TickCommand& command, std::int64_t t_ns) noexcept;
  void LetGo(Hand* hand, std::int64_t t_ns) noexcept;
  void ReportChanges(Hand* hand, const device::DeviceState& device,
                     const haptics::TickOutput& out) noexcept;
  void ReportSafety(Hand* hand, SimulationEvent event, std::uint32_t gate_actions) noexcept;
  static void UpdateMetrics(Hand* hand, std::int64_t t_ns, const haptics::TickOutput& out) noexcept;

  Handover& handover_;
  contact::Scene scene_;
  std::deque<Hand> hands_;
  std::array<haptics::HandExchange, haptics::kMaxHands - 1> exchanges_;
  TickLog* log_{nullptr};
  int effort_level_{0};
  int reported_effort_level_{0};
  std::size_t replayed_commands_{0};
  std::uint32_t applied_commands_{0};
  std::atomic<bool> is_stopped_{false};
};

}  // namespace hvas::simulation
