#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "device/drivers/vendor_device.h"

/** What HVAS uses of OpenHaptics' HDAPI, libHD.so, as its reference manual and header tell (names,
 types, values). Lengths are mm, forces N, stiffness N/mm. Sources: docs/devices/openhaptics.md. */
namespace hvas::device::openhaptics {

// NOLINTBEGIN(readability-identifier-naming,bugprone-macro-parentheses): the vendor's names.
using HHD = std::uint32_t;
using HDenum = std::uint32_t;
using HDSchedulerHandle = unsigned long;
using HDCallback = std::uint32_t (*)(void*);

struct HDErrorInfo {
  std::uint32_t errorCode;
  int internalErrorCode;
  HHD hHD;
};

extern "C" {
HHD hdInitDevice(const char* name);
void hdDisableDevice(HHD device);
void hdMakeCurrentDevice(HHD device);
void hdBeginFrame(HHD device);
void hdEndFrame(HHD device);
HDErrorInfo hdGetError();
void hdEnable(HDenum capability);
void hdDisable(HDenum capability);
void hdGetBooleanv(HDenum what, unsigned char* value);
void hdGetIntegerv(HDenum what, int* value);
void hdGetDoublev(HDenum what, double* value);
const char* hdGetString(HDenum what);
void hdSetDoublev(HDenum what, const double* value);
HDenum hdCheckCalibration();
HDenum hdCheckCalibrationStyle();
void hdUpdateCalibration(HDenum style);
void hdStartScheduler();
void hdStopScheduler();
HDSchedulerHandle hdScheduleAsynchronous(HDCallback callback, void* data, unsigned short priority);
void hdScheduleSynchronous(HDCallback callback, void* data, unsigned short priority);
void hdUnschedule(HDSchedulerHandle handle);
}

#define HVAS_HD_FUNCTIONS(X) \
  X(hdInitDevice)            \
  X(hdDisableDevice)         \
  X(hdMakeCurrentDevice)     \
  X(hdBeginFrame)            \
  X(hdEndFrame)              \
  X(hdGetError)              \
  X(hdEnable)                \
  X(hdDisable)               \
  X(hdGetBooleanv)           \
  X(hdGetIntegerv)           \
  X(hdGetDoublev)            \
  X(hdGetString)             \
  X(hdSetDoublev)            \
  X(hdCheckCalibration)      \
  X(hdCheckCalibrationStyle) \
  X(hdUpdateCalibration)     \
  X(hdStartScheduler)        \
  X(hdStopScheduler)         \
  X(hdScheduleAsynchronous)  \
  X(hdScheduleSynchronous)   \
  X(hdUnschedule)

/** The functions of one loaded library. */
struct Functions {
#define HVAS_MEMBER(name) decltype(&openhaptics::name) name{};
  HVAS_HD_FUNCTIONS(HVAS_MEMBER)
#undef HVAS_MEMBER
};

// NOLINTEND(readability-identifier-naming,bugprone-macro-parentheses)

inline constexpr HHD kNoDevice = 0xFFFFFFFF;
// The vendor's hd.h has these numbers.
inline constexpr std::uint32_t kDone = 0;
inline constexpr std::uint32_t kContinue = 1;
inline constexpr unsigned short kHighestPriority = 65535;

// What can be asked for.
inline constexpr HDenum kButtons = 0x2000;
inline constexpr HDenum kSafetySwitch = 0x2001;
inline constexpr HDenum kPosition = 0x2050;
inline constexpr HDenum kVelocity = 0x2051;
inline constexpr HDenum kTransform = 0x2052;
inline constexpr HDenum kAngularVelocity = 0x2053;
inline constexpr HDenum kModel = 0x2501;
inline constexpr HDenum kDriverVersion = 0x2502;
inline constexpr HDenum kSerialNumber = 0x2504;
inline constexpr HDenum kUsableWorkspace = 0x2551;
inline constexpr HDenum kOutputDof = 0x2554;
inline constexpr HDenum kUpdateRate = 0x2600;
inline constexpr HDenum kInstantaneousRate = 0x2601;
inline constexpr HDenum kMaxStiffness = 0x2602;
inline constexpr HDenum kMaxForce = 0x2603;
inline constexpr HDenum kMaxContinuousForce = 0x2604;
inline constexpr HDenum kForce = 0x2700;

// What can be switched.
inline constexpr HDenum kForceOutput = 0x4000;
inline constexpr HDenum kForceClamping = 0x4001;
inline constexpr HDenum kForceRamping = 0x4002;

inline constexpr HDenum kCalibrationOk = 0x5000;
inline constexpr HDenum kCalibrationNeedsUpdate = 0x5001;
inline constexpr HDenum kCalibrationNeedsManual = 0x5002;
inline constexpr HDenum kCalibrationStyleInkwell = 4;

// Errors.
inline constexpr std::uint32_t kWarmMotors = 0x0200;
inline constexpr std::uint32_t kExceededForce = 0x0201;
inline constexpr std::uint32_t kForceError = 0x0204;
inline constexpr std::uint32_t kDeviceFault = 0x0300;
inline constexpr std::uint32_t kAlreadyInitiated = 0x0301;
inline constexpr std::uint32_t kCommError = 0x0302;
inline constexpr std::uint32_t kTimerError = 0x0304;
inline constexpr std::uint32_t kIllegalBegin = 0x0400;
inline constexpr std::uint32_t kIllegalEnd = 0x0401;
inline constexpr std::uint32_t kFrameError = 0x0402;
inline constexpr std::uint32_t kInvalidLicense = 0x0600;

[[nodiscard]] VendorVerdict Judge(std::uint32_t error) noexcept;
/** What an error means, in words; empty for one that is not known. */
[[nodiscard]] std::string Explain(std::uint32_t error);

/** A pose from the vendor's matrix: 16 numbers by columns, lengths in mm. RT-safe. */
[[nodiscard]] spatial::Pose ToPose(const std::array<double, 16>& columns_mm) noexcept;

}  // namespace hvas::device::openhaptics
