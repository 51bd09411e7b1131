#include "app/fit/sized_fit.h"

#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::app {
namespace {

Unexpected FailNoFit(std::string_view text) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a nominal size with a fit", text), {},
              "write the nominal diameter in mm and the classes: \"40 H7/p6\", \"40 H7\", \"1.5in "
              "H7/g6\" or \"1.5in RC4\"");
}

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

void SkipBlanks(std::string_view* text) {
  while (text->starts_with(' ') || text->starts_with('\t')) {
    text->remove_prefix(1);
  }
}

bool Take(std::string_view* text, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    if (text->starts_with(word)) {
      text->remove_prefix(word.size());
      return true;
    }
  }
  return false;
}

/** Digits with a point or a comma; never an exponent, for the E of "40E8" is a class. */
std::optional<double> TakeNumber(std::string_view* text) {
  double value = 0;
  double place = 0;
  std::size_t at = 0;
  bool has_digit = false;
  for (; at < text->size(); ++at) {
    const char c = (*text)[at];
    if (IsDigit(c)) {
      has_digit = true;
      value = 10 * value + (c - '0');
      place *= 10;
    } else if ((c == '.' || c == ',') && place == 0) {
      place = 1;
    } else {
      break;
    }
  }
  if (!has_digit) {
    return std::nullopt;
  }
  text->remove_prefix(at);
  return value / (place > 0 ? place : 1);
}

/** "/8", after a number. */
double TakeDenominator(std::string_view* text) {
  std::string_view rest = *text;
  if (!Take(&rest, {"/"}) || rest.empty() || !IsDigit(rest.front())) {
    return 1;
  }
  const std::optional<double> denominator = TakeNumber(&rest);
  if (!denominator || !(*denominator > 0)) {
    return 1;
  }
  *text = rest;
  return *denominator;
}

}  // namespace

std::string SizedFit::ClassText() const {
  if (ansi) {
    return ansi->name;
  }
  if (hole && shaft) {
    return fits::FitClass{*hole, *shaft}.ToString();
  }
  return hole ? hole->ToString() : shaft ? shaft->ToString() : "";
}

std::optional<double> TakeLength(std::string_view* text, LengthUnit* unit) {
  std::string_view rest = *text;
  SkipBlanks(&rest);
  // Both signs of diameter, and the letters that stand in for them.
  Take(&rest, {"\xE2\x8C\x80", "\xC3\x98", "\xC3\xB8", "\xCE\xA6", "\xCF\x86"});
  SkipBlanks(&rest);
  const std::optional<double> number = TakeNumber(&rest);
  if (!number) {
    return std::nullopt;
  }
  double value = *number / TakeDenominator(&rest);
  // "1 1/2": a whole number and a fraction.
  std::string_view further = rest;
  SkipBlanks(&further);
  if (const std::optional<double> numerator = TakeNumber(&further)) {
    const double denominator = TakeDenominator(&further);
    if (!(denominator > 1)) {
      return std::nullopt;
    }
    value += *numerator / denominator;
    rest = further;
  }
  SkipBlanks(&rest);
  const bool is_inch = Take(&rest, {"inch", "in", "\"", "\xE2\x80\xB3"});
  if (!is_inch) {
    Take(&rest, {"mm"});
  }
  SkipBlanks(&rest);
  *text = rest;
  if (unit != nullptr) {
    *unit = is_inch ? LengthUnit::kInch : LengthUnit::kMillimetre;
  }
  return is_inch ? value * units::kMetresPerInch : units::FromMm(value);
}

std::vector<std::string> JoinFitWords(const std::vector<std::string>& words) {
  const auto begins_with_length = [](std::string_view text) {
    return TakeLength(&text).has_value();
  };
  const auto has_class = [](std::string_view text) { return TakeLength(&text) && !text.empty(); };
  std::vector<std::string> fits;
  for (const std::string& word : words) {
    const bool is_next =
        fits.empty() || (begins_with_length(word) && has_class(fits.back())) || has_class(word);
    if (is_next) {
      fits.push_back(word);
    } else {
      fits.back() += " " + word;
    }
  }
  return fits;
}

Result<SizedFit> ParseSizedFit(std::string_view text) {
  std::string_view rest = text;
  SizedFit sized;
  const std::optional<double> nominal = TakeLength(&rest, &sized.unit);
  while (rest.ends_with(' ')) {
    rest.remove_suffix(1);
  }
  if (!nominal || !std::isfinite(*nominal) || rest.empty()) {
    return FailNoFit(text);
  }
  sized.nominal = *nominal;
  if (fits::IsAnsiFit(rest)) {
    Result<fits::AnsiFit> fit = fits::FindAnsiFit(rest, *nominal);
    if (!fit) {
      return Unexpected(fit.error());
    }
    sized.ansi = *std::move(fit);
    return sized;
  }
  if (rest.find_first_of("/- ") != std::string_view::npos) {
    const Result<fits::FitClass> fit = fits::ParseFit(rest);
    if (!fit) {
      return Unexpected(fit.error());
    }
    sized.hole = fit->hole;
    sized.shaft = fit->shaft;
    return sized;
  }
  const Result<fits::ToleranceClass> one = fits::ParseToleranceClass(rest);
  if (!one) {
    return Unexpected(one.error());
  }
  (one->is_hole() ? sized.hole : sized.shaft) = *one;
  return sized;
}

}  // namespace hvas::app
