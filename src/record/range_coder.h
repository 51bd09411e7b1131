#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/** Arithmetic coding of bits whose probabilities are learned: G. N. N. Martin, "Range encoding: an
 algorithm for removing redundancy from a digitised message", 1979, with bytes carried as in LZMA.
 Encoder and decoder have the same functions, so that one function can code in both directions. */
namespace hvas::record {

/** The probability of a bit, which follows the bits that come. */
class BitModel {
 public:
  static constexpr int kBits = 15;  ///< Bits of a probability: 16 bits hold it. A choice.

  [[nodiscard]] std::uint32_t of_zero() const noexcept { return of_zero_; }

  void Follow(bool bit) noexcept {
    constexpr int kRate = 4;  // A sixteenth of the way at a time: a choice, between fast and exact.
    constexpr std::uint32_t kOne = 1U << kBits;  // A probability of one.
    of_zero_ = bit ? of_zero_ - (of_zero_ >> kRate) : of_zero_ + ((kOne - of_zero_) >> kRate);
  }

 private:
  std::uint32_t of_zero_{1U << (kBits - 1)};
};

inline constexpr std::uint32_t kLeastRange = 1U << 24;  ///< Below it a byte is moved out.
inline constexpr int kMostBitsAtOnce = 12;              ///< Leaves as many bits of precision.

class RangeEncoder {
 public:
  void Code(BitModel* model, bool* bit) {
    const std::uint32_t bound = (range_ >> BitModel::kBits) * model->of_zero();
    if (*bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model->Follow(*bit);
    Normalise();
  }

  /** Codes `count` bits that are equally likely to be 0 and 1. */
  void CodeBits(int count, std::uint64_t* bits) {
    while (count > 0) {
      const int part = std::min(count, kMostBitsAtOnce);
      count -= part;
      range_ >>= part;
      low_ += range_ * (*bits >> count & ((1U << part) - 1U));
      Normalise();
    }
  }

  /** The bytes of all that was coded. Nothing may be coded afterwards. */
  [[nodiscard]] std::vector<std::byte> Finish() {
    constexpr int kBytesOfLow = 5;  // Those of its 32 bits and of the carry.
    for (int i = 0; i < kBytesOfLow; ++i) {
      MoveOut();
    }
    bytes_.erase(bytes_.begin());  // The one that waited before anything was coded.
    return std::move(bytes_);
  }

 private:
  void Normalise() {
    for (; range_ < kLeastRange; range_ <<= 8) {
      MoveOut();
    }
  }

  // The highest byte of `low_` waits, with those of 0xff after it, until it is clear whether there
  // is a carry.
  void MoveOut() {
    if (low_ < 0xff000000U || low_ > 0xffffffffU) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      for (; waiting_ > 0; --waiting_) {
        bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(first_ + carry)));
        first_ = 0xff;
      }
      first_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++waiting_;
    low_ = (low_ & 0x00ffffffU) << 8;
  }

  std::uint64_t low_{0};
  std::uint32_t range_{0xffffffffU};
  std::uint8_t first_{0};     // Of the bytes that wait.
  std::uint64_t waiting_{1};  // How many they are.
  std::vector<std::byte> bytes_;
};

/** Takes any bytes: those that nothing was encoded to give anything. */
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (std::size_t i = 0; i < sizeof(code_); ++i) {
      code_ = code_ << 8 | NextByte();
    }
  }

  void Code(BitModel* model, bool* bit) {
    const std::uint32_t bound = (range_ >> BitModel::kBits) * model->of_zero();
    *bit = code_ >= bound;
    if (*bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    model->Follow(*bit);
    Normalise();
  }

  void CodeBits(int count, std::uint64_t* bits) {
    *bits = 0;
    while (count > 0) {
      const int part = std::min(count, kMostBitsAtOnce);
      count -= part;
      range_ >>= part;
      const std::uint32_t value = std::min(code_ / range_, (1U << part) - 1U);
      code_ -= value * range_;
      *bits = *bits << part | value;
      Normalise();
    }
  }

  /** Whether exactly the bytes of an encoder were read. */
  [[nodiscard]] bool is_at_end() const noexcept { return at_ == bytes_.size(); }

 private:
  void Normalise() {
    for (; range_ < kLeastRange; range_ <<= 8) {
      code_ = code_ << 8 | NextByte();
    }
  }

  std::uint32_t NextByte() {
    const std::size_t at = at_++;
    return at < bytes_.size() ? static_cast<std::uint32_t>(bytes_[at]) : 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_{0};
  std::uint32_t code_{0};
  std::uint32_t range_{0xffffffffU};
};

}  // namespace hvas::record
