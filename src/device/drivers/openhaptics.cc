#include "device/drivers/openhaptics.h"

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "base/triple_buffer.h"
#include "base/units.h"
#include "device/drivers/dynamic_library.h"
#include "device/drivers/usb_nodes.h"
#include "device/drivers/vendor_drivers.h"

namespace hvas::device {
namespace openhaptics {

VendorVerdict Judge(std::uint32_t error) noexcept {
  switch (error) {
    case 0:
    case kAlreadyInitiated:
      return VendorVerdict::kFine;
    case kDeviceFault:
    case kCommError:
    case kTimerError:
      return VendorVerdict::kGone;
    default:
      return error >= kWarmMotors && error <= kForceError ? VendorVerdict::kRefuses
                                                          : VendorVerdict::kFault;
  }
}

std::string Explain(std::uint32_t error) {
  static const std::map<std::uint32_t, std::string> words{
      {kWarmMotors, "its motors are too hot; let them cool for some minutes"},
      {kExceededForce, "the commanded force exceeded its maximum"},
      {0x0202, "the commanded force rose faster than its limit"},
      {0x0203, "it was moved faster than its limit"},
      {kForceError, "it could not render the force"},
      {kDeviceFault, "it does not respond; check its power and cable"},
      {kAlreadyInitiated, "another program has it open"},
      {kCommError, "the connection to it failed; check its cable"},
      {kTimerError, "the vendor's scheduler lost its timer"},
      {kIllegalBegin, "a haptic frame was begun twice"},
      {kIllegalEnd, "a haptic frame was ended that was not begun"},
      {kFrameError, "a force was set outside of a haptic frame"},
      {kInvalidLicense, "OpenHaptics has no valid licence"}};
  return WordsOf(words, error);
}

spatial::Pose ToPose(const std::array<double, 16>& m) noexcept {
  Mat3 R;
  R << m[0], m[4], m[8],  //
      m[1], m[5], m[9],   //
      m[2], m[6], m[10];
  return {Quat(R).normalized(),
          Vec3(units::FromMm(m[12]), units::FromMm(m[13]), units::FromMm(m[14]))};
}

}  // namespace openhaptics

namespace {

using namespace openhaptics;  // NOLINT(google-build-using-namespace): this file's own vendor.

constexpr const char* kName = "openhaptics";
constexpr const char* kTitle = "OpenHaptics (3D Systems)";
constexpr const char* kWeakest = "touch";
constexpr std::uint16_t kUsbVendor = 0x2988;  // The list of USB vendors has it.
constexpr const char* kRemedy =
    "install the Touch Device Driver and OpenHaptics Developer Edition of 3D Systems, and set "
    "GTDD_HOME to their folder when that is not below /usr or /opt";
// Errors taken off the vendor's stack at once: a choice.
constexpr int kMaxErrors = 32;
// Time between looks whether the device needs calibration: a choice.
constexpr std::int64_t kCalibrateEveryNs = 500'000'000;
// Beyond this the vendor's last update is old; together with an unchanged pose it is no sample.
constexpr double kOldUpdate_ms = 2.5;

/** A loaded libHD and its one scheduler, which all devices share. */
struct Library {
  Functions hd;
  bool is_emulated{false};
  std::mutex mutex;  ///< Over opening and closing.
  int open_devices{0};
};

/** Calls a function where the vendor wants to be called: in the scheduler once it runs, since the
 current device is one for all threads. */
template <typename Call>
void InScheduler(Library& library, Call call) {
  if (library.open_devices == 0) {
    call();
    return;
  }
  library.hd.hdScheduleSynchronous(
      [](void* data) {
        (*static_cast<Call*>(data))();
        return kDone;
      },
      &call, kHighestPriority);
}

/** Takes all errors off the vendor's stack; the gravest. RT-safe. */
std::uint32_t DrainErrors(const Functions& hd) noexcept {
  std::uint32_t worst = 0;
  for (int k = 0; k < kMaxErrors; ++k) {
    const std::uint32_t error = hd.hdGetError().errorCode;
    if (error == 0) {
      break;
    }
    if (Judge(error) >= Judge(worst)) {
      worst = error;
    }
  }
  return worst;
}

std::string TextOrNothing(const char* text) {
  return text != nullptr ? text : "";
}

struct Started {
  HHD device;
  Vec3 centre;  ///< Of the usable workspace in the vendor's frame [m].
  DeviceInfo info;
};

/** Takes the figures that the device tells itself into its profile. */
void AskFigures(const Functions& hd, Started* started) {
  DeviceProfile& profile = started->info.profile;
  std::string note;
  const auto take = [&](HDenum what, double scale, const char* name, double* figure) {
    double value = 0;
    hd.hdGetDoublev(what, &value);
    if (DrainErrors(hd) == 0 && std::isfinite(value) && value > 0) {
      *figure = scale * value;
      note += fmt::format(", {}", name);
    }
  };
  take(kMaxForce, 1, "peak force", &profile.max_force);
  take(kMaxContinuousForce, 1, "continuous force", &profile.continuous_force);
  take(kMaxStiffness, 1 / units::FromMm(1), "stiffness", &profile.max_stiffness);
  take(kUpdateRate, 1, "rate", &profile.rate_hz);
  std::array<double, 6> box_mm{};
  hd.hdGetDoublev(kUsableWorkspace, box_mm.data());
  const Vec3 low(box_mm[0], box_mm[1], box_mm[2]);
  const Vec3 high(box_mm[3], box_mm[4], box_mm[5]);
  if (DrainErrors(hd) == 0 && low.allFinite() && high.allFinite() &&
      ((high - low).array() > 0).all()) {
    profile.workspace = units::FromMm(1) * (high - low);
    started->centre = units::FromMm(0.5) * (high + low);
    note += ", workspace";
  }
  started->info.profile_note += note.empty() ? "" : "; read from the device: " + note.substr(2);
}

Error NotStarted(std::uint32_t error, const std::string& device) {
  const std::string words = Explain(error);
  const std::string message =
      fmt::format("{} of OpenHaptics could not be started: {} (its error 0x{:04x})",
                  device.empty() ? "the first device" : "\"" + device + "\"",
                  words.empty() ? "for an unknown reason" : words, error);
  if (error == kInvalidLicense) {
    return {ErrorCode::kUnsupported, message, device,
            "install the licence that 3D Systems gave you (its License Installer), or the free "
            "Developer Edition"};
  }
  if (error == kAlreadyInitiated) {
    return {ErrorCode::kOutOfResource, message, device, "end that program"};
  }
  return {ErrorCode::kNotFound, message, device,
          "check its power and cable, name it with the vendor's setup program (Touch Setup), and "
          "run the vendor's diagnostic"};
}

Result<void> Calibrate(const Functions& hd, const std::string& model) {
  const HDenum style = hd.hdCheckCalibrationStyle();
  if (hd.hdCheckCalibration() == kCalibrationNeedsUpdate) {
    hd.hdUpdateCalibration(style);
  }
  const HDenum status = hd.hdCheckCalibration();
  DrainErrors(hd);
  if (status == kCalibrationOk) {
    return {};
  }
  const bool has_inkwell = (style & kCalibrationStyleInkwell) != 0;
  return Fail(ErrorCode::kUnsupported, fmt::format("{} is not calibrated", model), model,
              has_inkwell && status != kCalibrationNeedsManual
                  ? "put its stylus into the inkwell, and try again"
                  : "calibrate it with the vendor's setup program, and try again");
}

/** What a device that is the current one says of itself. */
void AskInfo(const Functions& hd, Started* started) {
  DeviceInfo& info = started->info;
  info.driver = kName;
  info.model = TextOrNothing(hd.hdGetString(kModel));
  info.serial = TextOrNothing(hd.hdGetString(kSerialNumber));
  double version = 0;
  hd.hdGetDoublev(kDriverVersion, &version);
  info.version = DrainErrors(hd) == 0 ? fmt::format("{:g}", version) : "";
  info.profile = ProfileOfModel(kName, info.model, kWeakest, &info.profile_note);
  AskFigures(hd, started);
  int output_dof = 3;
  hd.hdGetIntegerv(kOutputDof, &output_dof);
  DrainErrors(hd);
  if (output_dof > 3) {
    info.profile_note +=
        "; its torques are not used: the vendor's documents disagree on their unit";
  }
  info.profile.max_torque = 0;
  info.profile.continuous_torque = 0;
  info.capabilities.force_axes = 3;
  info.capabilities.senses_rotation = true;
  info.capabilities.button_count = 2;
  // The Desktop's stylus tells whether a hand is on it (so does the Touch X after it).
  info.capabilities.has_presence_switch = info.profile.id == "touch_x";
}

/** Initialises a device and asks what it is; with force off. */
Result<Started> Start(Library& library, const std::string& name) {
  const Functions& hd = library.hd;
  DrainErrors(hd);
  Started started{hd.hdInitDevice(name.empty() ? nullptr : name.c_str()), Vec3::Zero(), {}};
  const std::uint32_t error = DrainErrors(hd);
  if (started.device == kNoDevice || error != 0) {
    return Unexpected(NotStarted(error != 0 ? error : kDeviceFault, name));
  }
  Result<void> calibrated;
  InScheduler(library, [&] {
    hd.hdMakeCurrentDevice(started.device);
    AskInfo(hd, &started);
    calibrated = Calibrate(hd, started.info.model);
  });
  if (!calibrated) {
    hd.hdDisableDevice(started.device);
    return Unexpected(calibrated.error());
  }
  started.info.address = name;
  started.info.is_emulated = library.is_emulated;
  return started;
}

/** One device. The vendor's scheduler calls Tick, which hands samples to Read and takes the force
 from Write. */
class HdDevice final : public VendorDevice {
 public:
  HdDevice(Library* library, const Started& started, const Clock& clock)
      : VendorDevice(started.info, clock), library_(*library), centre_(started.centre) {
    Schedule(started.device);
  }

