#include "device/drivers/network_protocol.h"

#define OPENSSL_SUPPRESS_DEPRECATED  // SHA-256 on plain memory; EVP's allocates for each packet
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>
#include <type_traits>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include "base/bytes.h"
#include "device/drivers/polled_guard.h"

namespace hvas::device::network {
namespace {

constexpr std::size_t kBlock = 64;  // of SHA-256 [bytes]
constexpr std::size_t kHash = 32;   // [bytes] of SHA-256.

// The figures of a profile in the order of Hello::limits; the workspace's edges follow.
constexpr std::array kLimits{
    &DeviceProfile::max_force,
    &DeviceProfile::continuous_force,
    &DeviceProfile::max_torque,
    &DeviceProfile::continuous_torque,
    &DeviceProfile::max_stiffness,
    &DeviceProfile::max_damping,
    &DeviceProfile::max_rotational_stiffness,
    &DeviceProfile::max_rotational_damping,
    &DeviceProfile::position_resolution,
    &DeviceProfile::rotation_resolution,
    &DeviceProfile::rate_hz,
    &DeviceProfile::delay,
};
constexpr std::size_t kEdges = kLimits.size();  // The workspace's edges follow the limits.
static_assert(kEdges + 3 == std::tuple_size_v<decltype(Hello::limits)>);

// Each packet's members in the order of the wire, for a reader and a writer.
template <typename Archive, typename T, std::size_t kSize>
void Array(Archive& archive, std::array<T, kSize>& values) {
  archive.Plain(values.data(), kSize);
}

template <typename Archive>
void Fields(Archive& archive, Hello& hello) {
  archive.Plain(&hello.nonce, 1);
  archive.Plain(&hello.flags, 1);
  archive.Plain(&hello.force_axes, 1);
  archive.Plain(&hello.torque_axes, 1);
  archive.Plain(&hello.button_count, 1);
  Array(archive, hello.model);
  Array(archive, hello.serial);
  Array(archive, hello.version);
  Array(archive, hello.limits);
}

template <typename Archive>
void Fields(Archive& archive, Welcome& welcome) {
  archive.Plain(&welcome.nonce, 1);
}

template <typename Archive>
void Fields(Archive& archive, StatePacket& state) {
  Array(archive, state.p);
  Array(archive, state.q);
  Array(archive, state.v);
  Array(archive, state.w);
  archive.Plain(&state.grip, 1);
  archive.Plain(&state.buttons, 1);
  archive.Plain(&state.vendor_code, 1);
  archive.Plain(&state.condition, 1);
  archive.Plain(&state.reserved, 1);
  archive.Plain(&state.wrench_count, 1);
  archive.Plain(&state.wrench_sequence, 1);
  archive.Plain(&state.wrench_t_ns, 1);
}

template <typename Archive>
void Fields(Archive& archive, WrenchPacket& wrench) {
  Array(archive, wrench.t);
  Array(archive, wrench.f);
  archive.Plain(&wrench.state_sequence, 1);
}

template <typename Archive>
void Fields(Archive&, Bye&) {}

template <typename Body>
bool ReadBody(const Opened& opened, PacketType type, Body* body) noexcept {
  if (opened.refusal != Refusal::kNone || opened.header.type != type) {
    return false;
  }
  ByteReader reader(opened.body);
  Fields(reader, *body);
  return reader.is_finished();
}

void Absorb(SHA256_CTX* hash, const void* bytes, std::size_t size) noexcept {
  ::SHA256_Update(hash, bytes, size);
}

template <std::size_t kSize>
std::array<char, kSize> Padded(const std::string& text) {
  std::array<char, kSize> padded{};
  std::copy_n(text.begin(), std::min(text.size(), kSize - 1), padded.begin());
  return padded;
}

template <std::size_t kSize>
std::string TextOf(const std::array<char, kSize>& padded) {
  return {padded.begin(), std::find(padded.begin(), padded.end(), '\0')};
}

}  // namespace

/** Puts a packet together in its own bytes. */
class PacketWriter {
 public:
  explicit PacketWriter(Packet* packet) : packet_(*packet) {}

  template <typename T>
  void Plain(const T* values, std::size_t count) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(packet_.bytes_.data() + packet_.size_, values, count * sizeof(T));
    packet_.size_ += count * sizeof(T);
  }

  void SetSize(std::size_t at) noexcept {
    const auto size = static_cast<std::uint16_t>(packet_.size_ + kTagSize);
    std::memcpy(packet_.bytes_.data() + at, &size, sizeof(size));
  }

 private:
  Packet& packet_;
};

