#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hvas::record {

/** Compresses ticks as this schema packs them, without loss: each number is predicted from the
 ticks before and from the numbers before it in its own tick, and an arithmetic coder takes what is
 left (docs/record.md, "Compression of ticks").
 @pre a whole number of ticks. */
[[nodiscard]] std::vector<std::byte> EncodeTicks(std::span<const std::byte> packed);

/** The packed ticks; empty where the block is not one of `count` ticks. Takes any bytes.
 @param schema  Of the file, 5 or newer. */
[[nodiscard]] std::vector<std::byte> DecodeTicks(std::span<const std::byte> block,
                                                 std::size_t count, std::int64_t schema);

}  // namespace hvas::record