  ~HdDevice() override {
    StopReopening();
    LetGo();
  }

 protected:
  Reading ReadVendor(DeviceState* sample) noexcept override {
    if (!samples_.Update()) {
      return Reading::kRepeated;
    }
    const Sample& newest = samples_.value();
    const std::int64_t t_ns = sample->t_ns;
    *sample = newest.state;
    sample->t_ns = t_ns;
    if (newest.state.condition == Condition::kLost) {
      return Reading::kGone;
    }
    return newest.is_new ? Reading::kNew : Reading::kRepeated;
  }

  void WriteVendor(const spatial::Wrench& F_H_D) noexcept override {
    forces_.Write({F_H_D.f, NowNs()});
  }

  bool Reopen() override {
    LetGo();
    const std::scoped_lock lock(library_.mutex);
    const auto started = Start(library_, info().address);
    if (started) {
      Schedule(started->device);
    }
    return started.has_value();
  }

  [[nodiscard]] std::string ExplainCode(std::int32_t code) const override {
    return openhaptics::Explain(static_cast<std::uint32_t>(code));
  }

 private:
  struct Sample {
    DeviceState state;
    bool is_new{false};
  };

  struct Force {
    Vec3 f{Vec3::Zero()};
    std::int64_t t_ns{0};
  };

