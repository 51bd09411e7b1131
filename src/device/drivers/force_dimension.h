#pragma once

#include <cstdint>
#include <string>

#include "device/drivers/dynamic_library.h"
#include "device/drivers/vendor_device.h"

/** What HVAS uses of Force Dimension's SDK, libdrd.so (it has the dhd functions too), as its
 headers tell (names, types, values). m, rad, N, N m; rates kHz. Sources:
 docs/devices/force_dimension.md. */
namespace hvas::device::force_dimension {

// NOLINTBEGIN(readability-identifier-naming,bugprone-macro-parentheses): the vendor's names.
extern "C" {
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision);
int dhdGetDeviceCount();
int dhdErrorGetLast();
int drdOpenID(char id);
int drdClose(char id);
bool drdIsInitialized(char id);
int drdAutoInit(char id);
int drdStop(bool keeps_force, char id);
int dhdGetSystemType(char id);
const char* dhdGetSystemName(char id);
int dhdGetSerialNumber(unsigned short* number, char id);
bool dhdHasWrist(char id);
bool dhdHasActiveWrist(char id);
bool dhdHasGripper(char id);
double dhdGetMaxForce(char id);
double dhdGetMaxTorque(char id);
int dhdSetMaxForce(double force, char id);
int dhdSetMaxTorque(double torque, char id);
int dhdSetGravityCompensation(int is_on, char id);
int dhdEnableExpertMode();
int dhdDisableExpertMode();
int dhdSetWatchdog(unsigned char periods, char id);
int dhdEnableForce(unsigned char is_on, char id);
int dhdGetStatus(int status[17], char id);
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rows[3][3], char id);
int dhdGetLinearVelocity(double* x, double* y, double* z, char id);
int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id);
unsigned dhdGetButtonMask(char id);
int dhdGetGripperGap(double* gap, char id);
double dhdGetComFreq(char id);
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double grip, char id);
}

#define HVAS_DHD_FUNCTIONS(X)          \
  X(dhdGetSDKVersion)                  \
  X(dhdGetDeviceCount)                 \
  X(dhdErrorGetLast)                   \
  X(drdOpenID)                         \
  X(drdClose)                          \
  X(drdIsInitialized)                  \
  X(drdAutoInit)                       \
  X(drdStop)                           \
  X(dhdGetSystemType)                  \
  X(dhdGetSystemName)                  \
  X(dhdHasWrist)                       \
  X(dhdHasActiveWrist)                 \
  X(dhdEnableForce)                    \
  X(dhdGetStatus)                      \
  X(dhdGetPositionAndOrientationFrame) \
  X(dhdGetLinearVelocity)              \
  X(dhdGetAngularVelocityRad)          \
  X(dhdGetButtonMask)                  \
  X(dhdSetForceAndTorqueAndGripperForce)

/** Not in every version of the SDK; the driver does without. */
#define HVAS_DHD_OPTIONAL_FUNCTIONS(X) \
  X(dhdGetSerialNumber)                \
  X(dhdHasGripper)                     \
  X(dhdGetMaxForce)                    \
  X(dhdGetMaxTorque)                   \
  X(dhdSetMaxForce)                    \
  X(dhdSetMaxTorque)                   \
  X(dhdSetGravityCompensation)         \
  X(dhdEnableExpertMode)               \
  X(dhdDisableExpertMode)              \
  X(dhdSetWatchdog)                    \
  X(dhdGetGripperGap)                  \
  X(dhdGetComFreq)

/** The functions of one loaded library. */
struct Functions {
#define HVAS_MEMBER(name) decltype(&force_dimension::name) name{};
  HVAS_DHD_FUNCTIONS(HVAS_MEMBER)
  HVAS_DHD_OPTIONAL_FUNCTIONS(HVAS_MEMBER)
#undef HVAS_MEMBER
};

void BindAll(SymbolBinder* binder, Functions* functions);

// NOLINTEND(readability-identifier-naming,bugprone-macro-parentheses)

// What a call returns besides 0 and below 0 for an error.
inline constexpr int kTimeGuard = 1;  ///< The sample is the last one again: no error.

// Errors.
inline constexpr int kErrorCom = 2;
inline constexpr int kErrorNoDriver = 4;
inline constexpr int kErrorNoDevice = 5;
inline constexpr int kErrorNotAvailable = 6;
inline constexpr int kErrorTimeout = 7;
inline constexpr int kErrorNotReady = 12;
inline constexpr int kErrorInUse = 20;

// Places in the status.
inline constexpr int kStatusReset = 3;  ///< Calibrated.
inline constexpr int kStatusForce = 5;
inline constexpr int kStatusError = 9;
inline constexpr int kStatusForceOffCause = 14;
inline constexpr int kStatusCount = 17;

// Causes of the force being off.
inline constexpr int kOffByButton = 1;
inline constexpr int kOffByVelocity = 2;
inline constexpr int kOffByWatchdog = 3;
inline constexpr int kOffBySoftware = 4;
inline constexpr int kOffByDisconnection = 5;
inline constexpr int kOffByDeadMan = 6;

/** The watchdog counts periods of 125 us. */
inline constexpr std::int64_t kWatchdogPeriodNs = 125'000;

/** Gap of a gripper that is fully open [m]; assumed. */
inline constexpr double kOpenGap = 0.025;

[[nodiscard]] VendorVerdict Judge(int error) noexcept;
/** What an error, or a cause of the force being off (given as its negative), means in words. */
[[nodiscard]] std::string Explain(int code);

/** "omega.7" of a system's type; empty for one that is not known. */
[[nodiscard]] std::string ModelOfType(int type);

/** A pose from a position [m] and a matrix by rows. RT-safe. */
[[nodiscard]] spatial::Pose ToPose(const Vec3& p, const double rows[3][3]) noexcept;

}  // namespace hvas::device::force_dimension
