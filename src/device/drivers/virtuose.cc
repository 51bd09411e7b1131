#include "device/drivers/virtuose.h"

#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "device/drivers/vendor_drivers.h"

namespace hvas::device {
namespace virtuose {

VendorVerdict Judge(int error) noexcept {
  switch (error) {
    case 0:
      return VendorVerdict::kFine;
    case kErrorCommunication:
    case kErrorInvalidContext:
    case kErrorTimeout:
      return VendorVerdict::kGone;
    case kErrorDiscontinuity:
      return VendorVerdict::kImplausible;
    default:
      return VendorVerdict::kFault;
  }
}

VendorVerdict JudgeAlarms(unsigned alarms) noexcept {
  if ((alarms & kAlarmPosition) != 0) {
    return VendorVerdict::kNotCalibrated;
  }
  return (alarms & kAlarmOverheat) != 0 ? VendorVerdict::kRefuses : VendorVerdict::kFine;
}

std::string Explain(int code) {
  static const std::map<int, std::string> words{
      {kErrorCommunication, "the connection to its controller failed; check the network cable"},
      {kErrorInvalidContext, "the vendor's software has lost the connection"},
      {kErrorTimeout, "its controller did not respond in time; check the network"},
      {kErrorHardware, "its controller reports a hardware fault"},
      {kErrorDiscontinuity, "the vendor's software detected a jump of its pose"},
      {kErrorVersion, "library and controller have different versions"},
      {kErrorIncompatible, "library and controller have different versions"},
      {kAlarmOverheat, "its motors are too hot; let them cool for some minutes"},
      {kAlarmPosition, "its position is invalid; calibrate it with the vendor's program"}};
  return WordsOf(words, code);
}

spatial::Pose ToPose(const std::array<float, 7>& pose) noexcept {
  const auto& [x, y, z, qx, qy, qz, qw] = pose;
  return {Quat(double{qw}, double{qx}, double{qy}, double{qz}).normalized(),
          Vec3(double{x}, double{y}, double{z})};
}

spatial::Twist ToTwist(const std::array<float, 6>& speed) noexcept {
  const auto& [vx, vy, vz, wx, wy, wz] = speed;
  return {Vec3(double{wx}, double{wy}, double{wz}), Vec3(double{vx}, double{vy}, double{vz})};
}

std::array<float, 6> FromWrench(const spatial::Wrench& F) noexcept {
  return {static_cast<float>(F.f.x()), static_cast<float>(F.f.y()), static_cast<float>(F.f.z()),
          static_cast<float>(F.t.x()), static_cast<float>(F.t.y()), static_cast<float>(F.t.z())};
}

void BindAll(SymbolBinder* binder, Functions* functions) {
  HVAS_VIRT_FUNCTIONS(HVAS_BIND)
  HVAS_VIRT_OPTIONAL_FUNCTIONS(HVAS_BIND_OPTIONAL)
}

}  // namespace virtuose

namespace {

using namespace virtuose;  // NOLINT(google-build-using-namespace): this file's own vendor.

constexpr const char* kName = "virtuose";
constexpr const char* kTitle = "Haption Virtuose (VirtuoseAPI 4)";
constexpr const char* kProfile = "virtuose";
constexpr const char* kDefaultAddress = "127.0.0.1#5000";
constexpr const char* kRemedy =
    "install VirtuoseAPI 4 of Haption, and set VIRTUOSE_API to the folder of virtuoseAPI.so when "
    "that is not below /usr or /opt";
constexpr float kTimeStep = 1e-3F;  // [s]: a kilohertz, as the tick.
constexpr float kTimeout = 0.1F;    // [s] until it stops without a command: a choice.
constexpr std::int64_t kRelaysNs = 3'000'000'000;  // Until its relays have closed.
// Time from one look for its power to the next: a choice.
constexpr std::int64_t kPowerEveryNs = 250'000'000;
constexpr int kButtons = 3;  // Its handle has three.

using Library = VendorLibrary<Functions>;

struct Started {
  void* context;
  DeviceInfo info;
};

Error NotStarted(const Functions& virt, const std::string& address, int error) {
  std::string words = Explain(error);
  if (const char* message = virt.virtGetErrorMessage(error); words.empty() && message != nullptr) {
    words = message;
  }
  const bool is_version = error == kErrorVersion || error == kErrorIncompatible;
  return {
      is_version ? ErrorCode::kUnsupported : ErrorCode::kNotFound,
      fmt::format("the Virtuose at {} could not be opened: {} (its error {})", address, words,
                  error),
      address,
      is_version
          ? "get the library for this controller from Haption"
          : "check that its controller is on and responds to ping, that the address is correct "
            "(for example \"virtuose:192.168.1.2#5000\"), and that no other program has it open"};
}

DeviceInfo AskInfo(const Library& library, void* context, const std::string& address) {
  DeviceInfo info;
  info.driver = kName;
  info.address = address;
  info.is_emulated = library.is_emulated;
  info.profile = FindProfile(kProfile)->profile;
  info.profile_note = "figures of " + info.profile.name + ", which the device does not report";
  info.model = "Virtuose 6D";
  int type = 0;
  int serial = 0;
  if (library.functions.virtGetDeviceID != nullptr &&
      library.functions.virtGetDeviceID(context, &type, &serial) == 0) {
    info.model += fmt::format(" (type {})", type);
    info.serial = std::to_string(serial);
  }
  int major = 0;
  int minor = 0;
  if (library.functions.virtAPIVersion != nullptr &&
      library.functions.virtAPIVersion(&major, &minor) == 0) {
    info.version = fmt::format("{}.{:02}", major, minor);
  }
  Capabilities& has = info.capabilities;
  has.force_axes = 3;
  has.torque_axes = 3;
  has.senses_rotation = true;
  has.has_presence_switch = true;
  has.has_emergency_stop = true;
  has.button_count = kButtons;
  return info;
}

/** Sets up impedance control of an open device, in the order that its controller wants; power is
 on afterwards, force zero. */
int Prepare(const Functions& virt, void* context, const DeviceProfile& profile) {
  std::array<float, 7> base{0, 0, 0, 0, 0, 0, 1};
  std::array<float, 7> observer = base;
  std::array<float, 6> none{};
  const auto fails = [&](int result) { return result != 0; };
  const bool has_failed =
      fails(virt.virtSetIndexingMode(context, kIndexingNone)) ||
      fails(virt.virtSetForceFactor(context, 1)) || fails(virt.virtSetSpeedFactor(context, 1)) ||
      fails(virt.virtSetTimeStep(context, kTimeStep)) ||
      fails(virt.virtSetBaseFrame(context, base.data())) ||
      fails(virt.virtSetObservationFrame(context, observer.data())) ||
      fails(virt.virtSetCommandType(context, kCommandImpedance)) ||
      fails(virt.virtSaturateTorque(context, static_cast<float>(profile.max_force),
                                    static_cast<float>(profile.max_torque))) ||
      fails(virt.virtSetTimeoutValue(context, kTimeout)) ||
      fails(virt.virtSetPowerOn(context, 1)) || fails(virt.virtSetForce(context, none.data()));
  return has_failed ? virt.virtGetErrorCode(context) : 0;
}

Result<Started> OpenAddress(const Library& library, const std::string& address) {
  void* context = library.functions.virtOpen(address.c_str());
  if (context == nullptr) {
    return Unexpected(
        NotStarted(library.functions, address, library.functions.virtGetErrorCode(nullptr)));
  }
  return Started{context, AskInfo(library, context, address)};
}

class VirtDevice final : public VendorDevice {
 public:
  VirtDevice(const Library& library, const Started& started, const Clock& clock)
      : VendorDevice(started.info, clock),
        library_(library),
        context_(started.context),
        relays_ns_(NowNs() + kRelaysNs) {}

