#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hvas {

/** A running 128-bit fingerprint of bytes (XXH3): equal input, equal digest, on every machine.

 Made to tell records apart, not to resist someone who forges them. Numbers go in as little-endian
 bytes; strings with their length, so that "ab", "c" differs from "a", "bc". */
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(Digest&&) noexcept;
  Digest& operator=(Digest&&) noexcept;

  void AddBytes(std::span<const std::byte> bytes);
  void AddInt(std::int64_t value);
  void AddDouble(double value);
  void AddText(std::string_view text);

  /** 32 lower-case hexadecimal digits of all that was added so far; adding may go on. */
  [[nodiscard]] std::string Hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/** 64-bit checksum (XXH3) of a block of bytes. */
[[nodiscard]] std::uint64_t Checksum64(std::span<const std::byte> bytes) noexcept;

}  // namespace hvas
