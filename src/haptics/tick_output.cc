#include "haptics/tick_output.h"

namespace hvas::haptics {

const char* ToString(HoldState state) noexcept {
  switch (state) {
    case HoldState::kEmpty:
      return "empty";
    case HoldState::kFree:
      return "free";
    case HoldState::kNear:
      return "near";
    case HoldState::kCaptured:
      return "captured";
    case HoldState::kMating:
      return "mating";
    case HoldState::kSeated:
      return "seated";
  }
  return "unknown";
}

}  // namespace hvas::haptics
