#include "base/digest.h"

#include <bit>
#include <new>

#include <fmt/format.h>
#include <xxhash.h>

namespace hvas {

struct Digest::State {
  State() : xxh(XXH3_createState()) {
    if (xxh == nullptr) {
      throw std::bad_alloc();
    }
    XXH3_128bits_reset(xxh);
  }

  ~State() { XXH3_freeState(xxh); }

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  XXH3_state_t* xxh;
};

Digest::Digest() : state_(std::make_unique<State>()) {}

Digest::~Digest() = default;
Digest::Digest(Digest&&) noexcept = default;
Digest& Digest::operator=(Digest&&) noexcept = default;

void Digest::AddBytes(std::span<const std::byte> bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

void Digest::AddInt(std::int64_t value) {
  std::byte bytes[sizeof(value)];
  auto bits = static_cast<std::uint64_t>(value);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(bits & 0xffu);
    bits >>= 8;
  }
  AddBytes(bytes);
}

void Digest::AddDouble(double value) {
  AddInt(std::bit_cast<std::int64_t>(value));
}

void Digest::AddText(std::string_view text) {
  AddInt(static_cast<std::int64_t>(text.size()));
  AddBytes(std::as_bytes(std::span(text)));
}

std::string Digest::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::uint64_t Checksum64(std::span<const std::byte> bytes) noexcept {
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace hvas
