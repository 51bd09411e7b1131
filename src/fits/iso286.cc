#include "fits/iso286.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

constexpr double kNo = std::numeric_limits<double>::infinity();

#include "fits/iso286_tables.inc"

// The grades IT01 (-1), IT0 (0) to IT18 of ISO 286-1.
constexpr int kFinestGrade = -1;
constexpr int kCoarsestGrade = 18;

/** Nanometres are far below any table's step and above the rounding of 0.03 * 1000. */
double RoundToNm(double nominal) {
  return std::round(units::ToMm(nominal) * 1e6) / 1e6;
}

/** Index of "over the one before, up to and including": 30 mm is in 18 to 30. */
template <std::size_t kCount>
std::size_t FindRange(const std::array<double, kCount>& upper_ends_mm, double size_mm) {
  return static_cast<std::size_t>(
      std::lower_bound(upper_ends_mm.begin(), upper_ends_mm.end(), size_mm) -
      upper_ends_mm.begin());
}

std::string FormatGrade(int grade) {
  return grade < 0 ? "01" : std::to_string(grade);
}

Unexpected FailNotDefined(const std::string& what, double size_mm, const std::string& rule,
                          const std::string& remedy) {
  return Fail(ErrorCode::kUnsupported,
              fmt::format("ISO 286 defines no {} at {:g} mm: {}", what, size_mm, rule), {}, remedy);
}

/** Why there is no standard tolerance of a grade at a size. */
std::string RuleOfGrade(int grade) {
  return grade <= 0 ? "IT01 and IT0 end at 500 mm"
                    : "IT14 to IT18 are not defined for sizes up to 1 mm";
}

std::optional<Error> CheckSize(double size_mm) {
  if (size_mm > 0 && size_mm <= kItRangesMm.back()) {
    return std::nullopt;
  }
  return Error{ErrorCode::kInvalid,
               fmt::format("{:g} mm is not a nominal size of ISO 286", size_mm),
               {},
               "give a diameter above 0 and up to 3150 mm"};
}

/** IT in micrometres; kNo where undefined. */
double FindIt(int grade, double size_mm) {
  if (grade < kFinestGrade || grade > kCoarsestGrade || (grade >= 14 && size_mm <= 1)) {
    return kNo;
  }
  return kItUm[static_cast<std::size_t>(grade - kFinestGrade)][FindRange(kItRangesMm, size_mm)];
}

/** A tabulated deviation in micrometres; kNo where undefined. */
template <std::size_t kCount>
double FindDeviation(const std::array<DeviationRow, kCount>& rows, std::string_view letters,
                     double size_mm) {
  for (const DeviationRow& row : rows) {
    if (row.letters == letters) {
      return row.value_um[FindRange(kDeviationRangesMm, size_mm)];
    }
  }
  return kNo;
}

template <std::size_t kCount>
bool Has(const std::array<DeviationRow, kCount>& rows, std::string_view letters) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const DeviationRow& row) { return row.letters == letters; });
}

/** The fundamental deviation: which side it is on, and its value; kNo where undefined. */
struct Fundamental {
  bool is_upper{false};
  double value_um{kNo};
};

Fundamental FindShaft(const std::string& letters, int grade, double size_mm) {
  if (Has(kUpperDeviations, letters)) {
    const bool excluded = (letters == "a" || letters == "b") && size_mm <= 1;
    return {true, excluded ? kNo : FindDeviation(kUpperDeviations, letters, size_mm)};
  }
  if (letters == "j") {
    return {false, FindDeviation(kShaftJ, "j" + std::to_string(grade), size_mm)};
  }
  if (letters == "k" && (grade < 4 || grade > 7)) {
    return {false, 0};
  }
  return {false, FindDeviation(kLowerDeviations, letters, size_mm)};
}

/** ES of the holes K to ZC in micrometres: the shaft's ei turned round, with what the standard
 * adds. */
double FindUpperOfHole(const std::string& shaft_letters, int grade, double size_mm) {
  const bool is_kmn = shaft_letters == "k" || shaft_letters == "m" || shaft_letters == "n";
  const bool has_delta_size = size_mm > 3 && size_mm <= 500;
  if (shaft_letters == "k" && grade > 8) {
    return size_mm <= 3 ? 0 : kNo;
  }
  if (shaft_letters == "n" && grade > 8) {
    if (size_mm <= 1) {
      return kNo;
    }
    if (has_delta_size) {
      return 0;
    }
  }
  if (shaft_letters == "m" && grade == 6 && size_mm > 250 && size_mm <= 315) {
    return -9;  // The standard's one exception; the rule would give -11.
  }
  const double ei_um = FindDeviation(kLowerDeviations, shaft_letters, size_mm);
  if (ei_um == kNo) {
    return kNo;
  }
  if (!has_delta_size || grade > (is_kmn ? 8 : 7)) {
    return -ei_um;
  }
  if (grade < 3) {
    return kNo;  // Delta is tabulated from IT3.
  }
  return -ei_um + FindIt(grade, size_mm) - FindIt(grade - 1, size_mm);
}

