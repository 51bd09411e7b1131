#include "device/drivers/force_dimension.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "device/drivers/usb_nodes.h"
#include "device/drivers/vendor_drivers.h"

namespace hvas::device {
namespace force_dimension {

VendorVerdict Judge(int error) noexcept {
  switch (error) {
    case 0:
      return VendorVerdict::kFine;
    case kErrorCom:
    case kErrorNoDriver:
    case kErrorNoDevice:
    case kErrorNotAvailable:
    case kErrorTimeout:
      return VendorVerdict::kGone;
    case kErrorNotReady:
      return VendorVerdict::kNotCalibrated;
    default:
      return VendorVerdict::kFault;
  }
}

std::string Explain(int code) {
  static const std::map<int, std::string> words{
      {kErrorCom, "the connection to it failed; check its cable and power"},
      {3, "its controller is busy"},
      {kErrorNoDriver, "the vendor's USB driver is not installed"},
      {kErrorNoDevice, "no device responds; check its cable and power"},
      {kErrorNotAvailable, "it does not support the requested function"},
      {kErrorTimeout, "it did not respond in time; check its cable and power"},
      {kErrorNotReady, "it is not calibrated"},
      {kErrorInUse, "another program has it open"},
      {-kOffByButton, "its forces are switched off; press its force button"},
      {-kOffByVelocity, "it was moved faster than its limit"},
      {-kOffByWatchdog, "it got no command for too long, and its watchdog switched the force off"},
      {-kOffBySoftware, "the vendor's software switched the force off"},
      {-kOffByDisconnection, "its USB connection was lost"},
      {-kOffByDeadMan, "its dead-man switch reports that nobody holds it"}};
  return WordsOf(words, code);
}

std::string ModelOfType(int type) {
  static const std::map<int, std::string> models{
      {33, "omega.3"},   {34, "omega.6"},  {36, "omega.6"},  {35, "omega.7"},
      {37, "omega.7"},   {104, "sigma.7"}, {105, "sigma.7"}, {108, "lambda.7"},
      {109, "lambda.7"}, {63, "delta.3"},  {60, "Falcon"}};
  return WordsOf(models, type);
}

spatial::Pose ToPose(const Vec3& p, const double rows[3][3]) noexcept {
  Mat3 R;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      R(row, column) = rows[row][column];
    }
  }
  return {Quat(R).normalized(), p};
}

void BindAll(SymbolBinder* binder, Functions* functions) {
  HVAS_DHD_FUNCTIONS(HVAS_BIND)
  HVAS_DHD_OPTIONAL_FUNCTIONS(HVAS_BIND_OPTIONAL)
}

}  // namespace force_dimension

