#include "cad/scene/zip_entry.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <zlib.h>

namespace hvas::cad {
namespace {

// APPNOTE.TXT of PKWARE, sections 4.3.7, 4.3.12 and 4.3.16.
constexpr std::uint32_t kEndSignature = 0x06054b50;
constexpr std::uint32_t kEntrySignature = 0x02014b50;
constexpr std::uint32_t kLocalSignature = 0x04034b50;
constexpr std::size_t kEndSize = 22;
constexpr std::size_t kEntrySize = 46;
constexpr std::size_t kLocalSize = 30;
constexpr std::size_t kMaxComment = 65535;

class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

  [[nodiscard]] bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }

  /** A little-endian number; 0 beyond the end. */
  [[nodiscard]] std::uint32_t Number(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = count; Has(at, count) && i > 0; --i) {
      value = value << 8 | std::to_integer<std::uint32_t>(bytes_[at + i - 1]);
    }
    return value;
  }

  [[nodiscard]] std::string_view Text(std::size_t at, std::size_t count) const {
    return Has(at, count)
               ? std::string_view(reinterpret_cast<const char*>(bytes_.data()) + at, count)
               : std::string_view();
  }

 private:
  std::span<const std::byte> bytes_;
};

std::optional<std::string> Inflate(std::string_view data, std::size_t limit) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
    return std::nullopt;
  }
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  std::string out;
  int status = Z_OK;
  while (status == Z_OK && out.size() <= limit) {
    constexpr std::size_t kStep = 1 << 18;  // [bytes] by which the output grows: a choice.
    const std::size_t before = out.size();
    out.resize(before + kStep);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = static_cast<uInt>(kStep);
    status = inflate(&stream, Z_NO_FLUSH);
    out.resize(before + kStep - stream.avail_out);
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END && out.size() <= limit ? std::optional(std::move(out))
                                                       : std::nullopt;
}

std::optional<std::string> ReadEntry(const Bytes& bytes, std::size_t entry, std::size_t limit) {
  const std::uint32_t method = bytes.Number(entry + 10, 2);
  const std::uint32_t packed_size = bytes.Number(entry + 20, 4);
  const std::uint32_t local = bytes.Number(entry + 42, 4);
  if (bytes.Number(local, 4) != kLocalSignature) {
    return std::nullopt;
  }
  const std::size_t data =
      std::size_t{local} + kLocalSize + bytes.Number(local + 26, 2) + bytes.Number(local + 28, 2);
  if (!bytes.Has(data, packed_size)) {
    return std::nullopt;
  }
  const std::string_view packed = bytes.Text(data, packed_size);
  std::optional<std::string> content;
  if (method == 0 && packed.size() <= limit) {
    content = std::string(packed);
  } else if (method == Z_DEFLATED) {
    content = Inflate(packed, limit);
  }
  const bool is_whole = content && crc32_z(0, reinterpret_cast<const Bytef*>(content->data()),
                                           content->size()) == bytes.Number(entry + 16, 4);
  return is_whole ? std::move(content) : std::nullopt;
}

/** Visits the entries of the directory, by their places in the bytes, until a visit returns true.
 */
template <typename Visit>
void VisitEntries(const Bytes& bytes, const Visit& visit) {
  if (bytes.size() < kEndSize) {
    return;
  }
  std::size_t end = bytes.size() - kEndSize;
  const std::size_t first = end - std::min(end, kMaxComment);
  while (end > first && bytes.Number(end, 4) != kEndSignature) {
    --end;
  }
  const std::uint32_t count = bytes.Number(end + 10, 2);
  std::size_t entry = bytes.Number(end + 16, 4);
  for (std::uint32_t i = 0; i < count && bytes.Number(entry, 4) == kEntrySignature; ++i) {
    const std::uint32_t name_size = bytes.Number(entry + 28, 2);
    if (visit(entry, bytes.Text(entry + kEntrySize, name_size))) {
      return;
    }
    entry += kEntrySize + name_size + bytes.Number(entry + 30, 2) + bytes.Number(entry + 32, 2);
  }
}

}  // namespace

std::optional<std::string> ReadZipEntry(std::span<const std::byte> archive,
                                        const std::function<bool(std::string_view name)>& pleases,
                                        std::size_t limit) {
  const Bytes bytes(archive);
  std::optional<std::string> content;
  VisitEntries(bytes, [&](std::size_t entry, std::string_view name) {
    const bool is_it = pleases(name);
    if (is_it) {
      content = ReadEntry(bytes, entry, limit);
    }
    return is_it;
  });
  return content;
}

std::uint64_t SumUnpackedSizes(std::span<const std::byte> archive) {
  const Bytes bytes(archive);
  std::uint64_t sum = 0;
  VisitEntries(bytes, [&](std::size_t entry, std::string_view /*name*/) {
    sum += bytes.Number(entry + 24, 4);
    return false;
  });
  return sum;
}

}  // namespace hvas::cad
