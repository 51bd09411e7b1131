#include "session/replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "record/packing.h"
#include "session/command_json.h"
#include "session/session_recorder.h"
#include "simulation/simulation.h"

namespace hvas::session {
namespace {

using record::TickRecord;
using simulation::PartState;
using simulation::Simulation;

constexpr std::int64_t kTicksPerReport = 20'000;  // 20 s of session: a choice.

using PackedTick = std::array<std::byte, record::kPackedTickSize>;

PackedTick PackOne(const TickRecord& tick) {
  PackedTick bytes{};
  record::Pack(tick, bytes);
  return bytes;
}

bool IsSame(const spatial::Pose& a, const spatial::Pose& b) {
  return a.p() == b.p() && a.q().coeffs() == b.q().coeffs();
}

/** The first thing in which two ticks differ, for people. */
std::string NameDifference(const TickRecord& a, const TickRecord& b) {
  if (a.held != b.held || a.state != b.state) {
    return "the held part, or its state";
  }
  if (!IsSame(a.X_WH, b.X_WH)) {
    return "the hand's pose";
  }
  if (!IsSame(a.X_WD, b.X_WD)) {
    return fmt::format("the part's pose, by {:.3g} mm", 1e3 * (a.X_WD.p() - b.X_WD.p()).norm());
  }
  if (a.F_felt_W.f != b.F_felt_W.f) {
    return fmt::format("the felt force, by {:.3g} N", (a.F_felt_W.f - b.F_felt_W.f).norm());
  }
  if (a.F_felt_W.t != b.F_felt_W.t) {
    return fmt::format("the felt torque, by {:.3g} N m", (a.F_felt_W.t - b.F_felt_W.t).norm());
  }
  if (a.F_true_W.f != b.F_true_W.f || a.F_true_W.t != b.F_true_W.t) {
    return fmt::format("the true force, by {:.3g} N", (a.F_true_W.f - b.F_true_W.f).norm());
  }
  return a.status != b.status ? "the actions of the safety gate" : "the contacts or the depth";
}

void Follow(const TickRecord& tick, ReplayedPart::Outcome* outcome) {
  outcome->peak_true = std::max(outcome->peak_true, tick.F_true_W.f.norm());
  outcome->peak_felt = std::max(outcome->peak_felt, tick.F_felt_W.f.norm());
  outcome->depth = std::max(outcome->depth, tick.depth);
  outcome->is_seated = static_cast<haptics::HoldState>(tick.state) == haptics::HoldState::kSeated;
}

class Replayer {
 public:
  Replayer(std::shared_ptr<const simulation::Model> model, const ReplayOptions& options,
           std::vector<record::Command> commands, std::int64_t tick_count)
      : model_(std::move(model)),
        options_(options),
        commands_(std::move(commands)),
        tick_count_(tick_count),
        next_beginning_(FindBeginning(0)) {}

  /** False where the record cannot be followed any further: error() tells. */
  bool Add(const TickRecord& recorded) {
    if (options_.progress && seen_ticks_++ % kTicksPerReport == 0) {
      options_.progress(static_cast<double>(seen_ticks_) / static_cast<double>(tick_count_));
    }
    while (!error_ && next_beginning_ < commands_.size() &&
           commands_[next_beginning_].t_ns <= recorded.t_ns) {
      Begin(commands_[next_beginning_]);
      next_ = next_beginning_ + 1;
      next_beginning_ = FindBeginning(next_);
    }
    if (!error_ && (simulation_ == nullptr || recorded.hand >= simulation_->hand_count())) {
      Refuse("A tick of the record belongs to no stretch of the session.");
    }
    if (!error_ && !IsNext(recorded)) {
      is_lost_ = true;
    }
    if (!error_ && !is_lost_) {
      Obey(recorded);
    }
    if (error_) {
      return false;
    }
    if (is_lost_) {
      ++report_.unreachable_ticks;
      return true;
    }
    Run(recorded);
    return true;
  }

