#include "sequence/step_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

constexpr double kBeyondAll = 1e4;  // [m]: farther than any product, and no overflow on the way.

/** Follows an order in thought: parts are taken up, put in and set aside as a session does it. */
class StepCheck {
 public:
  explicit StepCheck(std::size_t part_count) : states_(part_count, State::kLoose) {}

  /** @returns whether the step can come next. */
  [[nodiscard]] bool Follow(const SequenceStep& step) {
    const bool is_sound = std::abs(step.extraction_W.norm() - 1) < 1e-6 &&
                          step.engage_distance >= 0 && step.engage_distance < kBeyondAll &&
                          step.offset_W.norm() < kBeyondAll;
    const bool has_sound_way =
        std::all_of(step.way.begin(), step.way.end(), [](const spatial::Pose& X_WB) {
          return X_WB.p().norm() < kBeyondAll && std::abs(X_WB.q().norm() - 1) < 1e-6;
        });
    if (!is_sound || !has_sound_way) {
      return false;
    }
    switch (step.kind) {
      case SequenceStep::Kind::kBase:
      case SequenceStep::Kind::kAssume:
        return step.members.empty() && Move(step, State::kLoose, State::kPlaced);
      case SequenceStep::Kind::kInsert:
        return Move(step, step.members.empty() ? State::kLoose : State::kParked, State::kPlaced);
      case SequenceStep::Kind::kPark:
        return Move(step, State::kPlaced, State::kParked);
      case SequenceStep::Kind::kAside:
        return step.members.empty() && Move(step, State::kPlaced, State::kAside);
      case SequenceStep::Kind::kReturn:
        return step.members.empty() && Move(step, State::kAside, State::kPlaced);
      case SequenceStep::Kind::kRemove:
        return false;  // A person's own wish, and no plan's.
    }
    return false;
  }

 private:
  enum class State : std::uint8_t { kLoose, kPlaced, kParked, kAside };

  bool Move(const SequenceStep& step, State from, State to) {
    std::vector<OccurrenceId> parts = step.members;
    parts.push_back(step.occurrence);
    for (const OccurrenceId part : parts) {
      if (states_[part.index()] != from) {
        return false;
      }
      states_[part.index()] = to;
    }
    return true;
  }

  std::vector<State> states_;
};

/** A part that goes aside lets the next one pass, and returns. */
bool IsLetPastAtOnce(const std::vector<SequenceStep>& steps, std::size_t i) {
  return steps[i].kind != SequenceStep::Kind::kAside ||
         (i + 2 < steps.size() && steps[i + 1].kind == SequenceStep::Kind::kInsert &&
          steps[i + 2].kind == SequenceStep::Kind::kReturn &&
          steps[i + 2].occurrence == steps[i].occurrence);
}

}  // namespace

Result<void> CheckSteps(const std::vector<SequenceStep>& steps, std::size_t part_count) {
  if (steps.empty() || steps.front().kind != SequenceStep::Kind::kBase) {
    return Fail(ErrorCode::kInvalid, "the order of assembly does not begin with a base");
  }
  StepCheck check(part_count);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!check.Follow(steps[i]) || !IsLetPastAtOnce(steps, i)) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("step {} of the order of assembly cannot come where it stands", i + 1));
    }
  }
  return {};
}

}  // namespace hvas::sequence
