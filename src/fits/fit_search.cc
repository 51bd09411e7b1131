#include "fits/fit_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

constexpr std::array<const char*, 28> kLetters{
    "a", "b", "c", "cd", "d", "e", "ef", "f", "fg", "g", "h", "j",  "js", "k",
    "m", "n", "p", "r",  "s", "t", "u",  "v", "x",  "y", "z", "za", "zb", "zc"};

// The classes that shops have gauges and reamers for; a choice of ours after the usual selections.
constexpr std::array<const char*, 23> kCommonShafts{
    "g5", "h5", "js5", "k5", "m5", "n5", "g6", "h6", "js6", "k6", "m6", "n6",
    "p6", "r6", "s6",  "f7", "h7", "e8", "h8", "d9", "e9",  "h9", "h11"};
constexpr std::array<const char*, 16> kCommonHoles{"H6", "G7", "H7",  "JS7", "K7", "M7",
                                                   "N7", "P7", "R7",  "S7",  "F8", "H8",
                                                   "E9", "H9", "D10", "H11"};

template <std::size_t kCount>
bool Has(const std::array<const char*, kCount>& classes, const std::string& text) {
  return std::find(classes.begin(), classes.end(), text) != classes.end();
}

bool IsCommon(const FitClass& fit) {
  const std::string shaft = fit.shaft.ToString();
  return Has(kCommonHoles, fit.hole.ToString()) && Has(kCommonShafts, shaft);
}

std::string ToCapitals(std::string letters) {
  for (char& c : letters) {
    c = static_cast<char>(c - 'a' + 'A');
  }
  return letters;
}

FitClass MakeClass(FitBasis basis, const char* letters, int hole_grade, int shaft_grade) {
  return basis == FitBasis::kHole ? FitClass{{"H", hole_grade}, {letters, shaft_grade}}
                                  : FitClass{{ToCapitals(letters), hole_grade}, {"h", shaft_grade}};
}

}  // namespace

Result<std::vector<FoundFit>> FindFits(double nominal, double min_clearance, double max_clearance,
                                       FitBasis basis) {
  if (!(min_clearance < max_clearance) || !std::isfinite(max_clearance - min_clearance)) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{:g} to {:g} um is not a range of clearances",
                            units::ToUm(min_clearance), units::ToUm(max_clearance)),
                "search for fits", "give the smaller one first; negative values are interference");
  }
  if (Result<double> check = CalcStandardTolerance(7, nominal); !check) {
    return Unexpected(check.error());
  }
  constexpr double kRounding = 1e-10;  // [m]; limits are multiples of 0.05 um.
  std::vector<FoundFit> found;
  for (const char* letters : kLetters) {
    for (int hole = 6; hole <= 11; ++hole) {
      for (int shaft = std::max(5, hole - 2); shaft <= std::min(11, hole + 1); ++shaft) {
        const FitClass fit = MakeClass(basis, letters, hole, shaft);
        const Result<FitLimits> limits = CalcFitLimits(fit, nominal);
        if (limits && limits->min_clearance >= min_clearance - kRounding &&
            limits->max_clearance <= max_clearance + kRounding) {
          found.push_back(
              {fit, *limits, IsCommon(fit),
               (max_clearance - min_clearance) - (limits->max_clearance - limits->min_clearance)});
        }
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const FoundFit& a, const FoundFit& b) {
    return std::tuple(!a.is_common, std::round(units::ToUm(a.unused) * 1e3)) <
           std::tuple(!b.is_common, std::round(units::ToUm(b.unused) * 1e3));
  });
  return found;
}

}  // namespace hvas::fits
