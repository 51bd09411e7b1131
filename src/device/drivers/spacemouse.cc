// SpaceMouse through the socket of spacenavd (docs/devices/spacemouse.md). Frames as in libspnav's
// proto.h, protocol 0, which every version of the daemon speaks to whoever says nothing.
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "device/drivers/polled_guard.h"
#include "device/drivers/rate_control.h"
#include "device/drivers/spacenav_protocol.h"
#include "device/drivers/unix_socket.h"
#include "device/drivers/wire_drivers.h"

namespace hvas::device {
namespace {

constexpr const char* kName = "spacemouse";
// Time from one try to connect to the next: a choice.
constexpr std::int64_t kRetryNs = 250'000'000;
/** A cap that is held still for so long without a word is taken to be let go of: the hand trembles.
 */
constexpr std::int64_t kSilentNs = 500'000'000;
constexpr std::int32_t kImplausible = 4 * spacenav::kFullScale;

class SpaceMouse final : public Device {
 public:
  SpaceMouse(std::string path, Descriptor socket, DeviceInfo info, const Clock& clock)
      : path_(std::move(path)),
        socket_(std::move(socket)),
        info_(std::move(info)),
        clock_(clock),
        guard_(info_.profile, clock),
        rate_(info_.profile.workspace),
        read_ns_(clock.NowNs()) {}

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override {
    const std::int64_t now_ns = guard_.Begin();
    const double dt_s = 1e-9 * static_cast<double>(now_ns - std::exchange(read_ns_, now_ns));
    Connect(now_ns);
    ReceiveFrames(now_ns);
    if (!socket_.is_open()) {
      return guard_.Refuse(Condition::kLost);
    }
    if (is_implausible_) {
      return guard_.Refuse(Condition::kImplausible);
    }
    const bool is_pushed = !deflection_.move.isZero() || !deflection_.turn.isZero();
    if (is_pushed && now_ns - heard_ns_ > kSilentNs) {
      return guard_.Refuse(Condition::kStale);
    }
    rate_.Step(deflection_, dt_s);
    DeviceState state;
    state.X_DH = rate_.X_DH();
    state.V_DH = rate_.V_DH();
    state.buttons = buttons_;
    return guard_.Accept(state);
  }

  void Write(const spatial::Wrench&) noexcept override {}  // it has no motors

 private:
  void Connect(std::int64_t now_ns) noexcept {
    if (!socket_.is_open() && now_ns >= retry_ns_) {
      retry_ns_ = now_ns + kRetryNs;
      socket_ = TryConnect(path_.c_str(), SOCK_STREAM);
      Reset();
    }
  }

  void Reset() noexcept {
    filled_ = 0;
    deflection_ = {};
    buttons_ = 0;
    is_implausible_ = false;
  }

  void ReceiveFrames(std::int64_t now_ns) noexcept {
    constexpr int kMaxFrames = 64;  // A bound, so that nobody can keep a tick busy: a choice.
    for (int i = 0; i < kMaxFrames && socket_.is_open(); ++i) {
      std::size_t count = 0;
      const auto rest = std::span(frame_).subspan(filled_);
      switch (TryReceive(socket_, rest, &count)) {
        case Transfer::kNothing:
          return;
        case Transfer::kClosed:
          socket_.Close();
          Reset();
          return;
        case Transfer::kDone:
          filled_ += count;
      }
      if (filled_ == frame_.size()) {
        filled_ = 0;
        spacenav::Frame frame;
        std::memcpy(&frame, frame_.data(), sizeof(frame));
        Take(frame);
        heard_ns_ = now_ns;
      }
    }
  }

  void Take(const spacenav::Frame& frame) noexcept {
    if (frame[0] == spacenav::kMotion) {
      is_implausible_ = false;
      for (std::size_t i = 1; i <= 6; ++i) {
        is_implausible_ = is_implausible_ || frame[i] > kImplausible || frame[i] < -kImplausible;
      }
      deflection_ = is_implausible_ ? Deflection{} : spacenav::DeflectionOf(frame);
    } else if (frame[1] >= 0 && frame[1] < 32) {
      const std::uint32_t bit = 1U << static_cast<unsigned>(frame[1]);
      if (frame[0] == spacenav::kPress) {
        buttons_ |= bit;
      } else if (frame[0] == spacenav::kRelease) {
        buttons_ &= ~bit;
      }
    }
  }

