// virtuoseAPI.so of an emulated device: the functions and manners of VirtuoseAPI 4 around an
// EmulatedPort.

#include <algorithm>
#include <cstdio>

#include "device/drivers/virtuose.h"
#include "device/emulation/stub_library.h"

#define HVAS_EXPORT __attribute__((visibility("default")))

namespace hvas::device::virtuose {
namespace {

struct VirtSlot : StubSlot {
  int number{0};
  bool is_powered{false};
  int command_type{0};
  int error{0};
  double max_force{0};
  double max_torque{0};
  std::int64_t timeout_ns{0};
  std::int64_t now_ns{0};
  std::int64_t fed_ns{0};
  std::int64_t sampled_ns{0};  ///< When the last new sample came.
  std::uint64_t sequence{0};
};

StubSlots<VirtSlot>& Slots() {
  static StubSlots<VirtSlot> slots;
  return slots;
}

int open_error = 0;  // Of the last virtOpen.

/** A device, locked; without its controller every call fails with the error for that. */
class Call {
 public:
  explicit Call(void* context) : lock_(Slots().mutex()), slot_(static_cast<VirtSlot*>(context)) {
    slot_->error = slot_->is_plugged() ? 0 : kErrorCommunication;
  }

  explicit operator bool() const { return slot_->error == 0; }

  VirtSlot* operator->() const { return slot_; }

  [[nodiscard]] int result() const { return slot_->error == 0 ? 0 : -1; }

