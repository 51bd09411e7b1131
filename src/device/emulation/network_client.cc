#include "device/emulation/network_client.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "device/drivers/datagram_socket.h"
#include "device/drivers/network_protocol.h"

namespace hvas::device {
namespace {

constexpr const char* kSecret = "an emulated secret";
constexpr std::int64_t kHelloNs = 50'000'000;          // 20 hellos a second.
constexpr std::int64_t kServerSilentNs = 250'000'000;  // then HVAS is gone
constexpr std::int64_t kWrenchLifeNs = 20'000'000;     // the protocol's rule

std::uint32_t CountOf(Condition condition) {
  return static_cast<std::uint32_t>(condition);
}

Condition ConditionOf(const EmulatedSample& sample) {
  if (sample.fault == Fault::kCalibrationLost) {
    return Condition::kNotCalibrated;
  }
  if (sample.fault == Fault::kForceRefused) {
    return Condition::kNoForce;
  }
  if (sample.is_stopped) {
    return Condition::kStopped;
  }
  return sample.is_holding ? Condition::kReady : Condition::kNotHeld;
}

class NetworkClient final : public WireServer {
 public:
  NetworkClient(EmulatedDevice* device, DatagramSocket socket, Endpoint host, std::uint16_t port,
                std::string key_file)
      : device_(*device),
        socket_(std::move(socket)),
        host_(host),
        port_(port),
        key_(kSecret),
        key_file_(std::move(key_file)) {
    device_.SetCommandTimeout(kWrenchLifeNs);
  }

  [[nodiscard]] std::string address() const override {
    return fmt::format("network:127.0.0.1:{}?key={}", port_, key_file_);
  }

  void Serve() override {
    // Before the first session, whoever opens the device waits by the machine's clock.
    if (!had_session_ && MonotonicNs() - hello_wall_ns_ > kHelloNs) {
      hello_wall_ns_ = MonotonicNs();
      SayHello();
    }
    std::array<std::byte, network::kMaxPacket + 1> buffer;
    Endpoint sender;
    while (const auto bytes = socket_.Receive(buffer, &sender)) {
      if (!is_unplugged() && sender == host_) {
        Take(network::Open(key_, *bytes));
      }
    }
  }

  void Emit(std::int64_t step_ns) override {
    now_ns_ += step_ns;
    if (is_unplugged()) {
      session_ = 0;  // it starts anew when it has power again
      return;
    }
    if (session_ != 0 && now_ns_ - heard_ns_ > kServerSilentNs) {
      End();
    }
    if (device_.fault() == Fault::kStalled) {
      return;
    }
    const EmulatedSample sample = device_.Sense();
    if (session_ == 0) {
      if (had_session_ && now_ns_ - hello_ns_ > kHelloNs) {
        hello_ns_ = now_ns_;
        SayHello();
      }
    } else if (std::exchange(sent_sample_, sample.sequence) != sample.sequence) {
      SendState(sample);
    }
  }

 private:
  [[nodiscard]] bool is_unplugged() const { return device_.fault() == Fault::kUnplugged; }

  void SayHello() {
    const DeviceProfile profile = device_.profile();
    DeviceInfo info;
    info.model = profile.name.substr(0, 31);
    info.serial = "EMULATED";
    info.version = "1";
    info.is_emulated = true;
    info.profile = profile;
    info.capabilities.force_axes = profile.max_force > 0 ? 3 : 0;
    info.capabilities.torque_axes = profile.max_torque > 0 ? 3 : 0;
    info.capabilities.senses_rotation = true;
    info.capabilities.has_grip = true;
    info.capabilities.has_presence_switch = true;
    info.capabilities.has_emergency_stop = true;
    info.capabilities.button_count = 2;
    network::Header header;
    header.t_ns = now_ns_;
    socket_.Send(network::Seal(key_, header, network::HelloOf(info, ++nonce_)).bytes(), host_);
  }

