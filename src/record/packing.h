#pragma once

#include <cstddef>
#include <span>

#include "record/tick_record.h"

namespace hvas::record {

/** Bytes of a tick in a file: its fields in order, little-endian, without gaps. */
inline constexpr std::size_t kPackedTickSize = 450;
/** The same in files of schema 1: they end with the contacts. */
inline constexpr std::size_t kPackedTickSize1 = 407;

void Pack(const TickRecord& tick, std::span<std::byte, kPackedTickSize> bytes) noexcept;

[[nodiscard]] TickRecord Unpack(std::span<const std::byte, kPackedTickSize> bytes) noexcept;
[[nodiscard]] TickRecord Unpack1(std::span<const std::byte, kPackedTickSize1> bytes) noexcept;

}  // namespace hvas::record