Fundamental FindHole(const std::string& letters, int grade, double size_mm) {
  if (letters == "J") {
    return {true, FindDeviation(kHoleJ, "J" + std::to_string(grade), size_mm)};
  }
  std::string small = letters;
  for (char& c : small) {
    c = static_cast<char>(c - 'A' + 'a');
  }
  if (Has(kUpperDeviations, small)) {
    const Fundamental shaft = FindShaft(small, grade, size_mm);
    return {false, shaft.value_um == kNo ? kNo : -shaft.value_um};
  }
  return {true, FindUpperOfHole(small, grade, size_mm)};
}

/** Why there is no class at a size at which its grade has a tolerance. */
std::string RuleOfClass(const ToleranceClass& c, double size_mm) {
  std::string small = c.letters;
  for (char& letter : small) {
    letter = c.is_hole() ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  if (small == "js") {
    return "js and JS are defined for IT1 to IT18";
  }
  if (small == "j") {
    return c.is_hole() ? "J is defined as J6, J7 and J8 up to 500 mm"
                       : "j is defined as j5, j6 and j7 up to 500 mm, and as j8 up to 3 mm";
  }
  const auto begins = [&](const char* letters, double from_mm) {
    return small == letters && size_mm <= from_mm;
  };
  if (begins("a", 1) || begins("b", 1)) {
    return "a, b, A and B are not defined for sizes up to 1 mm";
  }
  if (size_mm > 500 && FindDeviation(kUpperDeviations, small, size_mm) == kNo &&
      FindDeviation(kLowerDeviations, small, size_mm) == kNo) {
    return "above 500 mm there are only d to h, js, k, m, n, p, r, s, t, u and their holes";
  }
  if (small == "cd" || small == "ef" || small == "fg") {
    return "cd, ef, fg and their holes end at 50 mm";
  }
  if (begins("t", 24) || begins("v", 14) || begins("y", 18)) {
    return "t begins above 24 mm, v above 14 mm and y above 18 mm, and so do their holes";
  }
  if (c.is_hole() && small == "k" && c.grade > 8) {
    return "K above IT8 is defined for sizes up to 3 mm only";
  }
  if (c.is_hole() && small == "n" && c.grade > 8) {
    return "N9 and coarser are not defined for sizes up to 1 mm";
  }
  return "delta, which holes K to ZC need between 3 and 500 mm, begins with IT3";
}

bool IsLetter(const std::string& letters) {
  std::string small = letters;
  const bool is_capital = letters.front() >= 'A' && letters.front() <= 'Z';
  for (char& c : small) {
    if ((c >= 'A' && c <= 'Z') != is_capital) {
      return false;
    }
    c = is_capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return small == "j" || small == "js" || Has(kUpperDeviations, small) ||
         Has(kLowerDeviations, small);
}

Unexpected FailWithoutClass(std::string_view text) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a tolerance class", text), {},
              "write letters and grade, for example H7 or js6");
}

bool IsAsciiLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') {
    text.remove_prefix(1);
  }
  while (!text.empty() && text.back() == ' ') {
    text.remove_suffix(1);
  }
  return text;
}

constexpr int kCoarsestPressed = 11;  // ISO 286-2 has classes of zc up to this grade.

/** Upper limit of a shaft; 0 where the standard has no such class [m]. */
double CalcUpperOf(const char* letters, int grade, double nominal) {
  const Result<Limits> limits = CalcLimits({letters, grade}, nominal);
  return limits ? limits->upper : 0.0;
}

}  // namespace

std::string ToleranceClass::ToString() const {
  return letters + FormatGrade(grade);
}

std::string FitClass::ToString() const {
  return hole.ToString() + "/" + shaft.ToString();
}

Result<ToleranceClass> ParseToleranceClass(std::string_view text) {
  text = Trim(text);
  std::size_t split = 0;
  while (split < text.size() && IsAsciiLetter(text[split])) {
    ++split;
  }
  ToleranceClass parsed;
  parsed.letters = std::string(text.substr(0, split));
  const std::string_view digits = text.substr(split);
  if (parsed.letters.empty() || digits.empty() || digits.size() > 2 ||
      !std::all_of(digits.begin(), digits.end(), IsDigit) || !IsLetter(parsed.letters)) {
    return FailWithoutClass(text);
  }
  if (digits == "01") {
    parsed.grade = kFinestGrade;
    return parsed;
  }
  parsed.grade = std::stoi(std::string(digits));
  if (parsed.grade > kCoarsestGrade || (digits.size() == 2 && digits.front() == '0')) {
    return FailWithoutClass(text);
  }
  return parsed;
}

