#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "record/tick_record.h"

namespace hvas::record {

/** 1: ticks of one hand. 2: ticks of both, with all that the device told. 3: compressed, with
 commands, attachments and frames. 4: with seals. 5: ticks are predicted (tick_coding.h). 6: in
 the steps of their quantities. */
inline constexpr std::int64_t kSchemaVersion = 6;

/** Bytes of a tick in a file: its fields in order, little-endian, without gaps. */
inline constexpr std::size_t kPackedTickSize = 454;

/** Bytes of a tick in files of a schema; older ticks end earlier. @pre 1 <= schema, and known. */
[[nodiscard]] std::size_t PackedTickSize(std::int64_t schema) noexcept;

void Pack(const TickRecord& tick, std::span<std::byte, kPackedTickSize> bytes) noexcept;

/** @pre PackedTickSize(schema) bytes. */
[[nodiscard]] TickRecord Unpack(std::span<const std::byte> bytes, std::int64_t schema) noexcept;

[[nodiscard]] TickRecord Unpack(std::span<const std::byte, kPackedTickSize> bytes) noexcept;

/** What a number of a packed tick is: an integer of 1, 2, 4 or 8 bytes, or a real number. */
enum class PackedNumber : std::uint8_t { kByte, kShort, kInteger, kLong, kFloat, kDouble };

[[nodiscard]] constexpr std::size_t SizeOf(PackedNumber number) noexcept {
  constexpr std::array<std::size_t, 6> kSizes{1, 2, 4, 8, 4, 8};  // In the order of the kinds.
  return kSizes[static_cast<std::size_t>(number)];
}

/** The numbers of a packed tick of this schema, in their order. */
[[nodiscard]] std::vector<PackedNumber> ListPackedNumbers();

}  // namespace hvas::record