namespace {

using namespace force_dimension;  // NOLINT(google-build-using-namespace): this file's own vendor.

constexpr const char* kName = "forcedimension";
constexpr const char* kTitle = "Force Dimension (DHD/DRD)";
constexpr const char* kWeakest = "falcon";
constexpr std::uint16_t kUsbVendor = 0x1451;  // The list of USB vendors has it.
constexpr const char* kRemedy =
    "install the SDK of Force Dimension, and set FORCEDIM_SDK to its folder when that is not below "
    "/usr/local";
// A device that hears nothing for this time lets go; forces are switched on again at most this
// often. Choices, not measured.
constexpr std::int64_t kWatchdogNs = 20'000'000;
constexpr std::int64_t kEnableEveryNs = 100'000'000;
constexpr char kMaxDevices = 16;

using Library = VendorLibrary<Functions>;

struct Started {
  char id;
  DeviceInfo info;
};

Error NotStarted(int error, const std::string& device) {
  const std::string words = Explain(error);
  return {error == kErrorInUse ? ErrorCode::kOutOfResource : ErrorCode::kNotFound,
          fmt::format("device {} of Force Dimension could not be opened: {} (its error {})", device,
                      words.empty() ? "for an unknown reason" : words, error),
          device,
          error == kErrorInUse ? "end that program"
                               : "check its power and cable; users other than root also need a "
                                 "udev rule (\"hvas devices\" shows it)"};
}

/** A figure of the device itself where the SDK has the function and a limit is set. */
void AskFigure(double (*ask)(char), char id, double* figure, const char* name, std::string* note) {
  const double value = ask != nullptr ? ask(id) : -1;
  if (value > 0) {
    *figure = value;
    *note += fmt::format("; read from the device: {}", name);
  }
}

DeviceInfo AskInfo(const Library& library, char id) {
  const Functions& dhd = library.functions;
  DeviceInfo info;
  info.driver = kName;
  info.address = std::to_string(id);
  info.is_emulated = library.is_emulated;
  info.model = ModelOfType(dhd.dhdGetSystemType(id));
  const char* name = dhd.dhdGetSystemName(id);
  if (info.model.empty() && name != nullptr) {
    info.model = name;
  }
  unsigned short serial = 0;
  if (dhd.dhdGetSerialNumber != nullptr && dhd.dhdGetSerialNumber(&serial, id) >= 0) {
    info.serial = std::to_string(serial);
  }
  std::array<int, 4> version{};
  dhd.dhdGetSDKVersion(&version[0], &version[1], &version[2], &version[3]);
  info.version = fmt::format("{}.{}.{}", version[0], version[1], version[2]);
  info.profile = ProfileOfModel(kName, info.model, kWeakest, &info.profile_note);
  AskFigure(dhd.dhdGetMaxForce, id, &info.profile.max_force, "peak force", &info.profile_note);
  Capabilities& has = info.capabilities;
  has.force_axes = 3;
  has.senses_rotation = dhd.dhdHasWrist(id);
  has.has_grip =
      dhd.dhdHasGripper != nullptr && dhd.dhdHasGripper(id) && dhd.dhdGetGripperGap != nullptr;
  has.button_count = 1;
  if (dhd.dhdHasActiveWrist(id)) {
    has.torque_axes = 3;
    AskFigure(dhd.dhdGetMaxTorque, id, &info.profile.max_torque, "peak torque", &info.profile_note);
  } else {
    info.profile.max_torque = 0;
  }
  info.profile.continuous_force = std::min(info.profile.continuous_force, info.profile.max_force);
  info.profile.continuous_torque =
      std::min(info.profile.continuous_torque, info.profile.max_torque);
  return info;
}

/** Opens one by its number; with force off. */
Result<Started> OpenNumber(const Library& library, char id) {
  if (library.functions.drdOpenID(id) < 0) {
    return Unexpected(NotStarted(library.functions.dhdErrorGetLast(), std::to_string(id)));
  }
  return Started{id, AskInfo(library, id)};
}

/** Opens the first that can be; with a serial number only the one that has it. */
Result<Started> OpenFirst(const Library& library, const std::string& serial) {
  Error error = NotStarted(kErrorNoDevice, "0");
  const int count = library.functions.dhdGetDeviceCount();
  for (char id = 0; id < count && id < kMaxDevices; ++id) {
    auto started = OpenNumber(library, id);
    if (started && (serial.empty() || started->info.serial == serial)) {
      return started;
    }
    if (started) {
      library.functions.drdClose(id);
    } else {
      error = started.error();
    }
  }
  return Unexpected(error);
}

Result<void> Calibrate(const Functions& dhd, const Started& started) {
  if (dhd.drdIsInitialized(started.id) || dhd.drdAutoInit(started.id) >= 0) {
    return {};
  }
  return Fail(
      ErrorCode::kUnsupported, fmt::format("{} could not calibrate itself", started.info.model),
      started.info.address,
      "take it out of its rest position, keep your hands off while it moves, and try again");
}

/** Stops the vendor's own control, sets its limits and its watchdog, and switches force on. */
void Prepare(const Functions& dhd, const Started& started) {
  const char id = started.id;
  const DeviceProfile& profile = started.info.profile;
  dhd.drdStop(true, id);
  if (dhd.dhdSetMaxForce != nullptr) {
    dhd.dhdSetMaxForce(profile.max_force, id);
  }
  if (dhd.dhdSetMaxTorque != nullptr && profile.max_torque > 0) {
    dhd.dhdSetMaxTorque(profile.max_torque, id);
  }
  if (dhd.dhdSetGravityCompensation != nullptr) {
    dhd.dhdSetGravityCompensation(1, id);
  }
  if (dhd.dhdEnableExpertMode != nullptr && dhd.dhdDisableExpertMode != nullptr &&
      dhd.dhdSetWatchdog != nullptr) {
    dhd.dhdEnableExpertMode();
    dhd.dhdSetWatchdog(static_cast<unsigned char>(kWatchdogNs / kWatchdogPeriodNs), id);
    dhd.dhdDisableExpertMode();
  }
  dhd.dhdSetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, id);
  dhd.dhdEnableForce(1, id);
}