namespace {

constexpr std::size_t kSizeAt = 6;  // of the packet's size in the header

template <typename Body>
Packet SealBody(const PacketKey& key, const Header& header, PacketType type, Body body) noexcept {
  Packet packet;
  PacketWriter writer(&packet);
  const std::uint16_t size = 0;  // set below
  writer.Plain(&kMagic, 1);
  writer.Plain(&kVersion, 1);
  writer.Plain(&type, 1);
  writer.Plain(&size, 1);
  writer.Plain(&header.session, 1);
  writer.Plain(&header.sequence, 1);
  writer.Plain(&header.t_ns, 1);
  Fields(writer, body);
  writer.SetSize(kSizeAt);
  const PacketKey::Tag tag = key.Sign(packet.bytes());
  writer.Plain(tag.data(), tag.size());
  return packet;
}

}  // namespace

PacketKey::PacketKey(std::string_view secret) {
  static_assert(sizeof(SHA256_CTX) == kStateSize);
  std::array<unsigned char, kBlock> block{};
  if (secret.size() > kBlock) {
    ::SHA256(reinterpret_cast<const unsigned char*>(secret.data()), secret.size(), block.data());
  } else {
    std::copy(secret.begin(), secret.end(), block.begin());
  }
  const auto start = [&block](unsigned char pad, std::array<std::byte, kStateSize>* state) {
    std::array<unsigned char, kBlock> padded = block;
    for (unsigned char& byte : padded) {
      byte = static_cast<unsigned char>(byte ^ pad);
    }
    SHA256_CTX hash;
    ::SHA256_Init(&hash);
    Absorb(&hash, padded.data(), padded.size());
    std::memcpy(state->data(), &hash, sizeof(hash));
  };
  start(0x36, &inner_);
  start(0x5c, &outer_);
}

PacketKey::Tag PacketKey::Sign(std::span<const std::byte> bytes) const noexcept {
  SHA256_CTX hash;
  std::array<unsigned char, kHash> digest;
  std::memcpy(&hash, inner_.data(), sizeof(hash));
  Absorb(&hash, bytes.data(), bytes.size());
  ::SHA256_Final(digest.data(), &hash);
  std::memcpy(&hash, outer_.data(), sizeof(hash));
  Absorb(&hash, digest.data(), digest.size());
  ::SHA256_Final(digest.data(), &hash);
  Tag tag;
  std::memcpy(tag.data(), digest.data(), tag.size());
  return tag;
}

bool PacketKey::IsGenuine(std::span<const std::byte> bytes, const Tag& tag) const noexcept {
  const Tag expected = Sign(bytes);
  return ::CRYPTO_memcmp(expected.data(), tag.data(), tag.size()) == 0;
}

Packet Seal(const PacketKey& key, Header header, const Hello& hello) noexcept {
  return SealBody(key, header, PacketType::kHello, hello);
}

Packet Seal(const PacketKey& key, Header header, const Welcome& welcome) noexcept {
  return SealBody(key, header, PacketType::kWelcome, welcome);
}

Packet Seal(const PacketKey& key, Header header, const StatePacket& state) noexcept {
  return SealBody(key, header, PacketType::kState, state);
}

Packet Seal(const PacketKey& key, Header header, const WrenchPacket& wrench) noexcept {
  return SealBody(key, header, PacketType::kWrench, wrench);
}

Packet Seal(const PacketKey& key, Header header, const Bye& bye) noexcept {
  return SealBody(key, header, PacketType::kBye, bye);
}

Opened Open(const PacketKey& key, std::span<const std::byte> bytes) noexcept {
  Opened opened;
  if (bytes.size() < kHeaderSize + kTagSize || bytes.size() > kMaxPacket) {
    return opened;
  }
  ByteReader reader(bytes);
  std::uint32_t magic = 0;
  std::uint8_t version = 0;
  std::uint16_t size = 0;
  reader.Plain(&magic, 1);
  reader.Plain(&version, 1);
  reader.Plain(&opened.header.type, 1);
  reader.Plain(&size, 1);
  reader.Plain(&opened.header.session, 1);
  reader.Plain(&opened.header.sequence, 1);
  reader.Plain(&opened.header.t_ns, 1);
  if (magic != kMagic) {
    return opened;
  }
  if (version != kVersion) {
    opened.refusal = Refusal::kOtherVersion;
    return opened;
  }
  if (size != bytes.size()) {
    return opened;
  }
  PacketKey::Tag tag;
  std::memcpy(tag.data(), bytes.data() + bytes.size() - kTagSize, kTagSize);
  if (!key.IsGenuine(bytes.first(bytes.size() - kTagSize), tag)) {
    opened.refusal = Refusal::kForged;
    return opened;
  }
  opened.body = bytes.subspan(kHeaderSize, bytes.size() - kHeaderSize - kTagSize);
  opened.refusal = Refusal::kNone;
  return opened;
}

bool Read(const Opened& opened, Hello* hello) noexcept {
  return ReadBody(opened, PacketType::kHello, hello);
}

bool Read(const Opened& opened, Welcome* welcome) noexcept {
  return ReadBody(opened, PacketType::kWelcome, welcome);
}

