#include "device/emulation/library_emulator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "device/drivers/dynamic_library.h"
#include "device/emulation/stub_library.h"

namespace hvas::device {
namespace {

/** What differs between the vendors' stubs. */
struct Kind {
  std::string_view driver;
  const char* file;
  const char* address;  ///< With the device's number.
  const char* model;    ///< Of a profile without one.
};

constexpr std::array kKinds{
    Kind{"openhaptics", "libHD.so", "openhaptics:Emulated {}", "Touch X"},
    Kind{"forcedimension", "libdrd.so", "forcedimension:{}", "omega.7"},
    Kind{"virtuose", "virtuoseAPI.so", "virtuose:emulated#{}", "Virtuose 6D"}};

int SystemTypeOf(std::string_view model) {
  constexpr std::array<std::pair<std::string_view, int>, 5> kTypes{
      {{"sigma.7", 104}, {"lambda.7", 108}, {"delta.3", 63}, {"Falcon", 60}, {"omega.7", 35}}};
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [model](const auto& type) { return type.first == model; });
  return found != kTypes.end() ? found->second : 0;
}

StubTraits TraitsOf(const char* model, const LibraryManners& manners,
                    const std::optional<DeviceProfile>& claim) {
  const std::string_view name(model);
  StubTraits traits;
  traits.model = model;
  traits.system_type = SystemTypeOf(name);
  traits.has_active_wrist = name == "sigma.7" || name == "lambda.7";
  traits.has_gripper = traits.has_active_wrist || name == "omega.7";
  if (claim) {
    traits.max_force = claim->max_force;
    traits.max_torque = claim->max_torque;
  }
  traits.is_licensed = manners.is_licensed;
  traits.is_calibrated = manners.is_calibrated;
  traits.can_calibrate = manners.can_calibrate;
  traits.is_of_this_version = manners.is_of_this_version;
  return traits;
}

/** A device that runs by the machine's clock. Whoever reads or commands it finds it where it is by
 then, however late the emulator's own thread may be: a real handle does not wait for a thread. */
class LivePort final : public EmulatedPort {
 public:
  explicit LivePort(EmulatedDevice* device) : device_(device), last_ns_(MonotonicNs()) {}

  [[nodiscard]] EmulatedSample Sense() const override {
    CatchUp();
    return device_->Sense();
  }

  void Command(const spatial::Wrench& F_H_D) override {
    CatchUp();
    device_->Command(F_H_D);
  }

  [[nodiscard]] DeviceProfile profile() const override { return device_->profile(); }

  /** Moves the device on to the present. Any thread. */
  void CatchUp() const {
    const std::scoped_lock lock(mutex_);
    const std::int64_t now_ns = MonotonicNs();
    if (now_ns - last_ns_ >= kLeastNs) {
      device_->Advance(std::min(now_ns - last_ns_, kMaxLiveLagNs));
      last_ns_ = now_ns;
    }
  }

 private:
  static constexpr std::int64_t kLeastNs = 100'000;  // Step of the device's mechanics.

  EmulatedDevice* device_;
  mutable std::mutex mutex_;
  mutable std::int64_t last_ns_;
};

class LibraryEmulator final : public Emulator {
 public:
  LibraryEmulator(const Kind& kind, const StubEntry& stub, const EmulatorOptions& options,
                  const LibraryManners& manners)
      : kind_(kind),
        stub_(stub),
        device_(options.profile, options.X_DH, options.claim.value_or(options.profile)) {
    const SourcedProfile* known = FindProfile(options.profile.id);
    const bool has_model =
        known != nullptr && known->driver == kind.driver && !known->models.empty();
    model_ = has_model ? known->models.front() : kind.model;
    EmulatedPort* const port = options.is_live ? static_cast<EmulatedPort*>(&live_) : &device_;
    number_ = stub_.attach(port, TraitsOf(model_.c_str(), manners, options.claim));
    surroundings_.library_folders = {StubFolder()};
    surroundings_.root = StubFolder() / "no-machine";
    surroundings_.clock = options.is_live ? &SystemClock() : &clock_;
    if (options.is_live && is_attached()) {
      thread_ = std::thread([this] { Run(); });
    }
  }

  ~LibraryEmulator() override {
    is_stopping_.store(true, std::memory_order_release);
    if (thread_.joinable()) {
      thread_.join();
    }
    if (is_attached()) {
      stub_.detach(number_);
    }
  }

  [[nodiscard]] bool is_attached() const { return number_ >= 0; }

  [[nodiscard]] EmulatedDevice& device() override { return device_; }

  [[nodiscard]] const Surroundings& surroundings() const override { return surroundings_; }

  [[nodiscard]] std::string address() const override {
    return fmt::format(fmt::runtime(kind_.address), number_);
  }

  void Advance(std::int64_t step_ns) override {
    while (step_ns > 0) {
      const std::int64_t slice_ns = std::min(step_ns, kTickNs - clock_.NowNs() % kTickNs);
      device_.Advance(slice_ns);
      clock_.Advance(slice_ns);
      step_ns -= slice_ns;
      if (clock_.NowNs() % kTickNs == 0) {
        stub_.tick(number_, clock_.NowNs());
      }
    }
  }

 private:
  static constexpr std::int64_t kTickNs = 1'000'000;  // Of the vendors' own loops.

  void Run() {
    while (!is_stopping_.load(std::memory_order_acquire)) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(kTickNs));
      live_.CatchUp();
      stub_.tick(number_, MonotonicNs());
    }
  }

  const Kind& kind_;
  const StubEntry& stub_;
  EmulatedDevice device_;
  LivePort live_{&device_};
  std::string model_;
  int number_{-1};
  VirtualClock clock_;
  Surroundings surroundings_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace

std::filesystem::path StubFolder() {
  return HVAS_STUB_FOLDER;
}

Result<std::unique_ptr<Emulator>> StartLibraryEmulator(std::string_view driver,
                                                       const EmulatorOptions& options,
                                                       const LibraryManners& manners) {
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [driver](const Kind& k) { return k.driver == driver; });
  if (kind == kKinds.end()) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("driver {} has no emulator among the vendors' libraries", driver));
  }
  LibrarySearch search;
  search.title = fmt::format("the emulator of {}", driver);
  search.names = {kind->file};
  search.folders = {StubFolder()};
  search.asks_loader = false;
  search.remedy = "build HVAS again: its emulators are made with it";
  std::vector<Finding> looked_for;
  StubEntryFunction* entry = nullptr;
  const auto library = LoadFunctions(
      search, &looked_for, [&](SymbolBinder* binder) { binder->Bind("hvas_emulator", &entry); });
  if (!library) {
    return Unexpected(library.error());
  }
  auto emulator = std::make_unique<LibraryEmulator>(*kind, *entry(), options, manners);
  if (!emulator->is_attached()) {
    return Fail(ErrorCode::kOutOfResource,
                fmt::format("at most {} emulators of {} can run at once", kMaxStubDevices, driver),
                std::string(driver), "stop one of them");
  }
  return emulator;
}

}  // namespace hvas::device
