#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace hvas {

/** Hands the newest value from one writer thread to one reader thread; wait-free on both sides.

 Values that the reader was too slow for are overwritten, and a value is never torn: each side owns
 one of three slots and swaps it for the one in the middle. Write() and Publish() belong to the
 writer, Update() and value() to the reader. RT-safe when T's assignment is. */
template <typename T>
class TripleBuffer {
 public:
  TripleBuffer() = default;

  explicit TripleBuffer(const T& initial) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}

  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /** The writer's slot, to be filled in place. It holds an older value, not the last one. */
  [[nodiscard]] T& back() noexcept { return slots_[back_].value; }

  /** Makes what is in back() the newest value. */
  void Publish() noexcept {
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndexMask;
  }

  void Write(const T& value) noexcept(noexcept(std::declval<T&>() = value)) {
    back() = value;
    Publish();
  }

  /** Takes the newest value if there is one since the last call; returns whether there was. */
  bool Update() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
      return false;
    }
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndexMask;
    return true;
  }

  /** What the last Update() took; the initial value before the first. */
  [[nodiscard]] const T& value() const noexcept { return slots_[front_].value; }

 private:
  // The lowest two bits of `middle_` are the slot, the third says that nobody has read it.
  static constexpr std::uint32_t kIndexMask = 3;
  static constexpr std::uint32_t kFresh = 4;
  static constexpr std::size_t kCacheLine = 64;  ///< Bytes, of x86-64 and most ARM.

  struct alignas(kCacheLine) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(kCacheLine) std::uint32_t back_{0};                 // The writer's slot.
  alignas(kCacheLine) std::atomic<std::uint32_t> middle_{1};  // Index and freshness.
  alignas(kCacheLine) std::uint32_t front_{2};                // The reader's slot.
};

}  // namespace hvas
