#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/output/length_text.h"
#include "base/result.h"
#include "fits/ansi_b41.h"
#include "fits/iso286.h"

namespace hvas::app {

/** "40 H7/p6", "1.5in H7/g6", "1.5in RC4", or one class alone, "40 H7". */
struct SizedFit {
  double nominal{0};  ///< [m]
  std::optional<fits::ToleranceClass> hole;
  std::optional<fits::ToleranceClass> shaft;
  std::optional<fits::AnsiFit> ansi;         ///< Stands in place of the classes.
  LengthUnit unit{LengthUnit::kMillimetre};  ///< That the diameter is stated in.

  /** "H7/p6", "H7", "g6" or "RC4". */
  [[nodiscard]] std::string ClassText() const;
};

/** The length at the beginning of a text, and what is left of that. Millimetres without a unit;
 "mm", "in", "inch" or a double quote; a decimal comma; fractions of inches ("1 1/2 in", "3/8 in");
 a diameter sign in front. No length: nothing.
 @param unit  Gets the unit that is stated. */
[[nodiscard]] std::optional<double> TakeLength(std::string_view* text, LengthUnit* unit = nullptr);

/** Words of a command line as fits: "40", "H7/p6" is one, "40 H7/p6", "35 H7/k6" are two, and
 "40", "H7", "p6", "1", "1/2", "in", "H7/g6" are two as well. A length begins a fit where the one
 before has a class. */
[[nodiscard]] std::vector<std::string> JoinFitWords(const std::vector<std::string>& words);

/** Errors: kInvalid, with what a fit looks like. */
[[nodiscard]] Result<SizedFit> ParseSizedFit(std::string_view text);

}  // namespace hvas::app
