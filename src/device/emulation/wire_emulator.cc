#include "device/emulation/wire_emulator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/scratch_folder.h"
#include "device/emulation/gamepad_emulator.h"
#include "device/emulation/haply_server.h"
#include "device/emulation/network_client.h"
#include "device/emulation/plugin_emulator.h"
#include "device/emulation/spacenav_server.h"

namespace hvas::device {
namespace {

constexpr std::int64_t kStepNs = 1'000'000;            // The haptic loop's period.
constexpr auto kNap = std::chrono::microseconds(200);  // A fifth of a period.

class WireEmulator final : public Emulator {
 public:
  WireEmulator(const EmulatorOptions& options, ScratchFolder folder)
      : folder_(std::move(folder)),
        device_(options.profile, options.X_DH, options.claim.value_or(options.profile)),
        is_live_(options.is_live) {
    surroundings_.root = folder_.path();
    if (!is_live_) {
      surroundings_.clock = &clock_;
    }
  }

  ~WireEmulator() override {
    stops_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  Result<void> Start(MakeWireServer make, const spatial::Pose& X_DH) {
    auto server = make({&device_, folder_.path(), X_DH});
    if (!server) {
      return Unexpected(server.error());
    }
    server_ = std::move(*server);
    thread_ = std::thread([this] { Run(); });
    return {};
  }

  EmulatedDevice& device() override { return device_; }

  [[nodiscard]] const Surroundings& surroundings() const override { return surroundings_; }

  [[nodiscard]] std::string address() const override { return server_->address(); }

  void Advance(std::int64_t step_ns) override {
    const std::scoped_lock lock(mutex_);
    while (step_ns > 0) {
      const std::int64_t part_ns = std::min(step_ns, kStepNs);
      Step(part_ns);
      step_ns -= part_ns;
    }
  }

 private:
  void Step(std::int64_t step_ns) {
    server_->Serve();
    device_.Advance(step_ns);
    clock_.Advance(step_ns);
    server_->Emit(step_ns);
  }

  void Run() {
    std::int64_t before_ns = MonotonicNs();
    while (!stops_) {
      {
        const std::scoped_lock lock(mutex_);
        if (is_live_) {
          const std::int64_t now_ns = MonotonicNs();
          Step(std::min(now_ns - before_ns, kMaxLiveLagNs));
          before_ns = now_ns;
        } else {
          server_->Serve();
        }
      }
      std::this_thread::sleep_for(kNap);
    }
  }

  ScratchFolder folder_;
  EmulatedDevice device_;
  VirtualClock clock_;
  Surroundings surroundings_;
  bool is_live_;
  std::mutex mutex_;  // of server_: the thread and whoever calls Advance
  std::unique_ptr<WireServer> server_;
  std::atomic<bool> stops_{false};
  std::thread thread_;
};

struct NamedServer {
  std::string_view driver;
  MakeWireServer make;
};

constexpr std::array kServers{
    NamedServer{"haply", MakeHaplyServer}, NamedServer{"spacemouse", MakeSpacenavServer},
    NamedServer{"gamepad", MakeGamepadServer}, NamedServer{"network", MakeNetworkClient},
    NamedServer{"plugin", MakePluginServer}};

}  // namespace

Result<std::unique_ptr<Emulator>> StartWireEmulator(MakeWireServer make,
                                                    const EmulatorOptions& options) {
  auto folder = ScratchFolder::Make();
  if (!folder) {
    return Unexpected(folder.error());
  }
  auto emulator = std::make_unique<WireEmulator>(options, std::move(*folder));
  if (const auto started = emulator->Start(make, options.X_DH); !started) {
    return Unexpected(started.error());
  }
  return emulator;
}

Result<std::unique_ptr<Emulator>> StartWireEmulator(std::string_view driver,
                                                    const EmulatorOptions& options) {
  const auto* const found = std::find_if(kServers.begin(), kServers.end(), [&](const auto& server) {
    return server.driver == driver;
  });
  if (found == kServers.end()) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("driver \"{}\" has no emulator in this build", driver));
  }
  return StartWireEmulator(found->make, options);
}

}  // namespace hvas::device
