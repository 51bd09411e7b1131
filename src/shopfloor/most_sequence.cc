#include "shopfloor/most_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "shopfloor/motion_code.h"

namespace hvas::shopfloor {
namespace {

using orders::HandMotion;
using orders::MotionPurpose;

// The indices of BasicMOST that are used for tools.
constexpr std::array kIndices{0, 1, 3, 6, 10, 16, 24, 32, 42, 54};

/** The index of a way of the hand. @param distance  [m] */
int IndexOfWay(double distance) {
  constexpr double kHand = 0.05;     // A0 ends there, by its meaning [m].
  constexpr double kReach = 0.75;    // An arm with the trunk, as M7 of MODAPTS [m].
  constexpr double kTwoSteps = 1.9;  // Steps of some 0.6 m beyond that [m]: a choice.
  return distance <= kHand ? 0 : distance <= kReach ? 1 : distance <= kTwoSteps ? 3 : 6;
}

/** The least index whose time is no less. @param seconds  [s] */
int IndexOfTime(double seconds) {
  constexpr double kIndexSeconds = 10 * kTmuSeconds;  // BasicMOST has ten TMU for each index.
  const auto found = std::find_if(kIndices.begin(), kIndices.end(), [seconds](int index) {
    return index * kIndexSeconds >= seconds - 1e-9;
  });
  return found == kIndices.end() ? static_cast<int>(std::ceil(seconds / kIndexSeconds)) : *found;
}

/** Reads motions in their order, and closes a sequence when the next one begins. */
class SequenceMaker {
 public:
  void Add(const HandMotion& motion) {
    switch (motion.purpose) {
      case MotionPurpose::kGoTo:
        Close();
        has_part_ = true;
        way_ = IndexOfWay(motion.amount);
        grasp_ = 1;
        place_ = 1;
        break;
      case MotionPurpose::kGet:
        grasp_ = motion.mods > 1 ? 3 : grasp_;
        break;
      case MotionPurpose::kLoad:
        grasp_ = 3;
        break;
      case MotionPurpose::kPut:
        place_ = motion.mods >= orders::CalcPutMods(orders::PutCare::kExact)  ? 6
                 : motion.mods >= orders::CalcPutMods(orders::PutCare::kSome) ? 3
                                                                              : 1;
        break;
      case MotionPurpose::kPress:
        place_ = 6;
        break;
      case MotionPurpose::kReachIn:
        place_ = std::max(place_, 3);
        break;
      case MotionPurpose::kToolOn:
        has_tool_ = true;
        break;
      case MotionPurpose::kCrank:
        crank_ += orders::kModSeconds * motion.mods;
        break;
      case MotionPurpose::kTurnProduct:
        Push("A1 B0 G3 A1 B0 P3 A0", motion.purpose);
        break;
      case MotionPurpose::kHold:
        holds_ = true;
        break;
      case MotionPurpose::kOtherWay:
      case MotionPurpose::kGetTool:
      case MotionPurpose::kChangeTool:
      case MotionPurpose::kBring:
        break;  // The ways of part and tool have them.
    }
  }

  [[nodiscard]] std::vector<MostSequence> Take() {
    Close();
    return std::move(sequences_);
  }

 private:
  void Push(const std::string& code, MotionPurpose purpose) {
    sequences_.push_back({code, purpose, CalcMostSeconds(code).value_or(0)});
  }

  void Close() {
    if (has_part_) {
      Push(fmt::format("A{} B0 G{} A{} B0 P{} A0", way_, grasp_, way_, place_),
           MotionPurpose::kBring);
    }
    if (holds_) {
      Push("A1 B0 G1 A0 B0 P0 A0", MotionPurpose::kHold);
    }
    if (has_tool_ || crank_ > 0) {
      Push(fmt::format("A1 B0 G1 A1 B0 P3 F{} A1 B0 P1 A0", IndexOfTime(crank_)),
           MotionPurpose::kCrank);
    }
    has_part_ = false;
    holds_ = false;
    has_tool_ = false;
    crank_ = 0;
  }

  std::vector<MostSequence> sequences_;
  bool has_part_{false};
  bool holds_{false};
  bool has_tool_{false};
  int way_{1};
  int grasp_{1};
  int place_{1};
  double crank_{0};  // [s]
};

}  // namespace

std::vector<MostSequence> ListMostSequences(const std::vector<HandMotion>& motions) {
  SequenceMaker maker;
  for (const HandMotion& motion : motions) {
    maker.Add(motion);
  }
  return maker.Take();
}

double SumSeconds(const std::vector<MostSequence>& sequences) {
  double sum = 0;
  for (const MostSequence& sequence : sequences) {
    sum += sequence.seconds;
  }
  return sum;
}

}  // namespace hvas::shopfloor
