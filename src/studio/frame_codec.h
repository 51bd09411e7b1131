#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "studio/protocol.h"

namespace hvas::studio {

/** Appends one frame to a binary message: header and items in the layout of docs/protocol.md, for
 which items have to be trivially copyable and the machine little endian. */
template <typename Item>
void AppendFrame(std::span<const Item> items, std::uint32_t seq, std::uint32_t epoch,
                 std::int64_t t_ns, std::string* bytes) {
  protocol::Header header;
  header.magic = protocol::kMagic;
  header.version = protocol::kVersion;
  header.kind = static_cast<std::uint16_t>(protocol::kKindOf<Item>);
  header.size = static_cast<std::uint32_t>(sizeof(header) + items.size_bytes());
  header.seq = seq;
  header.epoch = epoch;
  header.count = static_cast<std::uint32_t>(items.size());
  header.t_ns = t_ns;
  bytes->append(reinterpret_cast<const char*>(&header), sizeof(header));
  if (!items.empty()) {
    bytes->append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
  }
}

/** Content of a client's binary message. */
struct ClientFrames {
  std::vector<protocol::HandInput> inputs;
  std::vector<protocol::Acknowledgement> credits;
};

/** Reads a client's binary message; frames of unknown kinds are skipped by their size.
 Errors: kInvalid for a wrong magic number or version, a size beyond the end of the message, more
 items than a client has reason to send, or a number that is not finite. */
[[nodiscard]] Result<ClientFrames> ReadClientFrames(std::string_view message);

}  // namespace hvas::studio
