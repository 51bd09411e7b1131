#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spatial/pose.h"

/** Times of a hand at work by MODAPTS (Heyde, 1966): an estimate to compare orders by, in whole
 MOD. The elements: M moves the hand, G gets, P puts, E looks before what needs care, J takes a part
 anew in the hand, A presses, C cranks. Their figures are those of two public programs, which agree
 but for M7, L, C3 and A4: one of the two has these. */
namespace hvas::orders {

inline constexpr double kModSeconds = 0.129;  ///< One MOD [s].

inline constexpr int kTurnMods = 17;       ///< Turns the product over: M4 E2 G3, M4 E2 P2.
inline constexpr int kOtherWayMods = 5;    ///< The hand goes to another side: M3 J2.
inline constexpr int kToolGetMods = 5;     ///< Gets a tool: M4 G1.
inline constexpr int kToolChangeMods = 9;  ///< Lays one aside before that: M4 P0, M4 G1.
inline constexpr int kToolOnMods = 7;      ///< Puts the tool onto a fastener: M3 E2 P2.
inline constexpr int kHoldMods = 4;        ///< The other hand takes hold of a part: M3 G1.
inline constexpr int kPressMods = 4;       ///< Presses a fit together: A4.
inline constexpr int kCrankMods = 3;       ///< One turn of a thread: C3.

/** What a motion of the hand is for. */
enum class MotionPurpose : std::uint8_t {
  kTurnProduct,  ///< The product is turned over, because a part would come in from below.
  kOtherWay,     ///< The hand goes to another side.
  kGetTool,      ///< A tool is fetched.
  kChangeTool,   ///< One is laid aside, and another one fetched.
  kGoTo,         ///< The hand goes to the part; amount: distance [m].
  kGet,          ///< It gets the part; amount: largest extent [m].
  kBring,        ///< It brings the part to its place; amount: distance [m].
  kPut,          ///< It puts the part there.
  kLoad,         ///< The part is heavy; amount: mass [kg].
  kReachIn,      ///< The hand reaches in among parts, and out again; amount: reach [m].
  kToolOn,       ///< A tool is put onto a fastener.
  kCrank,        ///< A thread is turned in; amount: turns.
  kPress,        ///< A fit is pressed together; amount: force [N].
  kHold,         ///< The other hand takes hold of a part.
};

/** A motion of the hand, with its elements of MODAPTS: "E2 G3". */
struct HandMotion {
  MotionPurpose purpose{MotionPurpose::kGoTo};
  std::string code;
  int mods{0};
  double amount{0};  ///< Its unit stands at the purpose; else 0.
};

/** The sum of their MOD. */
[[nodiscard]] int SumMods(const std::vector<HandMotion>& motions);

/** How a part is put into its place. */
enum class PutCare {
  kNone,   ///< It only lies there: P0.
  kSome,   ///< It has faces, threads or wide holes to go to: E2 P2.
  kExact,  ///< It has a fit to enter: E2 P5.
};

/** MOD of a move of the hand: of M1 (25 mm), M2 (50), M3 (150), M4 (300), M5 (450) and M7 (750) the
 one whose distance is nearest; none below half of M1, M7 from there on.
 @param distance  [m] */
[[nodiscard]] int CalcMoveMods(double distance);

/** MOD to get a part: E2 G3 where it is small or thin, else G1.
 @param size  Extents of its box [m]. */
[[nodiscard]] int CalcGetMods(const Vec3& size);

/** MOD to put a part. */
[[nodiscard]] int CalcPutMods(PutCare care);

/** MOD for what a part weighs: L1 from 2 kg on, and one more for each 4 kg above 6 kg.
 @param mass  [kg] */
[[nodiscard]] int CalcLoadMods(double mass);

/** MOD to reach in among parts, and out again.
 @param reach  [m] */
[[nodiscard]] inline int CalcReachMods(double reach) {
  return 2 * CalcMoveMods(reach);
}

}  // namespace hvas::orders
