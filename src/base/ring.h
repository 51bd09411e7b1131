#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <utility>

namespace hvas {

/** A queue of fixed capacity from one writer thread to one reader thread; wait-free on both sides.

 When it is full, the new value is refused and counted: nothing that was accepted is ever lost. The
 constructor allocates; the rest is RT-safe when T's assignment is. */
template <typename T>
class Ring {  // NOLINT(clang-analyzer-optin.performance.Padding): each side has its cache line.
 public:
  /** Holds at least `capacity` values (rounded up to a power of two). */
  explicit Ring(std::size_t capacity)
      : mask_(std::bit_ceil(capacity < 2 ? std::size_t{2} : capacity) - 1),
        slots_(std::make_unique<T[]>(mask_ + 1)) {}

  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;

  /** Writer: appends a value, or counts a drop and returns false when the ring is full.
   @param reserve  How many values more the ring must have room for, or it counts as full: room that
   is kept for values that must not be lost. */
  bool TryPush(const T& value,
               std::size_t reserve = 0) noexcept(noexcept(std::declval<T&>() = value)) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_seen_ + reserve > mask_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail - head_seen_ + reserve > mask_) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return false;
      }
    }
    slots_[tail & mask_] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /** Reader: takes the oldest value, or returns false when there is none. */
  bool TryPop(T* value) noexcept(noexcept(*value = std::move(std::declval<T&>()))) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_seen_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head == tail_seen_) {
        return false;
      }
    }
    *value = std::move(slots_[head & mask_]);
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }

  /** Values refused so far; may be read from any thread. */
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  /** Bytes, of x86-64 and most ARM: no false sharing. */
  static constexpr std::size_t kCacheLine = 64;

  const std::size_t mask_;
  const std::unique_ptr<T[]> slots_;
  // The writer's line: its own end, and the reader's end as it last saw it.
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};
  std::uint64_t head_seen_{0};
  std::atomic<std::uint64_t> dropped_{0};
  // The reader's line, likewise.
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};
  std::uint64_t tail_seen_{0};
};

}  // namespace hvas
