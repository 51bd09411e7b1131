#include "base/glb_container.h"

#include <cstdint>
#include <limits>

#include "base/bytes.h"

namespace hvas {

Result<std::string> PackGlb(std::string json, std::string_view binary) {
  constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
  constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
  // The head of glTF 2.0: magic, version, length; and of each chunk: length, type [bytes].
  constexpr std::uint32_t kVersion = 2;
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::size_t length =
      kHeader + kChunkHeader + json.size() + (binary.empty() ? 0 : kChunkHeader + binary.size());
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    return Fail(ErrorCode::kOutOfResource, "the meshes are larger than the 4 GiB of a .glb file",
                "", "write fewer or coarser meshes");
  }
  ByteWriter writer;
  for (const std::uint32_t word : {kMagic, kVersion, static_cast<std::uint32_t>(length),
                                   static_cast<std::uint32_t>(json.size()), kJsonChunk}) {
    writer.Plain(&word, 1);
  }
  writer.Plain(json.data(), json.size());
  if (!binary.empty()) {
    for (const std::uint32_t word : {static_cast<std::uint32_t>(binary.size()), kBinChunk}) {
      writer.Plain(&word, 1);
    }
    writer.Plain(binary.data(), binary.size());
  }
  return std::string(reinterpret_cast<const char*>(writer.bytes().data()), writer.bytes().size());
}

}  // namespace hvas