Result<FitClass> ParseFit(std::string_view text) {
  const std::string_view trimmed = Trim(text);
  const std::size_t split = trimmed.find_first_of("/- ");
  if (split == std::string_view::npos) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a fit", text), {},
                "write hole and shaft, for example H7/g6");
  }
  const std::size_t second = trimmed.find_first_not_of("/- ", split);
  const Result<ToleranceClass> hole = ParseToleranceClass(trimmed.substr(0, split));
  if (!hole) {
    return Unexpected(hole.error());
  }
  const Result<ToleranceClass> shaft = ParseToleranceClass(
      second == std::string_view::npos ? std::string_view{} : trimmed.substr(second));
  if (!shaft) {
    return Unexpected(shaft.error());
  }
  if (!hole->is_hole() || shaft->is_hole()) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a hole with a shaft", text), {},
                "the class of the hole has capital letters and comes first: H7/g6");
  }
  return FitClass{*hole, *shaft};
}

Result<double> CalcStandardTolerance(int grade, double nominal) {
  const double size_mm = RoundToNm(nominal);
  if (auto error = CheckSize(size_mm)) {
    return Unexpected(*std::move(error));
  }
  const double it_um = FindIt(grade, size_mm);
  if (it_um == kNo) {
    return FailNotDefined("IT" + FormatGrade(grade), size_mm, RuleOfGrade(grade),
                          "choose another grade");
  }
  return units::FromUm(it_um);
}

Result<Limits> CalcLimits(const ToleranceClass& tolerance_class, double nominal) {
  const double size_mm = RoundToNm(nominal);
  const Result<double> tolerance = CalcStandardTolerance(tolerance_class.grade, nominal);
  if (!tolerance) {
    return Unexpected(tolerance.error());
  }
  const std::string& letters = tolerance_class.letters;
  if ((letters == "js" || letters == "JS") && tolerance_class.grade >= 1) {
    return Limits{-0.5 * *tolerance, 0.5 * *tolerance};
  }
  const Fundamental deviation = tolerance_class.is_hole()
                                    ? FindHole(letters, tolerance_class.grade, size_mm)
                                    : FindShaft(letters, tolerance_class.grade, size_mm);
  if (deviation.value_um == kNo) {
    return FailNotDefined("class " + tolerance_class.ToString(), size_mm,
                          RuleOfClass(tolerance_class, size_mm), "choose another class");
  }
  // In micrometres until the end, so that limits are what a table prints.
  const double it_um = FindIt(tolerance_class.grade, size_mm);
  const double lower_um = deviation.is_upper ? deviation.value_um - it_um : deviation.value_um;
  return Limits{units::FromUm(lower_um), units::FromUm(lower_um + it_um)};
}

FitKind ClassifyFit(double min_clearance, double max_clearance) {
  constexpr double kZero = 1e-12;  // Deviations are multiples of 0.05 um, up to rounding [m].
  if (min_clearance >= -kZero) {
    return FitKind::kClearance;
  }
  return max_clearance <= kZero ? FitKind::kInterference : FitKind::kTransition;
}

Result<FitLimits> CalcFitLimits(const FitClass& fit, double nominal) {
  const Result<Limits> hole = CalcLimits(fit.hole, nominal);
  if (!hole) {
    return Unexpected(hole.error());
  }
  const Result<Limits> shaft = CalcLimits(fit.shaft, nominal);
  if (!shaft) {
    return Unexpected(shaft.error());
  }
  FitLimits limits{*hole, *shaft, hole->lower - shaft->upper, hole->upper - shaft->lower};
  limits.kind = ClassifyFit(limits.min_clearance, limits.max_clearance);
  return limits;
}

double CalcLargestInterference(double nominal) {
  double largest = CalcUpperOf("zc", kCoarsestPressed, nominal);
  for (int grade = kCoarsestGrade; grade > kCoarsestPressed; --grade) {
    largest = std::max(largest, CalcUpperOf("js", grade, nominal));
  }
  return largest;
}

double CalcLargestPress(double diameter) {
  constexpr double kMostStrain =
      0.05;  // Thermoplastics yield at 2 to 5 %, steel at 0.3 %: a choice.
  const double pressed =
      std::max(CalcUpperOf("zc", kCoarsestPressed, diameter), kMostStrain * diameter);
  return std::min(pressed, CalcLargestInterference(diameter));
}

}  // namespace hvas::fits