class DhdDevice final : public VendorDevice {
 public:
  DhdDevice(const Library& library, const Started& started, const Clock& clock)
      : VendorDevice(started.info, clock), library_(library), id_(started.id), is_open_(true) {
    Prepare(dhd_, started);
  }

  ~DhdDevice() override {
    StopReopening();
    LetGo();
  }

 protected:
  Reading ReadVendor(DeviceState* sample) noexcept override;

  void WriteVendor(const spatial::Wrench& F) noexcept override {
    dhd_.dhdSetForceAndTorqueAndGripperForce(F.f.x(), F.f.y(), F.f.z(), F.t.x(), F.t.y(), F.t.z(),
                                             0, id_);
  }

  bool Reopen() override {
    LetGo();
    const auto started = OpenFirst(library_, info().serial);
    if (started) {  // It is not calibrated here: that would move it under somebody's hand.
      id_ = started->id;
      Prepare(dhd_, {started->id, info()});
      is_open_ = true;
    }
    return is_open_;
  }

  [[nodiscard]] std::string ExplainCode(std::int32_t code) const override {
    return force_dimension::Explain(code);
  }

 private:
  void LetGo();
  void ReadStatus(DeviceState* sample) noexcept;

  const Library library_;
  const Functions& dhd_{library_.functions};
  char id_;
  bool is_open_;
  std::int64_t enable_ns_{0};
};

void DhdDevice::LetGo() {
  if (is_open_) {
    dhd_.dhdSetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, id_);
    dhd_.dhdEnableForce(0, id_);
    dhd_.drdClose(id_);
    is_open_ = false;
  }
}

VendorDevice::Reading DhdDevice::ReadVendor(DeviceState* sample) noexcept {
  Vec3 p = Vec3::Zero();
  double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int read = dhd_.dhdGetPositionAndOrientationFrame(&p.x(), &p.y(), &p.z(), rows, id_);
  if (read < 0) {
    sample->vendor_code = dhd_.dhdErrorGetLast();
    const VendorVerdict verdict = Judge(sample->vendor_code);
    sample->condition = ToCondition(verdict);
    return verdict == VendorVerdict::kGone ? Reading::kGone : Reading::kNew;
  }
  sample->X_DH = ToPose(p, rows);
  Vec3& v = sample->V_DH.v;
  Vec3& w = sample->V_DH.w;
  dhd_.dhdGetLinearVelocity(&v.x(), &v.y(), &v.z(), id_);
  if (info().capabilities.senses_rotation) {
    dhd_.dhdGetAngularVelocityRad(&w.x(), &w.y(), &w.z(), id_);
  }
  sample->buttons = dhd_.dhdGetButtonMask(id_);
  double gap = 0;
  if (info().capabilities.has_grip && dhd_.dhdGetGripperGap(&gap, id_) >= 0) {
    sample->grip = std::clamp(1 - gap / kOpenGap, 0.0, 1.0);
  }
  ReadStatus(sample);
  return read == kTimeGuard ? Reading::kRepeated : Reading::kNew;
}