bool Read(const Opened& opened, StatePacket* state) noexcept {
  return ReadBody(opened, PacketType::kState, state);
}

bool Read(const Opened& opened, WrenchPacket* wrench) noexcept {
  return ReadBody(opened, PacketType::kWrench, wrench);
}

bool Read(const Opened& opened, Bye* bye) noexcept {
  return ReadBody(opened, PacketType::kBye, bye);
}

Refusal SequenceWindow::Take(std::uint64_t sequence) noexcept {
  if (sequence > newest_) {
    const std::uint64_t step = sequence - newest_;
    seen_ = (step < kWidth ? seen_ << step : 0) | 1;
    newest_ = sequence;
    ++seen_count_;
    return Refusal::kNone;
  }
  const std::uint64_t age = newest_ - sequence;
  if (sequence == 0 || age >= kWidth || ((seen_ >> age) & 1) != 0) {
    return Refusal::kReplayed;
  }
  seen_ |= std::uint64_t{1} << age;
  ++seen_count_;
  return Refusal::kLate;
}

DeviceInfo InfoOf(const Hello& hello, const std::string& address) {
  const auto has = [&hello](HelloFlag flag) { return (hello.flags & flag) != 0; };
  DeviceInfo info;
  info.driver = "network";
  info.address = fmt::format("network:{}", address);
  info.model = TextOf(hello.model);
  info.serial = TextOf(hello.serial);
  info.version = TextOf(hello.version);
  info.is_emulated = has(kIsEmulated);
  info.capabilities.force_axes = hello.force_axes;
  info.capabilities.torque_axes = hello.torque_axes;
  info.capabilities.senses_rotation = has(kSensesRotation);
  info.capabilities.has_grip = has(kHasGrip);
  info.capabilities.has_presence_switch = has(kHasPresenceSwitch);
  info.capabilities.has_emergency_stop = has(kHasEmergencyStop);
  info.capabilities.button_count = hello.button_count;
  info.profile = FindProfile("network")->profile;
  for (std::size_t i = 0; i < hello.limits.size(); ++i) {
    if (hello.limits[i] != 0) {
      double& figure = i < kEdges ? info.profile.*kLimits[i]
                                  : info.profile.workspace[static_cast<Eigen::Index>(i - kEdges)];
      figure = hello.limits[i];
    }
  }
  if (hello.force_axes == 0) {
    info.profile.max_force = info.profile.continuous_force = 0;
  }
  if (hello.torque_axes == 0) {
    info.profile.max_torque = info.profile.continuous_torque = 0;
  }
  // HVAS's own continuous limits stand in for those that the device does not know.
  if (hello.limits[1] == 0) {
    info.profile.continuous_force = std::min(info.profile.continuous_force, info.profile.max_force);
  }
  if (hello.limits[3] == 0) {
    info.profile.continuous_torque =
        std::min(info.profile.continuous_torque, info.profile.max_torque);
  }
  info.profile_note = "limits, workspace, resolution, rate and delay are as reported by the device";
  return info;
}

Hello HelloOf(const DeviceInfo& info, std::uint64_t nonce) {
  const auto flag = [](bool has, HelloFlag bit) { return has ? std::uint32_t{bit} : 0U; };
  const Capabilities& can = info.capabilities;
  Hello hello;
  hello.nonce = nonce;
  hello.flags = flag(can.senses_rotation, kSensesRotation) | flag(can.has_grip, kHasGrip) |
                flag(can.has_presence_switch, kHasPresenceSwitch) |
                flag(can.has_emergency_stop, kHasEmergencyStop) |
                flag(info.is_emulated, kIsEmulated);
  hello.force_axes = static_cast<std::uint8_t>(can.force_axes);
  hello.torque_axes = static_cast<std::uint8_t>(can.torque_axes);
  hello.button_count = static_cast<std::uint16_t>(can.button_count);
  hello.model = Padded<32>(info.model);
  hello.serial = Padded<32>(info.serial);
  hello.version = Padded<16>(info.version);
  for (std::size_t i = 0; i < kEdges; ++i) {
    hello.limits[i] = info.profile.*kLimits[i];
  }
  std::copy_n(info.profile.workspace.data(), 3, hello.limits.begin() + kEdges);
  return hello;
}

DeviceState StateOf(const StatePacket& packet) noexcept {
  const auto& q = packet.q;
  DeviceState state;
  state.X_DH = PoseFromWire(Quat(q[0], q[1], q[2], q[3]), Vec3(packet.p.data()));
  state.V_DH = {Vec3(packet.w.data()), Vec3(packet.v.data())};
  state.buttons = packet.buttons;
  state.grip = packet.grip;
  state.vendor_code = packet.vendor_code;
  state.condition = packet.condition <= static_cast<std::uint32_t>(Condition::kFault)
                        ? static_cast<Condition>(packet.condition)
                        : Condition::kFault;
  return state;
}

}  // namespace hvas::device::network