  [[nodiscard]] ReplayReport Finish() {
    const auto ticks = static_cast<double>(std::max<std::int64_t>(1, report_.ticks));
    report_.rms_felt_difference = std::sqrt(squares_ / ticks);
    return std::move(report_);
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  void Refuse(const std::string& message) {
    error_ = Error{ErrorCode::kUnreadable, message, {}, "restore the file from a copy"};
  }

  /** The first beginning of a stretch from this command on; behind the last one: there is none. */
  [[nodiscard]] std::size_t FindBeginning(std::size_t from) const {
    while (from < commands_.size() && commands_[from].number != 0) {
      ++from;
    }
    return from;
  }

  void Begin(const record::Command& command) {
    auto beginning = ParseBeginning(command.json, model_->bodies.size());
    if (!beginning) {
      error_ = beginning.error();
      return;
    }
    for (haptics::TickOptions& hand : beginning->hands) {
      hand.condition = options_.condition.value_or(hand.condition);
      hand.force_map = options_.force_map.value_or(hand.force_map);
    }
    simulation_ = std::make_unique<simulation::Simulation>(model_, beginning->hands);
    simulation_->Restore(beginning->parts);
    parts_ = std::move(beginning->parts);
    start_ns_ = command.t_ns;
    period_ns_ = std::llround(1e9 * simulation_->options().dt);
    expected_ns_.fill(start_ns_);
    obeyed_ = 0;
    is_lost_ = false;
    ++report_.stretches;
  }

  /** Whether no tick is missing before this one. */
  bool IsNext(const TickRecord& recorded) {
    std::int64_t& expected_ns = expected_ns_.at(recorded.hand);
    const bool is_next = recorded.t_ns == expected_ns;
    expected_ns = recorded.t_ns + period_ns_;
    return is_next;
  }

  /** All commands that the tick obeyed and none before it did. */
  void Obey(const TickRecord& recorded) {
    for (; obeyed_ < recorded.commands; ++obeyed_, ++next_) {
      if (next_ >= commands_.size() || commands_[next_].number != obeyed_ + 1) {
        Refuse(fmt::format("the record lacks command {} of the stretch from {:.3f} s on",
                           obeyed_ + 1, 1e-9 * static_cast<double>(start_ns_)));
        return;
      }
      auto given = ParseCommand(commands_[next_], parts_, simulation_->hand_count());
      if (!given) {
        error_ = given.error();
        return;
      }
      simulation_->ReplayCommand(*given, recorded.t_ns - start_ns_);
      parts_ = std::move(given->parts);
    }
  }

  void Run(const TickRecord& recorded) {
    device::DeviceState device = MakeDeviceState(recorded);
    device.t_ns -= start_ns_;
    const haptics::TickOutput out =
        simulation_->haptics().ReplayTick(recorded.hand, device, MakeTickContext(recorded));
    TickRecord replayed = MakeTickRecord(recorded.hand, device, out, recorded.commands);
    replayed.t_ns = recorded.t_ns;
    Compare(record::Rounded(recorded), replayed);  // Those of before schema 6 are not.
  }

  void Compare(const TickRecord& recorded, const TickRecord& replayed) {
    ++report_.ticks;
    report_.session_ns += recorded.hand == 0 ? period_ns_ : 0;
    if (PackOne(recorded) != PackOne(replayed)) {
      ++report_.different_ticks;
      if (!report_.first) {
        report_.first = {recorded.t_ns, recorded.hand, NameDifference(recorded, replayed)};
      }
      const double difference = (recorded.F_felt_W.f - replayed.F_felt_W.f).norm();
      squares_ += difference * difference;
      report_.largest_felt_difference = std::max(report_.largest_felt_difference, difference);
      report_.largest_way =
          std::max(report_.largest_way, (recorded.X_WD.p() - replayed.X_WD.p()).norm());
    }
    if (recorded.held != record::kNoOccurrence && recorded.held < model_->bodies.size()) {
      ReplayedPart& part = PartOf(product::OccurrenceId(recorded.held));
      part.held_ns += period_ns_;
      Follow(recorded, &part.recorded);
      Follow(replayed, &part.replayed);
    }
  }

  ReplayedPart& PartOf(product::OccurrenceId id) {
    const auto found = std::find_if(report_.parts.begin(), report_.parts.end(),
                                    [id](const auto& part) { return part.occurrence == id; });
    if (found != report_.parts.end()) {
      return *found;
    }
    ReplayedPart& part = report_.parts.emplace_back();
    part.occurrence = id;
    return part;
  }

  std::shared_ptr<const simulation::Model> model_;
  const ReplayOptions& options_;
  std::vector<record::Command> commands_;
  std::int64_t tick_count_;
  std::int64_t seen_ticks_{0};

  // Of the present stretch.
  std::unique_ptr<Simulation> simulation_;
  std::vector<PartState> parts_;  ///< As the last command had them.
  std::int64_t start_ns_{0};
  std::int64_t period_ns_{0};
  std::array<std::int64_t, haptics::kMaxHands> expected_ns_{};  ///< Of each hand's next tick.
  std::uint32_t obeyed_{0};
  bool is_lost_{false};

  std::size_t next_{0};  ///< Of commands_, to be obeyed.
  std::size_t next_beginning_;
  double squares_{0};
  ReplayReport report_;
  std::optional<Error> error_;
};

}  // namespace

Result<ReplayReport> Replay(record::Reader* reader,
                            const std::shared_ptr<const simulation::Model>& model,
                            const ReplayOptions& options) {
  auto commands = reader->ReadCommands();
  if (!commands) {
    return Unexpected(commands.error());
  }
  if (commands->empty()) {
    return Fail(
        ErrorCode::kUnsupported,
        fmt::format(
            "the record has layout version {}, which does not contain all inputs of the ticks",
            reader->schema()),
        reader->path().string(), "record the session again; export and report still work");
  }
  const std::int64_t start_ns = MonotonicNs();
  Replayer replayer(model, options, std::move(*commands), reader->tick_count());
  const Result<void> done =
      reader->ForEachTick({}, [&](const TickRecord& tick) { return replayer.Add(tick); });
  if (!done) {
    return Unexpected(done.error());
  }
  if (std::optional<Error> error = replayer.error()) {
    error->where = reader->path().string();
    return Unexpected(*std::move(error));
  }
  ReplayReport report = replayer.Finish();
  report.wall_ns = MonotonicNs() - start_ns;
  return report;
}

}  // namespace hvas::session