  void Schedule(HHD device);
  void LetGo();
  void Tick() noexcept;
  [[nodiscard]] Sample Sense() noexcept;
  [[nodiscard]] Condition CheckCalibration(std::int64_t now_ns) noexcept;

  Library& library_;
  Vec3 centre_;
  HHD device_{kNoDevice};
  HDSchedulerHandle schedule_{0};
  TripleBuffer<Sample> samples_;
  TripleBuffer<Force> forces_;

  // The scheduler's alone.
  ForceHold hold_;
  std::array<double, 16> last_transform_{};
  std::int64_t calibrate_ns_{0};
};

void HdDevice::Schedule(HHD device) {
  const Functions& hd = library_.hd;
  device_ = device;
  forces_.Write({});
  InScheduler(library_, [&] {
    hd.hdMakeCurrentDevice(device_);
    for (const HDenum capability : {kForceOutput, kForceClamping, kForceRamping}) {
      hd.hdEnable(capability);
    }
    DrainErrors(hd);
  });
  schedule_ = hd.hdScheduleAsynchronous(
      [](void* self) {
        static_cast<HdDevice*>(self)->Tick();
        return kContinue;
      },
      this, kHighestPriority);
  if (library_.open_devices++ == 0) {
    hd.hdStartScheduler();
  }
}

void HdDevice::LetGo() {
  if (device_ == kNoDevice) {
    return;
  }
  const std::scoped_lock lock(library_.mutex);
  const Functions& hd = library_.hd;
  hd.hdUnschedule(schedule_);
  samples_.Update();  // What it said last is of no use to whoever opens it again.
  InScheduler(library_, [&] {
    constexpr std::array<double, 3> kNone{};  // No force.
    hd.hdBeginFrame(device_);
    hd.hdSetDoublev(kForce, kNone.data());
    hd.hdEndFrame(device_);
    hd.hdMakeCurrentDevice(device_);
    hd.hdDisable(kForceOutput);
    DrainErrors(hd);
  });
  if (--library_.open_devices == 0) {
    hd.hdStopScheduler();
  }
  hd.hdDisableDevice(device_);
  device_ = kNoDevice;
}

Condition HdDevice::CheckCalibration(std::int64_t now_ns) noexcept {
  const HDenum status = library_.hd.hdCheckCalibration();
  if (status == kCalibrationOk) {
    return Condition::kReady;
  }
  if (status == kCalibrationNeedsUpdate && now_ns >= calibrate_ns_) {
    calibrate_ns_ = now_ns + kCalibrateEveryNs;
    library_.hd.hdUpdateCalibration(library_.hd.hdCheckCalibrationStyle());
  }
  return Condition::kNotCalibrated;
}

HdDevice::Sample HdDevice::Sense() noexcept {
  const Functions& hd = library_.hd;
  Sample sample;
  DeviceState& state = sample.state;
  std::array<double, 16> transform{};
  std::array<double, 3> v_mm{};
  std::array<double, 3> w{};
  int buttons = 0;
  unsigned char is_held = 1;
  double rate_hz = 0;
  hd.hdGetDoublev(kTransform, transform.data());
  hd.hdGetDoublev(kVelocity, v_mm.data());
  hd.hdGetDoublev(kAngularVelocity, w.data());
  hd.hdGetIntegerv(kButtons, &buttons);
  hd.hdGetDoublev(kInstantaneousRate, &rate_hz);
  if (info().capabilities.has_presence_switch) {
    hd.hdGetBooleanv(kSafetySwitch, &is_held);
  }
  const spatial::Pose X = ToPose(transform);
  state.X_DH = {X.q(), X.p() - centre_};
  state.V_DH = {Vec3(w[0], w[1], w[2]), units::FromMm(1) * Vec3(v_mm[0], v_mm[1], v_mm[2])};
  state.buttons = static_cast<std::uint32_t>(buttons);
  state.condition = is_held != 0 ? Condition::kReady : Condition::kNotHeld;
  const bool is_old = rate_hz > 0 && 1000 / rate_hz > kOldUpdate_ms;
  sample.is_new = !is_old || transform != last_transform_;
  last_transform_ = transform;
  return sample;
}

void HdDevice::Tick() noexcept {
  const Functions& hd = library_.hd;
  const std::int64_t now_ns = NowNs();
  forces_.Update();
  const Force& force = forces_.value();
  const double share = hold_.CalcShare(force.t_ns, now_ns);
  hd.hdBeginFrame(device_);
  Sample sample = Sense();
  if (const Condition calibration = CheckCalibration(now_ns); calibration != Condition::kReady) {
    sample.state.condition = calibration;
  }
  const bool shows = sample.is_new && sample.state.condition == Condition::kReady;
  const Vec3 f = shows ? Vec3(share * force.f) : Vec3::Zero();
  hd.hdSetDoublev(kForce, f.data());
  hd.hdEndFrame(device_);
  const std::uint32_t error = DrainErrors(hd);
  if (const VendorVerdict verdict = Judge(error); verdict != VendorVerdict::kFine) {
    sample.state.condition = ToCondition(verdict);
    sample.state.vendor_code = static_cast<std::int32_t>(error);
    sample.is_new = true;
  }
  samples_.Write(sample);
}

class HdDriver final : public Driver {
 public:
  HdDriver()
      : Driver({kName, kTitle,
                "name of the device in the vendor's setup program, for example "
                "\"openhaptics:Default Device\"; default: the first one"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override;

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override {
    std::vector<Finding> looked_for;
    auto library = Load(surroundings, &looked_for);
    if (!library) {
      return Unexpected(library.error());
    }
    const std::scoped_lock lock((*library)->mutex);
    auto started = Start(**library, address);
    if (!started) {
      return Unexpected(started.error());
    }
    return std::make_unique<HdDevice>(*library, *started, *surroundings.clock);
  }

 private:
  static LibrarySearch Search(const Surroundings& surroundings) {
    LibrarySearch search = MakeLibrarySearch(
        surroundings, {{"GTDD_HOME", "lib"}, {"GTDD_HOME", ""}, {"OPENHAPTICS", "lib"}},
        {"/opt/geomagic_touch_device_driver/lib", "/opt/OpenHaptics/Developer/lib"});
    search.title = kTitle;
    search.names = {"libHD.so.3*", "libHD.so"};
    search.remedy = kRemedy;
    search.version = "OpenHaptics 3.0 or later";
    return search;
  }

  static Result<Library*> Load(const Surroundings& surroundings, std::vector<Finding>* looked_for);
};

Result<Library*> HdDriver::Load(const Surroundings& surroundings,
                                std::vector<Finding>* looked_for) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<Library>> libraries;  // For ever, by path.
  auto fresh = std::make_unique<Library>();
  Functions* functions = &fresh->hd;
  const auto loaded = LoadFunctions(Search(surroundings), looked_for,
                                    [&](SymbolBinder* binder) { HVAS_HD_FUNCTIONS(HVAS_BIND) });
  if (!loaded) {
    return Unexpected(loaded.error());
  }
  fresh->is_emulated = loaded->is_emulated();
  const std::scoped_lock lock(mutex);
  return libraries.emplace(loaded->path(), std::move(fresh)).first->second.get();
}

ProbeReport HdDriver::ProbeUnchecked(const Surroundings& surroundings, bool opens_devices) const {
  ProbeReport report = BeginReport();
  ProbeUsb(surroundings, kUsbVendor, "3D Systems", &report);
  const auto library = ProbeLibrary(
      Search(surroundings), opens_devices, &report,
      [&](std::vector<Finding>* looked_for) { return Load(surroundings, looked_for); });
  if (!library) {
    return report;
  }
  const std::scoped_lock lock((*library)->mutex);
  auto started = Start(**library, "");
  if (started) {
    report.devices.push_back(started->info);
    (*library)->hd.hdDisableDevice(started->device);
  } else {
    report.problems.push_back(started.error());
  }
  return report;
}

}  // namespace

const Driver& OpenHapticsDriver() {
  static const HdDriver driver;
  return driver;
}

}  // namespace hvas::device