  ~VirtDevice() override {
    StopReopening();
    LetGo();
  }

 protected:
  Reading ReadVendor(DeviceState* sample) noexcept override;

  void WriteVendor(const spatial::Wrench& F_H_D) noexcept override {
    std::array<float, 6> force = FromWrench(F_H_D);
    force_error_ =
        virt_.virtSetForce(context_, force.data()) != 0 ? virt_.virtGetErrorCode(context_) : 0;
  }

  bool Reopen() override {
    LetGo();
    const auto started = OpenAddress(library_, info().address);
    if (!started) {
      return false;
    }
    context_ = started->context;
    relays_ns_ = NowNs() + kRelaysNs;
    force_error_ = 0;
    if (Prepare(virt_, context_, info().profile) != 0) {
      LetGo();
    }
    return context_ != nullptr;
  }

  [[nodiscard]] std::string ExplainCode(std::int32_t code) const override {
    return virtuose::Explain(code);
  }

 private:
  void LetGo();
  /** Whether the vendor's last update is no older than at the last call. */
  [[nodiscard]] bool IsUpdated() noexcept;
  void ReadSwitches(DeviceState* sample) noexcept;
  void ReadPower(DeviceState* sample) noexcept;

  const Library library_;
  const Functions& virt_{library_.functions};
  void* context_;
  std::int64_t relays_ns_;    ///< When the relays will have closed.
  std::int64_t power_ns_{0};  ///< When power may be asked for again.
  int force_error_{0};        ///< Of the last force that was set.
  std::array<float, 7> last_pose_{};
  unsigned last_age_{0};
};

void VirtDevice::LetGo() {
  if (context_ != nullptr) {
    std::array<float, 6> none{};
    virt_.virtSetForce(context_, none.data());
    virt_.virtSetPowerOn(context_, 0);
    virt_.virtClose(context_);
    context_ = nullptr;
  }
}

bool VirtDevice::IsUpdated() noexcept {
  unsigned age = 0;
  if (virt_.virtGetTimeLastUpdate == nullptr || virt_.virtGetTimeLastUpdate(context_, &age) != 0) {
    return true;
  }
  const bool is_updated = age <= last_age_;
  last_age_ = age;
  return is_updated;
}

void VirtDevice::ReadPower(DeviceState* sample) noexcept {
  int is_powered = 0;
  if (virt_.virtGetPowerOn(context_, &is_powered) != 0) {
    return;
  }
  if (is_powered == 0) {
    relays_ns_ = sample->t_ns + kRelaysNs;
    if (sample->t_ns >= power_ns_) {
      power_ns_ = sample->t_ns + kPowerEveryNs;
      virt_.virtSetPowerOn(context_, 1);
    }
  }
  if (sample->t_ns < relays_ns_) {
    sample->condition = Condition::kNoForce;
  }
}

void VirtDevice::ReadSwitches(DeviceState* sample) noexcept {
  for (int button = 0; button < kButtons; ++button) {
    int is_pressed = 0;
    if (virt_.virtGetButton(context_, button, &is_pressed) == 0 && is_pressed != 0) {
      sample->buttons |= 1U << button;
    }
  }
  int is_held = 0;
  int is_closed = 0;
  unsigned alarms = 0;
  virt_.virtGetDeadMan(context_, &is_held);
  virt_.virtGetEmergencyStop(context_, &is_closed);
  virt_.virtGetAlarm(context_, &alarms);
  if (is_closed == 0) {
    sample->condition = Condition::kStopped;
  } else if (const VendorVerdict alarm = JudgeAlarms(alarms); alarm != VendorVerdict::kFine) {
    sample->condition = ToCondition(alarm);
    sample->vendor_code = static_cast<std::int32_t>(alarms & (kAlarmOverheat | kAlarmPosition));
  } else if (is_held == 0) {
    sample->condition = Condition::kNotHeld;
  } else {
    ReadPower(sample);
  }
}

VendorDevice::Reading VirtDevice::ReadVendor(DeviceState* sample) noexcept {
  std::array<float, 7> pose{};
  std::array<float, 6> speed{};
  const bool is_read = virt_.virtGetPosition(context_, pose.data()) == 0 &&
                       virt_.virtGetSpeed(context_, speed.data()) == 0;
  sample->vendor_code = is_read ? force_error_ : virt_.virtGetErrorCode(context_);
  const VendorVerdict verdict = Judge(sample->vendor_code);
  if (verdict == VendorVerdict::kGone) {
    return Reading::kGone;
  }
  sample->X_DH = ToPose(pose);
  sample->V_DH = ToTwist(speed);
  ReadSwitches(sample);
  if (verdict != VendorVerdict::kFine) {
    sample->condition = ToCondition(verdict);
  }
  const bool is_new = IsUpdated() || pose != last_pose_;
  last_pose_ = pose;
  return is_new ? Reading::kNew : Reading::kRepeated;
}

class VirtDriver final : public Driver {
 public:
  VirtDriver()
      : Driver({kName, kTitle,
                "host and port of its controller, for example \"virtuose:192.168.1.2#5000\"; "
                "default: 127.0.0.1#5000"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override;
  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override;

 private:
  static LibrarySearch Search(const Surroundings& surroundings) {
    LibrarySearch search = MakeLibrarySearch(surroundings, {{"VIRTUOSE_API", ""}},
                                             {"/opt/haption", "/opt/haption/lib"});
    search.title = kTitle;
    search.names = {"virtuoseAPI.so"};
    search.remedy = kRemedy;
    search.version = "4.x";
    // Version 3 has one function for all calls; the others are only in its header.
    search.old_function = "virtCallDLL";
    search.old_version = "3";
    return search;
  }
};

Result<std::unique_ptr<Device>> VirtDriver::OpenUnchecked(const std::string& address,
                                                          const Surroundings& surroundings) const {
  std::vector<Finding> looked_for;
  const auto library = LoadVendorLibrary<Functions>(Search(surroundings), &looked_for);
  if (!library) {
    return Unexpected(library.error());
  }
  const std::string whole = address.empty() ? kDefaultAddress : address;
  const auto started = OpenAddress(*library, whole);
  if (!started) {
    return Unexpected(started.error());
  }
  if (const int error = Prepare(library->functions, started->context, started->info.profile);
      error != 0) {
    library->functions.virtClose(started->context);
    return Unexpected(NotStarted(library->functions, whole, error));
  }
  return std::make_unique<VirtDevice>(*library, *started, *surroundings.clock);
}

ProbeReport VirtDriver::ProbeUnchecked(const Surroundings& surroundings, bool opens_devices) const {
  ProbeReport report = BeginReport();
  const auto library = ProbeVendorLibrary<Functions>(Search(surroundings), opens_devices, &report);
  if (!library) {
    return report;
  }
  const auto started = OpenAddress(*library, kDefaultAddress);
  report.looked_for.push_back({"controller", kDefaultAddress, started.has_value(), ""});
  if (started) {
    report.devices.push_back(started->info);
    library->functions.virtClose(started->context);
  } else {
    report.problems.push_back(started.error());
  }
  return report;
}

}  // namespace

const Driver& VirtuoseDriver() {
  static const VirtDriver driver;
  return driver;
}

}  // namespace hvas::device
