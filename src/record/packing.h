#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "record/tick_record.h"

namespace hvas::record {

/** 1: ticks of one hand. 2: ticks of both, with all that the device told. 3: compressed, with
 commands, attachments and frames. 4: with seals. */
inline constexpr std::int64_t kSchemaVersion = 4;

/** Bytes of a tick in a file: its fields in order, little-endian, without gaps. */
inline constexpr std::size_t kPackedTickSize = 454;

/** Bytes of a tick in files of a schema; older ticks end earlier. @pre 1 <= schema, and known. */
[[nodiscard]] std::size_t PackedTickSize(std::int64_t schema) noexcept;

void Pack(const TickRecord& tick, std::span<std::byte, kPackedTickSize> bytes) noexcept;

/** @pre PackedTickSize(schema) bytes. */
[[nodiscard]] TickRecord Unpack(std::span<const std::byte> bytes, std::int64_t schema) noexcept;

[[nodiscard]] TickRecord Unpack(std::span<const std::byte, kPackedTickSize> bytes) noexcept;

}  // namespace hvas::record
