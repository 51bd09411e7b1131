#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "device/drivers/dynamic_library.h"
#include "device/drivers/vendor_device.h"

/** What HVAS uses of Haption's VirtuoseAPI 4, virtuoseAPI.so, as its header tells (names, types,
 values). m, rad, N, N m, s; poses x, y, z, qx, qy, qz, qw; speeds and forces linear first. Sources:
 docs/devices/virtuose.md. */
namespace hvas::device::virtuose {

// NOLINTBEGIN(readability-identifier-naming,bugprone-macro-parentheses): the vendor's names.
extern "C" {
void* virtOpen(const char* address);
int virtClose(void* device);
int virtGetErrorCode(void* device);
char* virtGetErrorMessage(int code);
int virtSetIndexingMode(void* device, int mode);
int virtSetForceFactor(void* device, float factor);
int virtSetSpeedFactor(void* device, float factor);
int virtSetTimeStep(void* device, float step);
int virtSetBaseFrame(void* device, float* pose);
int virtSetObservationFrame(void* device, float* pose);
int virtSetCommandType(void* device, int type);
int virtSetPowerOn(void* device, int is_on);
int virtGetPowerOn(void* device, int* is_on);
int virtGetPosition(void* device, float* pose);
int virtGetSpeed(void* device, float* speed);
int virtSetForce(void* device, float* force);
int virtGetDeadMan(void* device, int* is_held);
int virtGetEmergencyStop(void* device, int* is_closed);
int virtGetButton(void* device, int button, int* is_pressed);
int virtGetAlarm(void* device, unsigned* alarms);
int virtSaturateTorque(void* device, float force, float torque);
int virtSetTimeoutValue(void* device, float timeout);
int virtAPIVersion(int* major, int* minor);
int virtGetDeviceID(void* device, int* type, int* serial);
int virtGetTimeLastUpdate(void* device, unsigned* ticks);
}

#define HVAS_VIRT_FUNCTIONS(X) \
  X(virtOpen)                  \
  X(virtClose)                 \
  X(virtGetErrorCode)          \
  X(virtGetErrorMessage)       \
  X(virtSetIndexingMode)       \
  X(virtSetForceFactor)        \
  X(virtSetSpeedFactor)        \
  X(virtSetTimeStep)           \
  X(virtSetBaseFrame)          \
  X(virtSetObservationFrame)   \
  X(virtSetCommandType)        \
  X(virtSetPowerOn)            \
  X(virtGetPowerOn)            \
  X(virtGetPosition)           \
  X(virtGetSpeed)              \
  X(virtSetForce)              \
  X(virtGetDeadMan)            \
  X(virtGetEmergencyStop)      \
  X(virtGetButton)             \
  X(virtGetAlarm)              \
  X(virtSaturateTorque)        \
  X(virtSetTimeoutValue)

/** Not certain to be in every version; the driver does without. */
#define HVAS_VIRT_OPTIONAL_FUNCTIONS(X) \
  X(virtAPIVersion)                     \
  X(virtGetDeviceID)                    \
  X(virtGetTimeLastUpdate)

/** The functions of one loaded library. */
struct Functions {
#define HVAS_MEMBER(name) decltype(&virtuose::name) name{};
  HVAS_VIRT_FUNCTIONS(HVAS_MEMBER)
  HVAS_VIRT_OPTIONAL_FUNCTIONS(HVAS_MEMBER)
#undef HVAS_MEMBER
};

void BindAll(SymbolBinder* binder, Functions* functions);

// NOLINTEND(readability-identifier-naming,bugprone-macro-parentheses)

// The vendor's virtuoseAPI.h has these numbers.
inline constexpr int kIndexingNone = 2;
inline constexpr int kCommandImpedance = 3;

// Errors.
inline constexpr int kErrorCommunication = 2;
inline constexpr int kErrorInvalidContext = 3;
inline constexpr int kErrorTimeout = 6;
inline constexpr int kErrorHardware = 11;
inline constexpr int kErrorDiscontinuity = 12;
inline constexpr int kErrorVersion = 16;
inline constexpr int kErrorIncompatible = 20;

// Alarms.
inline constexpr unsigned kAlarmOverheat = 0x4000;
inline constexpr unsigned kAlarmSaturated = 0x8000;
inline constexpr unsigned kAlarmPosition = 0x40000;

[[nodiscard]] VendorVerdict Judge(int error) noexcept;
[[nodiscard]] VendorVerdict JudgeAlarms(unsigned alarms) noexcept;
/** What an error, or a set of alarms (0x4000 and above), means in words. */
[[nodiscard]] std::string Explain(int code);

/** RT-safe, all three. */
[[nodiscard]] spatial::Pose ToPose(const std::array<float, 7>& pose) noexcept;
[[nodiscard]] spatial::Twist ToTwist(const std::array<float, 6>& speed) noexcept;
[[nodiscard]] std::array<float, 6> FromWrench(const spatial::Wrench& F) noexcept;

}  // namespace hvas::device::virtuose
