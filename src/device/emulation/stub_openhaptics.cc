// libHD.so of an emulated device: HDAPI's functions and manners around an EmulatedPort.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "base/units.h"
#include "device/drivers/openhaptics.h"
#include "device/emulation/stub_library.h"

#define HVAS_EXPORT __attribute__((visibility("default")))

namespace hvas::device::openhaptics {
namespace {

struct HdSlot : StubSlot {
  std::string serial;
  bool has_force{false};
  bool is_calibrated{true};
  bool is_in_frame{false};
  int ticks_without_sample{0};
  Vec3 force{Vec3::Zero()};
};

struct Scheduled {
  HDSchedulerHandle handle;
  int number;  ///< Of the device that was current when it was scheduled.
  HDCallback callback;
  void* data;
};

/** The library's state; one for all devices, as the vendor's. */
struct State {
  StubSlots<HdSlot> slots;
  std::deque<HDErrorInfo> errors;
  std::vector<Scheduled> scheduled;
  HDSchedulerHandle next_handle{1};
  HHD current{kNoDevice};
  bool is_running{false};
};

State& TheState() {
  static State state;
  return state;
}

/** The library, locked, and the device that is the current one. */
class Call {
 public:
  Call() : lock_(TheState().slots.mutex()) {}

  static HdSlot* Find(HHD device) {
    HdSlot* slot = TheState().slots.Find(static_cast<int>(device));
    return slot != nullptr && slot->is_open ? slot : nullptr;
  }

  static HdSlot* Current() { return Find(TheState().current); }

  static void Push(std::uint32_t error) {
    TheState().errors.push_back({error, 0, TheState().current});
  }

 private:
  std::scoped_lock<std::recursive_mutex> lock_;
};

void Sense(HdSlot* slot) {
  if (slot->port == nullptr) {
    return;
  }
  const EmulatedSample newest = slot->port->Sense();
  const bool is_new = newest.sequence != slot->sample.sequence;
  slot->ticks_without_sample = is_new ? 0 : slot->ticks_without_sample + 1;
  slot->sample = newest;
}

void Tick(int number, std::int64_t /*now_ns*/) {
  const Call call;
  State& state = TheState();
  if (!state.is_running) {
    return;
  }
  const std::vector<Scheduled> scheduled = state.scheduled;
  for (const Scheduled& entry : scheduled) {
    if (entry.number == number && entry.callback(entry.data) == kDone) {
      hdUnschedule(entry.handle);
    }
  }
}

int Attach(EmulatedPort* port, const StubTraits& traits) {
  const int number = TheState().slots.Attach(port, traits);
  if (HdSlot* slot = TheState().slots.Find(number); slot != nullptr) {
    slot->serial = "EMULATED" + std::to_string(number);
    slot->is_calibrated = traits.is_calibrated;
  }
  return number;
}

void Detach(int number) {
  TheState().slots.Detach(number);
}

/** "Emulated 3" is number 3; no name is the first that is not open. */
int NumberOf(const char* name) {
  int number = -1;
  if (name != nullptr && std::sscanf(name, "Emulated %d", &number) == 1) {
    return number;
  }
  const auto& slots = TheState().slots.slots();
  const auto found = std::find_if(slots.begin(), slots.end(), [](const HdSlot& slot) {
    return slot.port != nullptr && !slot.is_open;
  });
  const bool is_any = name == nullptr || std::strcmp(name, "Default PHANToM") == 0;
  return is_any && found != slots.end() ? static_cast<int>(found - slots.begin()) : -1;
}

void CopyMm(const Vec3& v, double* value) {
  for (int k = 0; k < 3; ++k) {
    value[k] = units::ToMm(v[k]);
  }
}

void CopyTransform(const spatial::Pose& X, double* value) {
  const Mat3 R = X.R();
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      value[4 * column + row] = R(row, column);
    }
    value[4 * column + 3] = 0;
  }
  CopyMm(X.p(), value + 12);
  value[15] = 1;
}

