// libdrd.so of an emulated device: the functions and manners of Force Dimension's SDK around an
// EmulatedPort.

#include <algorithm>

#include "device/drivers/force_dimension.h"
#include "device/emulation/stub_library.h"

#define HVAS_EXPORT __attribute__((visibility("default")))

namespace hvas::device::force_dimension {
namespace {

struct DhdSlot : StubSlot {
  bool is_initialized{true};
  bool has_force{false};
  int off_cause{0};
  std::uint64_t read_sequence{0};  ///< Of the sample that was read last.
  bool has_read{false};
  double max_force{-1};
  double max_torque{-1};
  std::int64_t watchdog_ns{0};
  std::int64_t now_ns{0};
  std::int64_t fed_ns{-1};  ///< When a force was set last; below 0: never.

  void CutForce(int cause) {
    has_force = false;
    off_cause = cause;
    Command({});
  }
};

StubSlots<DhdSlot>& Slots() {
  static StubSlots<DhdSlot> slots;
  return slots;
}

thread_local int last_error = 0;
bool is_expert = false;

int Fails(int error) {
  last_error = error;
  return -1;
}

/** An open device, locked; none when it is not open or not plugged in, which is then the error. */
class Call {
 public:
  explicit Call(char id) : lock_(Slots().mutex()), slot_(Slots().Find(id)) {
    if (slot_ != nullptr && !slot_->is_open) {
      slot_ = nullptr;
    }
    if (slot_ == nullptr) {
      last_error = kErrorNoDevice;
    } else if (!slot_->is_plugged()) {
      slot_ = nullptr;
      last_error = kErrorCom;
    }
  }

  explicit operator bool() const { return slot_ != nullptr; }

  DhdSlot* operator->() const { return slot_; }

