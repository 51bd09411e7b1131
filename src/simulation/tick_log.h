#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "contact/scene.h"
#include "device/device.h"
#include "haptics/held_part.h"

namespace hvas::simulation {

/** What the physics loop tells the tick. */
struct TickCommand {
  enum class Kind : std::uint8_t {
    kTake,
    kPlace,
    kHelp,  ///< A hand takes hold of what another one holds as well.
  } kind{Kind::kPlace};
  std::size_t hand{0};   ///< That takes, or helps.
  std::size_t other{0};  ///< That is helped.
  const haptics::HeldPart* part{nullptr};
  contact::BodyId body;
  spatial::Pose X_WB;
};

/** All that went into a session's ticks, and what came out of them: enough to run each of them
 again (ReplayTicks). Sized once; what comes after it is full is not kept. The haptic thread adds
 ticks and commands, RT-safe; the physics thread keeps parts. */
class TickLog {
 public:
  struct Tick {
    device::DeviceState device;
    std::int64_t model_age_ns{0};
    std::int64_t since_write_ns{0};
    bool is_stopped{false};
    std::uint8_t effort_level{0};
    std::uint8_t hand{0};
    std::int64_t compute_ns{0};
    spatial::Wrench F_H_D;
  };

  struct Command {
    std::size_t tick{0};  ///< Came before this one.
    TickCommand command;
  };

  explicit TickLog(std::size_t capacity)
      : capacity_(capacity),
        ticks_(std::make_unique<Tick[]>(capacity)),
        commands_(std::make_unique<Command[]>(kCommands)) {}

  void Add(const Tick& tick) noexcept {
    if (tick_count_ < capacity_) {
      ticks_[tick_count_++] = tick;
    }
  }

  void Add(const TickCommand& command) noexcept {
    if (command_count_ < kCommands) {
      commands_[command_count_++] = {tick_count_, command};
    }
  }

  void SetComputeOfLast(std::int64_t compute_ns) noexcept {
    if (tick_count_ > 0 && tick_count_ < capacity_) {
      ticks_[tick_count_ - 1].compute_ns = compute_ns;
    }
  }

  /** A part that a command points to lives as long as the log. */
  void Keep(std::shared_ptr<const haptics::HeldPart> part) { parts_.push_back(std::move(part)); }

  [[nodiscard]] std::size_t tick_count() const noexcept { return tick_count_; }

  [[nodiscard]] const Tick& tick(std::size_t i) const noexcept { return ticks_[i]; }

  [[nodiscard]] std::size_t command_count() const noexcept { return command_count_; }

  [[nodiscard]] const Command& command(std::size_t i) const noexcept { return commands_[i]; }

 private:
  /** More than ten a second for an hour: a choice. */
  static constexpr std::size_t kCommands = 65'536;

  std::size_t capacity_;
  std::unique_ptr<Tick[]> ticks_;
  std::unique_ptr<Command[]> commands_;
  std::size_t tick_count_{0};
  std::size_t command_count_{0};
  std::vector<std::shared_ptr<const haptics::HeldPart>> parts_;
};

}  // namespace hvas::simulation
