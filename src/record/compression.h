#pragma once

#include <cstddef>
#include <span>
#include <vector>

/** Blocks of bytes made small for the disk (Zstandard frames). */
namespace hvas::record {

[[nodiscard]] std::vector<std::byte> Compress(std::span<const std::byte> bytes);

/** Empty for anything but a block of Compress(), and for one of more than `limit` bytes. Takes any
 bytes: what a block says about its size takes no memory, only what comes out of it does. */
[[nodiscard]] std::vector<std::byte> Decompress(std::span<const std::byte> block,
                                                std::size_t limit);

/** The packed ticks, each of `tick_size` bytes, of a block of schema 3 or 4, which has the first
 bytes of all ticks, then all second bytes, and so on; empty where the block is not one of `count`
 ticks. Takes any bytes. */
[[nodiscard]] std::vector<std::byte> DecompressTicks(std::span<const std::byte> block,
                                                     std::size_t tick_size, std::size_t count);

}  // namespace hvas::record
