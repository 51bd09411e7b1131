#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "device/drivers/datagram_socket.h"
#include "device/drivers/network_protocol.h"
#include "device/drivers/polled_guard.h"

namespace hvas::device {

/** What came, what did not, and how old things were: of one network device. */
struct LinkCounts {
  std::uint64_t states{0};       ///< Taken.
  std::uint64_t states_lost{0};  ///< Sent in this session, but never here.
  std::uint64_t wrenches{0};     ///< Sent in this session.
  std::uint64_t wrenches_lost{
      0};  ///< Lost ones of those that the device had to have by its newest state.
  std::int64_t round_trip_ns{0};           ///< Time from a wrench to the state that tells of it.
  std::array<std::uint64_t, 7> refused{};  ///< Packets, by network::Refusal.
};

/** HVAS's end of docs/devices/network.md. */
class NetworkDevice final : public Device {
 public:
  NetworkDevice(DatagramSocket socket, const network::PacketKey& key, const Clock& clock);
  ~NetworkDevice() override;

  /** Waits for a device to say hello, and takes it in. Not RT-safe.
   @returns whether one did. */
  [[nodiscard]] bool WaitForHello(int timeout_ms, const std::string& address);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override;
  void Write(const spatial::Wrench& F_H_D) noexcept override;
  [[nodiscard]] std::string Explain(const DeviceState& state) const override;

  /** Any thread may call it. */
  [[nodiscard]] LinkCounts counts() const noexcept;

 private:
  struct Session {
    std::uint64_t id{0};  ///< 0: none
    network::SequenceWindow window;
    std::uint64_t sent{0};
  };

  /** Takes all packets that are there; whether a state was among them. */
  bool Receive(network::StatePacket* newest) noexcept;
  network::Refusal Take(const network::Opened& opened, const Endpoint& sender,
                        network::StatePacket* newest) noexcept;
  network::Refusal Take(const network::Hello& hello, const Endpoint& sender) noexcept;
  network::Refusal TakeState(const network::Opened& opened, network::StatePacket* newest) noexcept;
  [[nodiscard]] bool IsSameDevice(const network::Hello& hello) const noexcept;
  void CountTrip(const network::StatePacket& state) noexcept;
  /** Signs and sends in the session; nothing where there is none. */
  template <typename Body>
  void Send(const Body& body) noexcept;

  DatagramSocket socket_;
  network::PacketKey key_;
  const Clock& clock_;
  DeviceInfo info_;
  std::unique_ptr<PolledGuard> guard_;  // once the profile is known
  network::Hello hello_;                // that was taken in
  bool has_hello_{false};
  Session session_;
  std::uint64_t pending_session_{0};  // welcomed, but without a state yet; 0: none
  Endpoint device_;
  std::int64_t heard_ns_{0};

  // For whoever asks.
  std::atomic<std::uint64_t> states_{0};
  std::atomic<std::uint64_t> states_lost_{0};
  std::atomic<std::uint64_t> wrenches_{0};
  std::atomic<std::uint64_t> wrenches_lost_{0};
  std::atomic<std::int64_t> round_trip_ns_{0};
  std::array<std::atomic<std::uint64_t>, 7> refused_{};
};

}  // namespace hvas::device
