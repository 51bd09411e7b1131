#include "record/compression.h"

#include <zstd.h>

namespace hvas::record {
namespace {

// Above it a session takes hardly less room and the writer several times as long.
constexpr int kLevel = 3;

/** Gives rows of bytes as columns, or columns as rows. @param width  Of a row that is given. */
std::vector<std::byte> Transpose(std::span<const std::byte> rows, std::size_t width) {
  const std::size_t count = rows.size() / width;
  std::vector<std::byte> columns(rows.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      columns[k * count + i] = rows[i * width + k];
    }
  }
  return columns;
}

}  // namespace

std::vector<std::byte> Compress(std::span<const std::byte> bytes) {
  std::vector<std::byte> block(ZSTD_compressBound(bytes.size()));
  block.resize(ZSTD_compress(block.data(), block.size(), bytes.data(), bytes.size(), kLevel));
  return block;
}

std::vector<std::byte> Decompress(std::span<const std::byte> block, std::size_t limit) {
  const unsigned long long size = ZSTD_getFrameContentSize(block.data(), block.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR || size > limit) {
    return {};
  }
  std::vector<std::byte> bytes(size);
  if (ZSTD_decompress(bytes.data(), bytes.size(), block.data(), block.size()) != size) {
    return {};
  }
  return bytes;
}

std::vector<std::byte> DecompressTicks(std::span<const std::byte> block, std::size_t tick_size,
                                       std::size_t count) {
  const std::vector<std::byte> columns = Decompress(block, tick_size * count);
  return columns.size() == tick_size * count ? Transpose(columns, count) : std::vector<std::byte>();
}

}  // namespace hvas::record
