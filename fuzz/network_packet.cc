// Packets of the network device: bytes from anybody, and bytes that somebody with the key signed.
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "device/driver.h"
#include "device/drivers/network_protocol.h"
#include "fuzz/target.h"

namespace hvas::fuzz {
namespace {

using device::network::Opened;
using device::network::Refusal;

/** A tag that is right, on whatever is there. */
std::string Signed(std::string_view bytes, const device::network::PacketKey& key) {
  using namespace device::network;
  std::string packet(bytes.substr(0, kMaxPacket - kTagSize));
  const auto size = static_cast<std::uint16_t>(packet.size() + kTagSize);
  if (packet.size() >= kHeaderSize) {
    std::memcpy(packet.data() + 6, &size, sizeof(size));
  }
  const PacketKey::Tag tag = key.Sign(std::as_bytes(std::span(packet)));
  packet.append(reinterpret_cast<const char*>(tag.data()), tag.size());
  return packet;
}

void ReadAll(const Opened& opened) {
  using namespace device::network;
  Hello hello;
  Welcome welcome;
  StatePacket state;
  WrenchPacket wrench;
  Bye bye;
  const int readable = static_cast<int>(Read(opened, &hello)) + Read(opened, &welcome) +
                       Read(opened, &state) + Read(opened, &wrench) + Read(opened, &bye);
  Check(readable <= (opened.refusal == Refusal::kNone ? 1 : 0));
  const bool is_hello = Read(opened, &hello);
  const device::DeviceInfo info = InfoOf(hello, "");
  if (is_hello && device::CheckInfo(info)) {
    Check(info.profile.max_force >= info.profile.continuous_force);
    Check(info.profile.rate_hz > 0 && info.profile.workspace.minCoeff() > 0);
  }
  if (Read(opened, &state)) {
    (void)StateOf(state);
    SequenceWindow window;
    Check((window.Take(opened.header.sequence) == Refusal::kNone) == (opened.header.sequence > 0));
    Check(window.Take(opened.header.sequence) == Refusal::kReplayed);
  }
}

}  // namespace

void TestOne(std::string_view bytes) {
  const device::network::PacketKey other("some other secret");
  const device::network::PacketKey key("the fuzzers' secret");
  const auto data = std::as_bytes(std::span(bytes));
  Check(device::network::Open(other, data).refusal != Refusal::kNone);
  ReadAll(device::network::Open(key, data));
  const std::string packet = Signed(bytes, key);
  ReadAll(device::network::Open(key, std::as_bytes(std::span(packet))));
}

}  // namespace hvas::fuzz
