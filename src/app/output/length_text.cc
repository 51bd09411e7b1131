#include "app/output/length_text.h"

#include <cmath>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::app {
namespace {

constexpr double kThousandths = 1e3;  // Thousandths of an inch are the unit of ANSI B4.1.

}  // namespace

double LengthText::sizes_per_metre() const {
  return is_inch_ ? 1 / units::kMetresPerInch : units::ToMm(1);
}

double LengthText::smalls_per_metre() const {
  return is_inch_ ? kThousandths / units::kMetresPerInch : units::ToUm(1);
}

std::string LengthText::Size(double length) const {
  return fmt::format("{:g} {}", length * sizes_per_metre() + 0.0, size_unit());
}

std::string LengthText::Exact(double length) const {
  return fmt::format("{:.{}f}", length * sizes_per_metre() + 0.0, is_inch_ ? 5 : 4);
}

std::string LengthText::Small(double length) const {
  return fmt::format("{:g}", std::round(length * smalls_per_metre() * 1e3) / 1e3 + 0.0);
}

std::string LengthText::SignedSmall(double length) const {
  const std::string text = Small(length);
  return length > 0 && text != "0" ? "+" + text : text;
}

}  // namespace hvas::app
