#include "record/compression.h"

#include <algorithm>
#include <memory>

#include <zstd.h>

namespace hvas::record {
namespace {

// Above it a session takes hardly less room and the writer several times as long.
constexpr int kLevel = 3;

struct ContextEnd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

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
  constexpr int kMostWindow = 23;  // Logarithm of bytes: four times the window of kLevel.
  // Grows with what comes out of the block, from some times its size: a choice.
  constexpr std::size_t kUsualRatio = 8;
  const unsigned long long size = ZSTD_getFrameContentSize(block.data(), block.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR || size > limit) {
    return {};
  }
  const std::unique_ptr<ZSTD_DCtx, ContextEnd> context(ZSTD_createDCtx());
  if (context == nullptr ||
      ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kMostWindow)) != 0) {
    return {};
  }
  std::vector<std::byte> bytes(std::min<std::size_t>(size, kUsualRatio * block.size()));
  ZSTD_inBuffer from{block.data(), block.size(), 0};
  ZSTD_outBuffer to{bytes.data(), bytes.size(), 0};
  std::size_t left = 1;
  while (left != 0) {
    const std::size_t before = from.pos + to.pos;
    left = ZSTD_decompressStream(context.get(), &to, &from);
    if (ZSTD_isError(left) != 0) {
      return {};
    }
    if (left != 0 && to.pos == to.size && to.size < size) {
      bytes.resize(std::min<std::size_t>(size, 2 * to.size + kUsualRatio));
      to.dst = bytes.data();
      to.size = bytes.size();
    } else if (left != 0 && from.pos + to.pos == before) {
      return {};  // It is cut off, or has more than it says.
    }
  }
  return to.pos == size && from.pos == from.size ? bytes : std::vector<std::byte>();
}

std::vector<std::byte> DecompressTicks(std::span<const std::byte> block, std::size_t tick_size,
                                       std::size_t count) {
  const std::vector<std::byte> columns = Decompress(block, tick_size * count);
  return columns.size() == tick_size * count ? Transpose(columns, count) : std::vector<std::byte>();
}

}  // namespace hvas::record