 private:
  std::scoped_lock<std::recursive_mutex> lock_;
  VirtSlot* slot_;
};

/** Sets one value of a device. */
template <typename Member, typename Value>
int Set(void* context, Member VirtSlot::*member, Value value) {
  const Call call(context);
  if (call) {
    call.operator->()->*member = static_cast<Member>(value);
  }
  return call.result();
}

/** Checks no more than that the device is there. */
int Check(void* context) {
  return Call(context).result();
}

void CutPower(VirtSlot* slot) {
  slot->is_powered = false;
  slot->Command({});
}

void Tick(int number, std::int64_t now_ns) {
  const std::scoped_lock lock(Slots().mutex());
  VirtSlot* slot = Slots().Find(number);
  slot->now_ns = now_ns;
  if (slot->port == nullptr) {
    return;
  }
  slot->sample = slot->port->Sense();
  if (slot->sample.sequence != slot->sequence) {
    slot->sequence = slot->sample.sequence;
    slot->sampled_ns = now_ns;
  }
  if (slot->fault() == Fault::kForceRefused && slot->is_powered) {
    CutPower(slot);
  }
  const bool is_late = slot->timeout_ns > 0 && now_ns - slot->fed_ns > slot->timeout_ns;
  if (is_late || !slot->sample.is_holding || slot->sample.is_stopped) {
    slot->Command({});
  }
}

int Attach(EmulatedPort* port, const StubTraits& traits) {
  const int number = Slots().Attach(port, traits);
  if (VirtSlot* slot = Slots().Find(number); slot != nullptr) {
    slot->number = number;
  }
  return number;
}

void Detach(int number) {
  Slots().Detach(number);
}

/** "emulated#3" is number 3; any other address is the first that is not open. */
VirtSlot* FindAddress(const char* address) {
  int number = -1;
  if (std::sscanf(address, "emulated#%d", &number) == 1) {
    return Slots().Find(number);
  }
  auto& slots = Slots().slots();
  const auto found = std::find_if(slots.begin(), slots.end(), [](const VirtSlot& slot) {
    return slot.port != nullptr && !slot.is_open;
  });
  return found != slots.end() ? &*found : nullptr;
}

Vec3 LimitNorm(const Vec3& v, double limit) {
  return limit > 0 && v.norm() > limit ? Vec3(limit / v.norm() * v) : v;
}

}  // namespace

extern "C" {

HVAS_EXPORT const StubEntry* hvas_emulator() {
  static const StubEntry entry{Attach, Detach, Tick};
  return &entry;
}

HVAS_EXPORT void* virtOpen(const char* address) {
  const std::scoped_lock lock(Slots().mutex());
  VirtSlot* slot = FindAddress(address);
  if (slot == nullptr || slot->is_open || !slot->is_plugged()) {
    open_error = kErrorCommunication;
    return nullptr;
  }
  if (!slot->traits.is_of_this_version) {
    open_error = kErrorVersion;
    return nullptr;
  }
  slot->is_open = true;
  slot->is_powered = false;
  slot->command_type = 0;
  return slot;
}

HVAS_EXPORT int virtClose(void* device) {
  const Call call(device);
  call->Command({});
  call->is_open = false;
  return call.result();
}

HVAS_EXPORT int virtGetErrorCode(void* device) {
  const std::scoped_lock lock(Slots().mutex());
  return device != nullptr ? static_cast<VirtSlot*>(device)->error : open_error;
}

HVAS_EXPORT char* virtGetErrorMessage(int /*code*/) {
  static char text[] = "emulated error";
  return text;
}

HVAS_EXPORT int virtSetIndexingMode(void* device, int /*mode*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetForceFactor(void* device, float /*factor*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetSpeedFactor(void* device, float /*factor*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetTimeStep(void* device, float /*step*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetBaseFrame(void* device, float* /*pose*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetObservationFrame(void* device, float* /*pose*/) {
  return Check(device);
}

HVAS_EXPORT int virtSetCommandType(void* device, int type) {
  return Set(device, &VirtSlot::command_type, type);
}

HVAS_EXPORT int virtSetTimeoutValue(void* device, float timeout) {
  return Set(device, &VirtSlot::timeout_ns, 1e9 * static_cast<double>(timeout));
}

HVAS_EXPORT int virtSaturateTorque(void* device, float force, float torque) {
  Set(device, &VirtSlot::max_force, force);
  return Set(device, &VirtSlot::max_torque, torque);
}

HVAS_EXPORT int virtSetPowerOn(void* device, int is_on) {
  const Call call(device);
  if (!call) {
    return -1;
  }
  call->is_powered = is_on != 0 && call->fault() != Fault::kForceRefused;
  if (!call->is_powered) {
    call->Command({});
  }
  return 0;
}

HVAS_EXPORT int virtGetPowerOn(void* device, int* is_on) {
  const Call call(device);
  *is_on = call->is_powered ? 1 : 0;
  return call.result();
}

HVAS_EXPORT int virtGetPosition(void* device, float* pose) {
  const Call call(device);
  if (!call) {
    return -1;
  }
  call->sample = call->port->Sense();
  const spatial::Pose& X = call->sample.X_DH;
  std::transform(X.p().data(), X.p().data() + 3, pose,
                 [](double value) { return static_cast<float>(value); });
  pose[3] = static_cast<float>(X.q().x());
  pose[4] = static_cast<float>(X.q().y());
  pose[5] = static_cast<float>(X.q().z());
  pose[6] = static_cast<float>(X.q().w());
  return 0;
}

HVAS_EXPORT int virtGetSpeed(void* device, float* speed) {
  const Call call(device);
  for (int k = 0; k < 3; ++k) {
    speed[k] = static_cast<float>(call->sample.V_DH.v[k]);
    speed[k + 3] = static_cast<float>(call->sample.V_DH.w[k]);
  }
  return call.result();
}

HVAS_EXPORT int virtSetForce(void* device, float* force) {
  const Call call(device);
  if (!call) {
    return -1;
  }
  call->fed_ns = call->now_ns;
  if (call->fault() == Fault::kJump) {
    call->Command({});
    call->error = kErrorDiscontinuity;
    return -1;
  }
  const bool shows = call->is_powered && call->command_type == kCommandImpedance &&
                     call->sample.is_holding && !call->sample.is_stopped;
  spatial::Wrench F;
  if (shows) {
    F.f = LimitNorm(Vec3(double{force[0]}, double{force[1]}, double{force[2]}), call->max_force);
    F.t = LimitNorm(Vec3(double{force[3]}, double{force[4]}, double{force[5]}), call->max_torque);
  }
  call->Command(F);
  return 0;
}

HVAS_EXPORT int virtGetDeadMan(void* device, int* is_held) {
  const Call call(device);
  *is_held = call->sample.is_holding ? 1 : 0;
  return call.result();
}

HVAS_EXPORT int virtGetEmergencyStop(void* device, int* is_closed) {
  const Call call(device);
  *is_closed = call->sample.is_stopped ? 0 : 1;
  return call.result();
}

HVAS_EXPORT int virtGetButton(void* device, int button, int* is_pressed) {
  const Call call(device);
  *is_pressed = static_cast<int>((call->sample.buttons >> button) & 1U);
  return call.result();
}

HVAS_EXPORT int virtGetAlarm(void* device, unsigned* alarms) {
  const Call call(device);
  *alarms = call->fault() == Fault::kCalibrationLost ? kAlarmPosition : 0;
  return call.result();
}

HVAS_EXPORT int virtAPIVersion(int* major, int* minor) {
  *major = 4;
  *minor = 4;
  return 0;
}

HVAS_EXPORT int virtGetDeviceID(void* device, int* type, int* serial) {
  const Call call(device);
  *type = 0;
  *serial = 90000 + call->number;
  return call.result();
}

HVAS_EXPORT int virtGetTimeLastUpdate(void* device, unsigned* ticks) {
  const Call call(device);
  *ticks = static_cast<unsigned>((call->now_ns - call->sampled_ns) / 1000);
  return call.result();
}

}  // extern "C"
}  // namespace hvas::device::virtuose
