#pragma once

#include <chrono>
#include <thread>

namespace hvas::testing {

/** Waits until a condition holds that other threads or processes bring about.
 @returns false when it does not hold within a minute. */
template <typename Condition>
[[nodiscard]] bool AwaitTrue(Condition&& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

}  // namespace hvas::testing
