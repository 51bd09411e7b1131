#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

/** Predetermined times: what a sequence of coded motions takes. MODAPTS (Heyde, 1966) counts in MOD
 of 0.129 s; BasicMOST in TMU of 0.036 s, ten for each unit of the sum of its indices. The codes are
 those of two public programs; cards of MTM are their owners' and are not among them, but a card of
 the user's own can be read. */
namespace hvas::shopfloor {

inline constexpr double kTmuSeconds = 0.036;  ///< One TMU, 1e-5 h [s].

/** Seconds of each code of a system of times. */
struct TimeCard {
  std::string name;                       ///< "MODAPTS", or that of the user's file.
  std::map<std::string, double> seconds;  ///< Seconds of one motion, by code.
};

/** The codes of MODAPTS. */
[[nodiscard]] const TimeCard& ModaptsCard();

/** A code as it stands in a sequence, and how often. */
struct CodedMotion {
  std::string code;
  int count{1};
  double seconds{0};  ///< Time of all of them [s].
};

/** Reads a sequence, "M3 E2 G3 M3 E2 P5", "M4G1" or "5 C3 + A4": codes, each with an optional
 number of times before it. Errors: kInvalid for what is no code of the card, with its place. */
[[nodiscard]] Result<std::vector<CodedMotion>> ParseMotions(std::string_view sequence,
                                                            const TimeCard& card);

/** The sum over a sequence [s]. */
[[nodiscard]] double SumSeconds(const std::vector<CodedMotion>& motions);

/** Calculates the time of a sequence of BasicMOST, "A1 B0 G3 A1 B0 P6 A0" [s]: ten TMU for each
 unit of the sum of its indices. Errors: kInvalid for what is not a capital letter with an index. */
[[nodiscard]] Result<double> CalcMostSeconds(std::string_view sequence);

}  // namespace hvas::shopfloor
