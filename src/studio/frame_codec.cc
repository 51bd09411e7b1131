#include "studio/frame_codec.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace hvas::studio {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are little endian");

constexpr std::uint32_t kMaxItems = 64;  // Hands and clients of a message: a choice.

Error Refuse(const std::string& what) {
  return {ErrorCode::kInvalid, what, "frame from a client", "reload the page"};
}

template <typename Item>
Result<std::vector<Item>> ReadItems(const protocol::Header& header, std::string_view body) {
  if (header.count > kMaxItems || body.size() != header.count * sizeof(Item)) {
    return Unexpected(Refuse(fmt::format("{} items in {} bytes", header.count, body.size())));
  }
  std::vector<Item> items(header.count);
  if (!items.empty()) {
    std::memcpy(items.data(), body.data(), body.size());
  }
  return items;
}

bool IsFinite(const protocol::HandInput& input) {
  bool is_finite = std::isfinite(input.client_ms);
  for (const float value : input.p_WH_m) {
    is_finite = is_finite && std::isfinite(value);
  }
  float norm_sq = 0;
  for (const float value : input.q_WH) {
    is_finite = is_finite && std::isfinite(value);
    norm_sq += value * value;
  }
  // Error of a quaternion's squared length, in single precision: a choice.
  constexpr float kSlack = 0.1F;
  return is_finite && std::abs(norm_sq - 1) < kSlack;
}

Result<void> AddFrame(const protocol::Header& header, std::string_view body, ClientFrames* frames) {
  switch (static_cast<protocol::FrameKind>(header.kind)) {
    case protocol::FrameKind::kInput: {
      auto items = ReadItems<protocol::HandInput>(header, body);
      if (!items) {
        return Unexpected(items.error());
      }
      for (const protocol::HandInput& input : *items) {
        if (!IsFinite(input)) {
          return Unexpected(Refuse("the pose is not finite, or its quaternion is not of length 1"));
        }
        frames->inputs.push_back(input);
      }
      return {};
    }
    case protocol::FrameKind::kCredit: {
      auto items = ReadItems<protocol::Acknowledgement>(header, body);
      if (!items) {
        return Unexpected(items.error());
      }
      frames->credits.insert(frames->credits.end(), items->begin(), items->end());
      return {};
    }
    default:
      return {};
  }
}

}  // namespace

Result<ClientFrames> ReadClientFrames(std::string_view message) {
  ClientFrames frames;
  while (!message.empty()) {
    protocol::Header header;
    if (message.size() < sizeof(header)) {
      return Unexpected(Refuse(fmt::format("{} bytes are too short for a header", message.size())));
    }
    std::memcpy(&header, message.data(), sizeof(header));
    if (header.magic != protocol::kMagic) {
      return Unexpected(Refuse("the message does not begin with HVAS"));
    }
    if (header.version != protocol::kVersion) {
      return Unexpected(Refuse(fmt::format("the header has version {} instead of {}",
                                           header.version, protocol::kVersion)));
    }
    if (header.size < sizeof(header) || header.size > message.size()) {
      return Unexpected(Refuse(fmt::format(
          "the header has a size of {} bytes, but {} were received", header.size, message.size())));
    }
    const auto added =
        AddFrame(header, message.substr(sizeof(header), header.size - sizeof(header)), &frames);
    if (!added) {
      return Unexpected(added.error());
    }
    message.remove_prefix(header.size);
  }
  return frames;
}

}  // namespace hvas::studio