  void Take(const network::Opened& opened) {
    network::Welcome welcome;
    network::WrenchPacket wrench;
    network::Bye bye;
    if (network::Read(opened, &welcome) && welcome.nonce == nonce_) {
      session_ = opened.header.session;
      had_session_ = true;
      sequence_ = 0;
      window_ = {};
      applied_ = {};
      wrench_count_ = 0;
      heard_ns_ = now_ns_;
    } else if (session_ != 0 && opened.header.session == session_ &&
               network::Read(opened, &wrench)) {
      TakeWrench(opened.header, wrench);
    } else if (session_ != 0 && opened.header.session == session_ && network::Read(opened, &bye)) {
      End();
      had_session_ = false;
    }
  }

  void TakeWrench(const network::Header& header, const network::WrenchPacket& wrench) {
    const network::Refusal refusal = window_.Take(header.sequence);
    wrench_count_ += refusal != network::Refusal::kReplayed ? 1 : 0;
    if (refusal == network::Refusal::kNone) {
      applied_ = header;
      heard_ns_ = now_ns_;
      device_.Command({Vec3(wrench.t.data()), Vec3(wrench.f.data())});
    }
  }

  void End() {
    session_ = 0;
    device_.Command({});
  }

  void SendState(const EmulatedSample& sample) {
    const Quat& q = sample.X_DH.q();
    network::StatePacket state;
    std::copy_n(sample.X_DH.p().data(), 3, state.p.begin());
    state.q = {q.w(), q.x(), q.y(), q.z()};
    std::copy_n(sample.V_DH.v.data(), 3, state.v.begin());
    std::copy_n(sample.V_DH.w.data(), 3, state.w.begin());
    state.grip = sample.grip;
    state.buttons = sample.buttons;
    state.condition = CountOf(ConditionOf(sample));
    state.wrench_count = wrench_count_;
    state.wrench_sequence = applied_.sequence;
    state.wrench_t_ns = applied_.t_ns;
    network::Header header;
    header.session = session_;
    header.sequence = ++sequence_;
    header.t_ns = sample.t_ns;
    socket_.Send(network::Seal(key_, header, state).bytes(), host_);
  }

  EmulatedDevice& device_;
  DatagramSocket socket_;
  Endpoint host_;
  std::uint16_t port_;
  network::PacketKey key_;
  std::string key_file_;
  std::int64_t now_ns_{0};
  std::int64_t hello_ns_{0};
  std::int64_t heard_ns_{0};
  std::int64_t hello_wall_ns_{0};
  std::uint64_t nonce_{0};
  std::uint64_t session_{0};
  bool had_session_{false};
  std::uint64_t sequence_{0};
  std::uint64_t sent_sample_{0};
  network::SequenceWindow window_;
  network::Header applied_;
  std::uint64_t wrench_count_{0};
};

/** A port that was free just now. */
Result<std::uint16_t> FindPort() {
  const auto socket = DatagramSocket::Bind("127.0.0.1", 0);
  if (!socket) {
    return Unexpected(socket.error());
  }
  return socket->port();
}

}  // namespace

Result<std::unique_ptr<WireServer>> MakeNetworkClient(const WireSite& site) {
  const std::filesystem::path key_file = site.root / "network.key";
  if (const auto written = WriteAtomically(key_file, kSecret); !written) {
    return Unexpected(written.error());
  }
  ::chmod(key_file.c_str(), S_IRUSR | S_IWUSR);
  const auto port = FindPort();
  if (!port) {
    return Unexpected(port.error());
  }
  const auto host = ParseEndpoint("127.0.0.1", *port);
  auto socket = DatagramSocket::Bind("127.0.0.1", 0);
  if (!host || !socket) {
    return Unexpected(host ? socket.error() : host.error());
  }
  return std::make_unique<NetworkClient>(site.device, std::move(*socket), *host, *port,
                                         key_file.string());
}

}  // namespace hvas::device
