#pragma once

#include <string>

#include "base/result.h"

namespace hvas::cad {

/** Units of length that a file may have [m]: from an angstrom to ten kilometres. Beyond them the
 numbers lose what tolerances compare. A choice. */
inline constexpr double kSmallestLengthUnit = 1e-10;
inline constexpr double kLargestLengthUnit = 1e4;

/** Whether coordinates can be in this unit [m]. */
[[nodiscard]] bool IsUsableLengthUnit(double metres);

/** Checks the unit of length that a file states. Errors: kUnreadable. @param metres  Not finite: it
 is not known. @param file  Its name. @param where  What states it: "entity #28". */
[[nodiscard]] Result<void> CheckLengthUnit(double metres, const std::string& file,
                                           const std::string& where);

}  // namespace hvas::cad