void CopyBox(const Vec3& edges, double* value) {
  CopyMm(-0.5 * edges, value);
  CopyMm(0.5 * edges, value + 3);
}

}  // namespace

extern "C" {

HVAS_EXPORT const StubEntry* hvas_emulator() {
  static const StubEntry entry{Attach, Detach, Tick};
  return &entry;
}

HVAS_EXPORT HHD hdInitDevice(const char* name) {
  const Call call;
  const int number = NumberOf(name);
  HdSlot* slot = TheState().slots.Find(number);
  if (slot == nullptr || slot->port == nullptr) {
    Call::Push(kDeviceFault);
    return kNoDevice;
  }
  const std::uint32_t error = !slot->traits.is_licensed ? kInvalidLicense
                              : !slot->is_plugged()     ? kCommError
                              : slot->is_open           ? kAlreadyInitiated
                                                        : 0;
  if (error != 0) {
    Call::Push(error);
    return kNoDevice;
  }
  slot->is_open = true;
  slot->has_force = false;
  slot->is_in_frame = false;
  slot->force = Vec3::Zero();
  Sense(slot);
  TheState().current = static_cast<HHD>(number);
  return TheState().current;
}

HVAS_EXPORT void hdDisableDevice(HHD device) {
  const Call call;
  if (HdSlot* slot = Call::Find(device); slot != nullptr) {
    slot->Command({});
    slot->is_open = false;
  }
}

HVAS_EXPORT void hdMakeCurrentDevice(HHD device) {
  const Call call;
  TheState().current = device;
}

HVAS_EXPORT void hdBeginFrame(HHD device) {
  const Call call;
  TheState().current = device;
  HdSlot* slot = Call::Current();
  if (slot == nullptr || !slot->is_plugged()) {
    Call::Push(slot == nullptr ? kDeviceFault : kCommError);
  } else if (slot->is_in_frame) {
    Call::Push(kIllegalBegin);
  }
  if (slot != nullptr) {
    slot->is_in_frame = true;
    slot->force = Vec3::Zero();
    Sense(slot);
  }
}

HVAS_EXPORT void hdEndFrame(HHD device) {
  const Call call;
  HdSlot* slot = Call::Find(device);
  if (slot == nullptr || !slot->is_in_frame) {
    Call::Push(kIllegalEnd);
    return;
  }
  slot->is_in_frame = false;
  const bool is_refused = slot->fault() == Fault::kForceRefused && slot->force.norm() > 0;
  if (is_refused) {
    Call::Push(kExceededForce);
  }
  const bool shows = slot->has_force && !is_refused;
  slot->Command({Vec3::Zero(), shows ? slot->force : Vec3::Zero()});
}

HVAS_EXPORT HDErrorInfo hdGetError() {
  const Call call;
  auto& errors = TheState().errors;
  if (errors.empty()) {
    return {0, 0, kNoDevice};
  }
  const HDErrorInfo newest = errors.back();
  errors.pop_back();
  return newest;
}

HVAS_EXPORT void hdEnable(HDenum capability) {
  const Call call;
  if (HdSlot* slot = Call::Current(); slot != nullptr && capability == kForceOutput) {
    slot->has_force = true;
  }
}

HVAS_EXPORT void hdDisable(HDenum capability) {
  const Call call;
  if (HdSlot* slot = Call::Current(); slot != nullptr && capability == kForceOutput) {
    slot->has_force = false;
    slot->Command({});
  }
}

HVAS_EXPORT void hdGetBooleanv(HDenum what, unsigned char* value) {
  const Call call;
  if (const HdSlot* slot = Call::Current(); slot != nullptr && what == kSafetySwitch) {
    *value = slot->sample.is_holding ? 1 : 0;
  }
}

HVAS_EXPORT void hdGetIntegerv(HDenum what, int* value) {
  const Call call;
  const HdSlot* slot = Call::Current();
  if (slot != nullptr && what == kButtons) {
    *value = static_cast<int>(slot->sample.buttons);
  } else if (slot != nullptr && what == kOutputDof) {
    *value = slot->port != nullptr && slot->port->profile().max_torque > 0 ? 6 : 3;
  }
}

HVAS_EXPORT void hdGetDoublev(HDenum what, double* value) {
  const Call call;
  const HdSlot* slot = Call::Current();
  if (slot == nullptr || slot->port == nullptr) {
    Call::Push(kDeviceFault);
    return;
  }
  const DeviceProfile profile = slot->port->profile();
  const EmulatedSample& sample = slot->sample;
  switch (what) {
    case kPosition:
      return CopyMm(sample.X_DH.p(), value);
    case kVelocity:
      return CopyMm(sample.V_DH.v, value);
    case kTransform:
      return CopyTransform(sample.X_DH, value);
    case kAngularVelocity:
      std::copy_n(sample.V_DH.w.data(), 3, value);
      return;
    case kDriverVersion:
      *value = 4.3;
      return;
    case kUsableWorkspace:
      return CopyBox(profile.workspace, value);
    case kUpdateRate:
      *value = profile.rate_hz;
      return;
    case kInstantaneousRate:
      *value = profile.rate_hz / std::max(slot->ticks_without_sample + 1, 1);
      return;
    case kMaxStiffness:
      *value = units::FromMm(profile.max_stiffness);  // N/mm
      return;
    case kMaxForce:
      *value = profile.max_force;
      return;
    case kMaxContinuousForce:
      *value = profile.continuous_force;
      return;
    default:
      return;
  }
}

HVAS_EXPORT const char* hdGetString(HDenum what) {
  const Call call;
  const HdSlot* slot = Call::Current();
  if (slot == nullptr || slot->port == nullptr) {
    return "";
  }
  return what == kModel ? slot->traits.model : what == kSerialNumber ? slot->serial.c_str() : "";
}

HVAS_EXPORT void hdSetDoublev(HDenum what, const double* value) {
  const Call call;
  HdSlot* slot = Call::Current();
  if (slot == nullptr || !slot->is_in_frame) {
    Call::Push(kFrameError);
  } else if (what == kForce) {
    slot->force = Vec3(value[0], value[1], value[2]);
  }
}

HVAS_EXPORT HDenum hdCheckCalibration() {
  const Call call;
  const HdSlot* slot = Call::Current();
  const bool is_calibrated =
      slot != nullptr && slot->is_calibrated && slot->fault() != Fault::kCalibrationLost;
  return is_calibrated ? kCalibrationOk : kCalibrationNeedsUpdate;
}

HVAS_EXPORT HDenum hdCheckCalibrationStyle() {
  return kCalibrationStyleInkwell;
}

HVAS_EXPORT void hdUpdateCalibration(HDenum style) {
  const Call call;
  HdSlot* slot = Call::Current();
  if (slot != nullptr && style == kCalibrationStyleInkwell && slot->traits.can_calibrate) {
    slot->is_calibrated = true;
  }
}

HVAS_EXPORT void hdStartScheduler() {
  const Call call;
  TheState().is_running = true;
}

HVAS_EXPORT void hdStopScheduler() {
  const Call call;
  TheState().is_running = false;
  for (const HdSlot& slot : TheState().slots.slots()) {
    slot.Command({});
  }
}

HVAS_EXPORT HDSchedulerHandle hdScheduleAsynchronous(HDCallback callback, void* data,
                                                     unsigned short /*priority*/) {
  const Call call;
  State& state = TheState();
  state.scheduled.push_back({state.next_handle, static_cast<int>(state.current), callback, data});
  return state.next_handle++;
}

HVAS_EXPORT void hdScheduleSynchronous(HDCallback callback, void* data,
                                       unsigned short /*priority*/) {
  const Call call;
  callback(data);
}

HVAS_EXPORT void hdUnschedule(HDSchedulerHandle handle) {
  const Call call;
  auto& scheduled = TheState().scheduled;
  scheduled.erase(
      std::remove_if(scheduled.begin(), scheduled.end(),
                     [handle](const Scheduled& entry) { return entry.handle == handle; }),
      scheduled.end());
}

}  // extern "C"
}  // namespace hvas::device::openhaptics