  std::string path_;
  Descriptor socket_;
  DeviceInfo info_;
  const Clock& clock_;
  PolledGuard guard_;
  RateControl rate_;
  std::int64_t read_ns_;
  std::int64_t heard_ns_{0};
  std::int64_t retry_ns_{0};
  std::array<std::byte, sizeof(spacenav::Frame)> frame_{};
  std::size_t filled_{0};
  Deflection deflection_;
  std::uint32_t buttons_{0};
  bool is_implausible_{false};
};

/** The path that a spnavrc gives the socket, or none. */
std::string SocketInSettings(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || line.front() == '#') {
      continue;
    }
    const auto trim = [](std::string text) {
      text.erase(0, text.find_first_not_of(" \t\""));
      return text.erase(text.find_last_not_of(" \t\"\r") + 1);
    };
    if (trim(line.substr(0, equals)) == "socket") {
      return trim(line.substr(equals + 1));
    }
  }
  return {};
}

/** Where the socket is: the address, the variable (of the whole machine only), the settings, the
 usual place. */
std::filesystem::path FindSocket(const std::string& address, const Surroundings& surroundings) {
  if (!address.empty()) {
    return address;
  }
  const char* variable = surroundings.root == "/" ? std::getenv("SPNAV_SOCKET") : nullptr;
  if (variable != nullptr && *variable != '\0') {
    return variable;
  }
  const std::string set = SocketInSettings(surroundings.root / "etc/spnavrc");
  const std::filesystem::path path = set.empty() ? "/var/run/spnav.sock" : set;
  return surroundings.root / path.relative_path();
}

Error WhyNot(int reason, const std::filesystem::path& path) {
  switch (reason) {
    case ENOENT:
      return {ErrorCode::kNotFound, "spacenavd is not running: its socket does not exist",
              path.string(),
              "install and start it: apt install spacenavd; systemctl start spacenavd"};
    case ECONNREFUSED:
      return {ErrorCode::kNotFound,
              "spacenavd is not running: its socket exists, but no process listens on it",
              path.string(), "start it again: systemctl restart spacenavd"};
    case EACCES:
    case EPERM:
      return {ErrorCode::kInvalid, "this user has no permission to use the socket of spacenavd",
              path.string(), fmt::format("give all users access: chmod 666 {}", path.string())};
    default:
      return {
          ErrorCode::kOutOfResource,
          fmt::format("spacenavd cannot be reached: {}", std::generic_category().message(reason)),
          path.string(), "restart it: systemctl restart spacenavd"};
  }
}

class SpaceMouses final : public Driver {
 public:
  SpaceMouses()
      : Driver({kName, "3Dconnexion SpaceMouse (spacenavd)",
                "[SOCKET] of spacenavd, for example spacemouse:/var/run/spnav.sock"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override {
    ProbeReport report = BeginReport();
    const std::filesystem::path path = FindSocket("", surroundings);
    const auto device = Open("", surroundings);
    report.looked_for.push_back({"spacenavd's socket", path.string(), device.has_value(), ""});
    if (!device) {
      report.problems.push_back(device.error());
    } else if (opens_devices) {
      report.devices.push_back((*device)->info());
    }
    return report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override {
    const std::filesystem::path path = FindSocket(address, surroundings);
    Descriptor socket = TryConnect(path.c_str(), SOCK_STREAM);
    if (!socket.is_open()) {
      return Unexpected(WhyNot(errno, path));
    }
    DeviceInfo info;
    info.driver = kName;
    info.address = fmt::format("{}:{}", kName, path.string());
    info.model = "SpaceMouse";
    info.is_emulated = std::filesystem::exists(path.string() + spacenav::kEmulatedMark);
    info.profile = FindProfile(kName)->profile;
    info.profile_note = "spacenavd reports no properties of the device; these are assumed by HVAS";
    info.capabilities.senses_position = false;
    info.capabilities.senses_rotation = true;
    info.capabilities.button_count = 2;
    return std::make_unique<SpaceMouse>(path.string(), std::move(socket), std::move(info),
                                        *surroundings.clock);
  }
};

}  // namespace

const Driver& SpaceMouseDriver() {
  static const SpaceMouses driver;
  return driver;
}

}  // namespace hvas::device