 private:
  std::scoped_lock<std::recursive_mutex> lock_;
  DhdSlot* slot_;
};

/** Force is off by itself while the device refuses it; it stays off until it is enabled again. */
void ApplyFault(DhdSlot* slot) {
  if (slot->fault() == Fault::kForceRefused && slot->has_force) {
    slot->CutForce(kOffByVelocity);
  }
}

void Tick(int number, std::int64_t now_ns) {
  const std::scoped_lock lock(Slots().mutex());
  DhdSlot* slot = Slots().Find(number);
  slot->now_ns = now_ns;
  ApplyFault(slot);
  const bool is_hungry =
      slot->watchdog_ns > 0 && slot->fed_ns >= 0 && now_ns - slot->fed_ns > slot->watchdog_ns;
  if (is_hungry && slot->has_force) {
    slot->CutForce(kOffByWatchdog);
  }
}

int Attach(EmulatedPort* port, const StubTraits& traits) {
  const int number = Slots().Attach(port, traits);
  if (DhdSlot* slot = Slots().Find(number); slot != nullptr) {
    slot->is_initialized = traits.is_calibrated;
    slot->max_force = traits.max_force;
    slot->max_torque = traits.max_torque;
  }
  return number;
}

void Detach(int number) {
  Slots().Detach(number);
}

int CopyTo(const Vec3& v, double* x, double* y, double* z) {
  *x = v.x();
  *y = v.y();
  *z = v.z();
  return 0;
}

Vec3 LimitNorm(const Vec3& v, double limit) {
  return limit >= 0 && v.norm() > limit ? Vec3(limit / v.norm() * v) : v;
}

bool IsCalibrated(const DhdSlot& slot) {
  return slot.is_initialized && slot.fault() != Fault::kCalibrationLost;
}

}  // namespace

extern "C" {

HVAS_EXPORT const StubEntry* hvas_emulator() {
  static const StubEntry entry{Attach, Detach, Tick};
  return &entry;
}

HVAS_EXPORT void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 5;
  *revision = 0;
}

HVAS_EXPORT int dhdGetDeviceCount() {
  const std::scoped_lock lock(Slots().mutex());
  int count = 0;
  for (int number = 0; number < kMaxStubDevices; ++number) {
    count = Slots().Find(number)->is_plugged() ? number + 1 : count;
  }
  return count;
}

HVAS_EXPORT int dhdErrorGetLast() {
  return last_error;
}

HVAS_EXPORT int drdOpenID(char id) {
  const std::scoped_lock lock(Slots().mutex());
  DhdSlot* slot = Slots().Find(id);
  if (slot == nullptr || !slot->is_plugged()) {
    return Fails(kErrorNoDevice);
  }
  if (slot->is_open) {
    return Fails(kErrorInUse);
  }
  slot->is_open = true;
  slot->has_force = false;
  slot->off_cause = 0;
  slot->has_read = false;
  slot->fed_ns = -1;
  return id;
}

HVAS_EXPORT int drdClose(char id) {
  const std::scoped_lock lock(Slots().mutex());
  if (DhdSlot* slot = Slots().Find(id); slot != nullptr && slot->is_open) {
    slot->Command({});
    slot->is_open = false;
    return 0;
  }
  return Fails(kErrorNoDevice);
}

HVAS_EXPORT bool drdIsInitialized(char id) {
  const Call call(id);
  return call && IsCalibrated(*call.operator->());
}

HVAS_EXPORT int drdAutoInit(char id) {
  const Call call(id);
  if (!call || !call->traits.can_calibrate) {
    return Fails(kErrorNotReady);
  }
  call->is_initialized = true;
  return 0;
}

HVAS_EXPORT int drdStop(bool /*keeps_force*/, char id) {
  const Call call(id);
  return call ? 0 : -1;
}

HVAS_EXPORT int dhdGetSystemType(char id) {
  const Call call(id);
  return call ? call->traits.system_type : -1;
}

HVAS_EXPORT const char* dhdGetSystemName(char id) {
  const Call call(id);
  return call ? call->traits.model : nullptr;
}

HVAS_EXPORT int dhdGetSerialNumber(unsigned short* number, char id) {
  const Call call(id);
  *number = static_cast<unsigned short>(60000 + id);
  return call ? 0 : -1;
}

HVAS_EXPORT bool dhdHasWrist(char id) {
  const Call call(id);
  return call && call->port->profile().rotation_resolution > 0;
}

HVAS_EXPORT bool dhdHasActiveWrist(char id) {
  const Call call(id);
  return call && call->traits.has_active_wrist;
}

HVAS_EXPORT bool dhdHasGripper(char id) {
  const Call call(id);
  return call && call->traits.has_gripper;
}

HVAS_EXPORT double dhdGetMaxForce(char id) {
  const Call call(id);
  return call ? call->max_force : -1;
}

HVAS_EXPORT double dhdGetMaxTorque(char id) {
  const Call call(id);
  return call ? call->max_torque : -1;
}

HVAS_EXPORT int dhdSetMaxForce(double force, char id) {
  const Call call(id);
  if (call) {
    call->max_force = force;
  }
  return call ? 0 : -1;
}

HVAS_EXPORT int dhdSetMaxTorque(double torque, char id) {
  const Call call(id);
  if (call) {
    call->max_torque = torque;
  }
  return call ? 0 : -1;
}

HVAS_EXPORT int dhdSetGravityCompensation(int /*is_on*/, char id) {
  const Call call(id);
  return call ? 0 : -1;
}

HVAS_EXPORT int dhdEnableExpertMode() {
  is_expert = true;
  return 0;
}

HVAS_EXPORT int dhdDisableExpertMode() {
  is_expert = false;
  return 0;
}

HVAS_EXPORT int dhdSetWatchdog(unsigned char periods, char id) {
  const Call call(id);
  if (!call || !is_expert) {
    return Fails(9);
  }
  call->watchdog_ns = periods * kWatchdogPeriodNs;
  return 0;
}

HVAS_EXPORT int dhdEnableForce(unsigned char is_on, char id) {
  const Call call(id);
  if (!call) {
    return -1;
  }
  if (is_on == 0) {
    call->CutForce(kOffBySoftware);
    return 0;
  }
  call->has_force = true;
  call->off_cause = 0;
  call->fed_ns = -1;
  ApplyFault(call.operator->());
  return 0;
}

HVAS_EXPORT int dhdGetStatus(int status[17], char id) {
  const Call call(id);
  if (!call) {
    return -1;
  }
  std::fill_n(status, kStatusCount, 0);
  status[0] = 1;
  status[1] = 1;
  status[2] = 1;
  status[kStatusReset] = IsCalibrated(*call.operator->()) ? 1 : 0;
  status[kStatusForce] = call->has_force ? 1 : 0;
  status[kStatusForceOffCause] = call->off_cause;
  return 0;
}

HVAS_EXPORT int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z,
                                                  double rows[3][3], char id) {
  const Call call(id);
  if (!call) {
    return -1;
  }
  call->sample = call->port->Sense();
  const Mat3 R = call->sample.X_DH.R();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows[row][column] = R(row, column);
    }
  }
  CopyTo(call->sample.X_DH.p(), x, y, z);
  const bool is_again = call->has_read && call->read_sequence == call->sample.sequence;
  call->has_read = true;
  call->read_sequence = call->sample.sequence;
  return is_again ? kTimeGuard : 0;
}

HVAS_EXPORT int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  const Call call(id);
  return call ? CopyTo(call->sample.V_DH.v, x, y, z) : -1;
}

HVAS_EXPORT int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id) {
  const Call call(id);
  return call ? CopyTo(call->sample.V_DH.w, x, y, z) : -1;
}

HVAS_EXPORT unsigned dhdGetButtonMask(char id) {
  const Call call(id);
  return call ? call->sample.buttons : 0;
}

HVAS_EXPORT int dhdGetGripperGap(double* gap, char id) {
  const Call call(id);
  *gap = call ? (1 - call->sample.grip) * kOpenGap : 0;
  return call ? 0 : -1;
}

HVAS_EXPORT double dhdGetComFreq(char id) {
  const Call call(id);
  return call ? 1e-3 * call->port->profile().rate_hz : 0;
}

HVAS_EXPORT int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx,
                                                    double ty, double tz, double /*grip*/,
                                                    char id) {
  const Call call(id);
  if (!call) {
    return -1;
  }
  call->fed_ns = call->now_ns;
  ApplyFault(call.operator->());
  spatial::Wrench F;
  if (call->has_force) {
    F.f = LimitNorm(Vec3(fx, fy, fz), call->max_force);
    F.t = call->traits.has_active_wrist ? LimitNorm(Vec3(tx, ty, tz), call->max_torque)
                                        : Vec3::Zero();
  }
  call->Command(F);
  return 0;
}

}  // extern "C"
}  // namespace hvas::device::force_dimension
