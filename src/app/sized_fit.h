#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "fits/iso286.h"

namespace hvas::app {

/** "40 H7/p6", "1.5in H7/g6", or one class alone, "40 H7". */
struct SizedFit {
  double nominal{0};  ///< [m]
  std::optional<fits::ToleranceClass> hole;
  std::optional<fits::ToleranceClass> shaft;

  /** "H7/p6", "H7" or "g6". */
  [[nodiscard]] std::string ClassText() const;
};

/** The length at the beginning of a text, and what is left of that. Millimetres without a unit;
 "mm", "in", "inch" or a double quote; a decimal comma; fractions of inches ("1 1/2 in", "3/8 in");
 a diameter sign in front. No length: nothing. */
[[nodiscard]] std::optional<double> TakeLength(std::string_view* text);

/** Errors: kInvalid, with what a fit looks like. */
[[nodiscard]] Result<SizedFit> ParseSizedFit(std::string_view text);

}  // namespace hvas::app
