#include "device/drivers/reopener.h"

#include <chrono>

namespace hvas::device {

Reopener::Reopener(Reopenable* device, const Clock& clock)
    : device_(*device), clock_(clock), is_virtual_(&clock != &SystemClock()) {
  if (!is_virtual_) {
    thread_ = std::thread([this] { Run(); });
  }
}

Reopener::~Reopener() {
  {
    const std::scoped_lock lock(mutex_);
    stops_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

bool Reopener::IsThere() noexcept {
  if (is_virtual_ && is_gone_.load(std::memory_order_relaxed) && clock_.NowNs() >= retry_ns_) {
    retry_ns_ = clock_.NowNs() + kPeriodNs;
    is_gone_.store(!device_.Reopen(), std::memory_order_relaxed);
  }
  return !is_gone_.load(std::memory_order_acquire);
}

void Reopener::Run() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, std::chrono::nanoseconds(kPeriodNs), [this] { return stops_; })) {
    if (is_gone_.load(std::memory_order_acquire) && device_.Reopen()) {
      is_gone_.store(false, std::memory_order_release);
    }
  }
}

}  // namespace hvas::device
