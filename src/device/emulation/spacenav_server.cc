#include "device/emulation/spacenav_server.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/drivers/spacenav_protocol.h"
#include "device/drivers/unix_socket.h"
#include "device/emulation/rate_person.h"

namespace hvas::device {
namespace {

constexpr int kButtons = 2;  // A SpaceMouse has two.

class SpacenavServer final : public WireServer {
 public:
  SpacenavServer(const WireSite& site, std::filesystem::path path, Descriptor listener)
      : device_(*site.device),
        path_(std::move(path)),
        listener_(std::move(listener)),
        person_(device_.profile().workspace) {}

  [[nodiscard]] std::string address() const override {
    return fmt::format("spacemouse:{}", path_.string());
  }

  void Serve() override {
    for (Descriptor client = TryAccept(listener_); client.is_open();
         client = TryAccept(listener_)) {
      if (device_.fault() != Fault::kUnplugged) {
        clients_.push_back(std::move(client));
        sent_ = {};
      }
    }
  }

  void Emit(std::int64_t step_ns) override {
    const Fault fault = device_.fault();
    if (fault == Fault::kUnplugged) {
      clients_.clear();
      return;
    }
    if (fault == Fault::kStalled || clients_.empty()) {
      return;
    }
    spacenav::Frame frame = spacenav::FrameOf(person_.Deflect(device_.truth().X_DH));
    if (IsGarbled(fault)) {
      std::fill(frame.begin() + 1, frame.begin() + 7, std::numeric_limits<std::int32_t>::min());
      Send(frame);
      sent_ = frame;
      return;
    }
    const bool is_moving = std::any_of(frame.begin() + 1, frame.begin() + 7,
                                       [](std::int32_t value) { return value != 0; });
    if (is_moving || frame != sent_) {  // as the daemon: while pushed, and once when let go of
      Send(frame);
      sent_ = frame;
    }
    person_.See(spacenav::DeflectionOf(frame), 1e-9 * static_cast<double>(step_ns));
    SendButtons();
  }

 private:
  /** Deflections are whole numbers, so that what is not a number elsewhere is a wild one here. */
  static bool IsGarbled(Fault fault) {
    return fault == Fault::kNotANumber || fault == Fault::kJump || fault == Fault::kCalibrationLost;
  }

  void SendButtons() {
    const std::uint32_t buttons = device_.Sense().buttons;
    for (int i = 0; i < kButtons; ++i) {
      const std::uint32_t bit = 1U << static_cast<unsigned>(i);
      if (((buttons ^ buttons_) & bit) != 0) {
        Send({(buttons & bit) != 0 ? spacenav::kPress : spacenav::kRelease, i});
      }
    }
    buttons_ = buttons;
  }

  void Send(const spacenav::Frame& frame) {
    std::erase_if(clients_, [&frame](const Descriptor& client) {
      return ::send(client.value(), frame.data(), sizeof(frame), MSG_NOSIGNAL | MSG_DONTWAIT) !=
             sizeof(frame);
    });
  }

  EmulatedDevice& device_;
  std::filesystem::path path_;
  Descriptor listener_;
  std::vector<Descriptor> clients_;
  RatePerson person_;
  spacenav::Frame sent_{};
  std::uint32_t buttons_{0};
};

}  // namespace

Result<std::unique_ptr<WireServer>> MakeSpacenavServer(const WireSite& site) {
  const std::filesystem::path path = site.root / "var/run/spnav.sock";
  auto listener = ListenAt(path, SOCK_STREAM);
  if (!listener) {
    return Unexpected(listener.error());
  }
  std::ofstream mark(path.string() + spacenav::kEmulatedMark);
  return std::make_unique<SpacenavServer>(site, path, std::move(*listener));
}

}  // namespace hvas::device
