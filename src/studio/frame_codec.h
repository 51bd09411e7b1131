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

/** One frame: header and items, as the protocol lays them out. Items are trivially copyable and
 the machine is little endian. */
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

/** All that a client's binary message says. */
struct ClientFrames {
  std::vector<protocol::HandInput> inputs;
  std::vector<protocol::Acknowledgement> credits;
};

/** Reads a client's message; passes over kinds that it does not know, by their size.
 Errors (kInvalid): not our frames, another version, a size that the message does not have, more
 items than a client has reason to send, a number that is not finite. */
[[nodiscard]] Result<ClientFrames> ReadClientFrames(std::string_view message);

}  // namespace hvas::studio