void DhdDevice::ReadStatus(DeviceState* sample) noexcept {
  std::array<int, kStatusCount> status{};
  if (dhd_.dhdGetStatus(status.data(), id_) < 0) {
    return;
  }
  const int cause = status[kStatusForceOffCause];
  if (status[kStatusReset] == 0) {
    sample->condition = Condition::kNotCalibrated;
  } else if (status[kStatusError] != 0) {
    sample->condition = Condition::kFault;
  } else if (status[kStatusForce] == 0) {
    sample->condition = cause == kOffByDeadMan ? Condition::kNotHeld : Condition::kNoForce;
    sample->vendor_code = -cause;
    const bool is_persons_will = cause == kOffByButton || cause == kOffByDeadMan;
    if (!is_persons_will && sample->t_ns >= enable_ns_) {
      enable_ns_ = sample->t_ns + kEnableEveryNs;
      dhd_.dhdEnableForce(1, id_);
    }
  }
}

class DhdDriver final : public Driver {
 public:
  DhdDriver()
      : Driver({kName, kTitle,
                "number of the device, for example \"forcedimension:0\"; default: the first free "
                "one. An uncalibrated device moves by itself when it is opened"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override;
  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override;

 private:
  static LibrarySearch Search(const Surroundings& surroundings) {
    constexpr const char* kBelow = "lib/release/lin-x86_64-gcc";
    LibrarySearch search = MakeLibrarySearch(surroundings,
                                             {{"FDSDK", kBelow},
                                              {"FORCEDIM_SDK", kBelow},
                                              {"FORCEDIM_SDK", "lib"},
                                              {"HOME", ".local/lib"}},
                                             {});
    search.title = kTitle;
    search.names = {"libdrd.so.3*", "libdrd.so"};
    search.remedy = kRemedy;
    search.version = "version 3.5 or later of the SDK";
    return search;
  }
};

Result<std::unique_ptr<Device>> DhdDriver::OpenUnchecked(const std::string& address,
                                                         const Surroundings& surroundings) const {
  int number = -1;
  if (!address.empty()) {
    const auto [end, error] =
        std::from_chars(address.data(), address.data() + address.size(), number);
    if (error != std::errc() || *end != '\0' || number < 0 || number >= kMaxDevices) {
      return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a device number", address),
                  address, std::string(address_help()));
    }
  }
  std::vector<Finding> looked_for;
  const auto library = LoadVendorLibrary<Functions>(Search(surroundings), &looked_for);
  if (!library) {
    return Unexpected(library.error());
  }
  const auto started =
      number < 0 ? OpenFirst(*library, "") : OpenNumber(*library, static_cast<char>(number));
  if (!started) {
    return Unexpected(started.error());
  }
  if (const auto calibrated = Calibrate(library->functions, *started); !calibrated) {
    library->functions.drdClose(started->id);
    return Unexpected(calibrated.error());
  }
  return std::make_unique<DhdDevice>(*library, *started, *surroundings.clock);
}

ProbeReport DhdDriver::ProbeUnchecked(const Surroundings& surroundings, bool opens_devices) const {
  ProbeReport report = BeginReport();
  ProbeUsb(surroundings, kUsbVendor, "Force Dimension", &report);
  const auto library = ProbeVendorLibrary<Functions>(Search(surroundings), opens_devices, &report);
  if (!library) {
    return report;
  }
  const int count = std::min<int>(library->functions.dhdGetDeviceCount(), kMaxDevices);
  if (count <= 0) {
    report.problems.push_back(NotStarted(kErrorNoDevice, "0"));
  }
  for (int number = 0; number < count; ++number) {
    const auto started = OpenNumber(*library, static_cast<char>(number));
    if (!started) {
      report.problems.push_back(started.error());
      continue;
    }
    if (library->functions.drdIsInitialized(started->id)) {
      report.devices.push_back(started->info);
    } else {
      report.problems.push_back(
          {ErrorCode::kUnsupported, fmt::format("{} is not calibrated", started->info.model),
           started->info.address,
           "it calibrates itself when HVAS opens it: keep your hands off while it moves"});
    }
    library->functions.drdClose(started->id);
  }
  return report;
}

}  // namespace

const Driver& ForceDimensionDriver() {
  static const DhdDriver driver;
  return driver;
}

}  // namespace hvas::device
