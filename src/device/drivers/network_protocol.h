#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "device/device.h"

/** The packets of the network device, version 1 (docs/devices/network.md is their specification).
 Everything here is RT-safe but where it says otherwise. */
namespace hvas::device::network {

inline constexpr std::uint32_t kMagic = 0x504E5648;  // "HVNP" as it lies there
// Sizes in bytes, of version 1 of the protocol: half of an HMAC is the tag, as RFC 2104 allows.
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kHeaderSize = 32;
inline constexpr std::size_t kTagSize = 16;
inline constexpr std::size_t kMaxPacket = 512;
inline constexpr std::size_t kMinKey = 16;

enum class PacketType : std::uint8_t {
  kHello = 1,
  kWelcome = 2,
  kState = 3,
  kWrench = 4,
  kBye = 5
};

struct Header {
  PacketType type{PacketType::kHello};
  std::uint64_t session{0};   ///< 0 in a hello.
  std::uint64_t sequence{0};  ///< Counts from 1 in each session and direction.
  std::int64_t t_ns{0};       ///< Time of the sender's clock.
};

/** A device says what it is. */
struct Hello {
  std::uint64_t nonce{0};  ///< Anew for each hello; the welcome has it again.
  std::uint32_t flags{0};  ///< HelloFlag
  std::uint8_t force_axes{0};
  std::uint8_t torque_axes{0};
  std::uint16_t button_count{0};
  std::array<char, 32> model{};
  std::array<char, 32> serial{};
  std::array<char, 16> version{};
  std::array<double, 15> limits{};  ///< What ProfileOf takes.
};

enum HelloFlag : std::uint32_t {
  kSensesRotation = 1,
  kHasGrip = 2,
  kHasPresenceSwitch = 4,
  kHasEmergencyStop = 8,
  kIsEmulated = 16,
};

/** HVAS takes a device in; its session is in the header. */
struct Welcome {
  std::uint64_t nonce{0};
};

/** HVAS lets go of the device, which shows no force from then on. */
struct Bye {};

/** A sample, and what became of the wrenches. */
struct StatePacket {
  std::array<double, 3> p{};            ///< [m]
  std::array<double, 4> q{1, 0, 0, 0};  ///< w, x, y, z
  std::array<double, 3> v{};            ///< [m/s]
  std::array<double, 3> w{};            ///< [rad/s]
  double grip{0};
  std::uint32_t buttons{0};
  std::int32_t vendor_code{0};
  std::uint32_t condition{0};  ///< A value of Condition.
  std::uint32_t reserved{0};
  std::uint64_t wrench_count{0};     ///< That arrived in this session.
  std::uint64_t wrench_sequence{0};  ///< Sequence of the wrench that the motors show; 0: none yet.
  std::int64_t wrench_t_ns{0};       ///< That it carried, on HVAS's clock.
};

struct WrenchPacket {
  std::array<double, 3> t{};        ///< [N m]
  std::array<double, 3> f{};        ///< [N]
  std::uint64_t state_sequence{0};  ///< Sequence of the newest state that HVAS has.
};

/** The secret of both sides: HMAC-SHA-256 (RFC 2104, FIPS 180-4) cut to 16 bytes. Works on plain
 memory, as OpenSSL's own HMAC allocates for each packet. */
class PacketKey {
 public:
  /** Not RT-safe. A secret of fewer than kMinKey bytes can be guessed. */
  explicit PacketKey(std::string_view secret);

  using Tag = std::array<std::byte, kTagSize>;
  [[nodiscard]] Tag Sign(std::span<const std::byte> bytes) const noexcept;
  [[nodiscard]] bool IsGenuine(std::span<const std::byte> bytes, const Tag& tag) const noexcept;

 private:
  static constexpr std::size_t kStateSize = 112;  // of OpenSSL's SHA256_CTX
  // SHA-256 after the first block of the inner and of the outer hash.
  alignas(8) std::array<std::byte, kStateSize> inner_{};
  alignas(8) std::array<std::byte, kStateSize> outer_{};
};

/** Bytes of one packet, signed. */
class Packet {
 public:
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  friend class PacketWriter;
  std::array<std::byte, kMaxPacket> bytes_;  // set up to size_
  std::size_t size_{0};
};

[[nodiscard]] Packet Seal(const PacketKey& key, Header header, const Hello& hello) noexcept;
[[nodiscard]] Packet Seal(const PacketKey& key, Header header, const Welcome& welcome) noexcept;
[[nodiscard]] Packet Seal(const PacketKey& key, Header header, const StatePacket& state) noexcept;
[[nodiscard]] Packet Seal(const PacketKey& key, Header header, const WrenchPacket& wrench) noexcept;
[[nodiscard]] Packet Seal(const PacketKey& key, Header header, const Bye& bye) noexcept;

/** Why a packet is not taken. */
enum class Refusal : std::uint8_t {
  kNone,
  kMalformed,       ///< Not of this protocol, cut off, or too long.
  kOtherVersion,    ///< It has another version.
  kForged,          ///< Its tag is not that of the key: another key, or changed on the way.
  kForeignSession,  ///< It belongs to another session.
  kReplayed,        ///< It was here before.
  kLate,            ///< A newer one was here before.
};

/** A packet whose tag was right. */
struct Opened {
  Refusal refusal{Refusal::kMalformed};
  Header header;
  std::span<const std::byte> body;
};

/** Looks at bytes from anybody. */
[[nodiscard]] Opened Open(const PacketKey& key, std::span<const std::byte> bytes) noexcept;

// The body of a packet that was opened; false where it is not of this type.
[[nodiscard]] bool Read(const Opened& opened, Hello* hello) noexcept;
[[nodiscard]] bool Read(const Opened& opened, Welcome* welcome) noexcept;
[[nodiscard]] bool Read(const Opened& opened, StatePacket* state) noexcept;
[[nodiscard]] bool Read(const Opened& opened, WrenchPacket* wrench) noexcept;
[[nodiscard]] bool Read(const Opened& opened, Bye* bye) noexcept;

/** Takes each sequence number of a session once, and only forwards. */
class SequenceWindow {
 public:
  [[nodiscard]] Refusal Take(std::uint64_t sequence) noexcept;

  [[nodiscard]] std::uint64_t newest() const noexcept { return newest_; }

  /** Numbers up to the newest that never came, or not yet. */
  [[nodiscard]] std::uint64_t missing() const noexcept { return newest_ - seen_count_; }

 private:
  static constexpr std::uint64_t kWidth = 64;  ///< Bits of `seen_`.
  std::uint64_t newest_{0};
  std::uint64_t seen_{0};  // bit k: newest_ - k was here
  std::uint64_t seen_count_{0};
};

/** What a hello tells, whether it can be or not (CheckInfo); a device that says nothing about a
 limit sends 0. Not RT-safe. */
[[nodiscard]] DeviceInfo InfoOf(const Hello& hello, const std::string& address);
/** Serves those who write the device's side in C++. Not RT-safe. */
[[nodiscard]] Hello HelloOf(const DeviceInfo& info, std::uint64_t nonce);

[[nodiscard]] DeviceState StateOf(const StatePacket& packet) noexcept;

}  // namespace hvas::device::network
