#include "cad/length_unit.h"

#include <cmath>

#include <fmt/format.h>

namespace hvas::cad {

bool IsUsableLengthUnit(double metres) {
  return metres >= kSmallestLengthUnit && metres <= kLargestLengthUnit;  // False for NaN.
}

Result<void> CheckLengthUnit(double metres, const std::string& file, const std::string& where) {
  if (IsUsableLengthUnit(metres)) {
    return {};
  }
  const std::string what =
      std::isfinite(metres)
          ? fmt::format("a unit of length of {:g} m, which is not between {:g} and {:g} m", metres,
                        kSmallestLengthUnit, kLargestLengthUnit)
          : std::string("a unit of length that is not defined");
  return Fail(ErrorCode::kUnreadable, fmt::format("{} has {}", where, what), file,
              "export the file again in millimetres");
}

}  // namespace hvas::cad
