#pragma once

#include <string>

namespace hvas::app {

enum class LengthUnit { kMillimetre, kInch };

/** Lengths in the unit that somebody thinks in: sizes in millimetres or inches, deviations in
 micrometres or thousandths of an inch. Zero has no sign. */
class LengthText {
 public:
  explicit LengthText(LengthUnit unit) : is_inch_(unit == LengthUnit::kInch) {}

  /** "40 mm", "1.5 in". */
  [[nodiscard]] std::string Size(double length) const;
  /** The number alone, to 0.1 um. */
  [[nodiscard]] std::string Exact(double length) const;
  /** "12.5", of um or thou. */
  [[nodiscard]] std::string Small(double length) const;
  /** Text with a plus sign where the length is positive. */
  [[nodiscard]] std::string SignedSmall(double length) const;

  [[nodiscard]] const char* size_unit() const { return is_inch_ ? "in" : "mm"; }

  [[nodiscard]] const char* small_unit() const { return is_inch_ ? "thou" : "um"; }

  /** How many units a metre is. */
  [[nodiscard]] double sizes_per_metre() const;
  [[nodiscard]] double smalls_per_metre() const;

 private:
  bool is_inch_;
};

}  // namespace hvas::app
