#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

/** Limits and fits of ISO 286-1:2010 for 0 to 3150 mm (W3). Lengths in metres; the tables, in whole
 micrometres, stay inside. */
namespace hvas::fits {

/** A tolerance class such as "H7": capitals for holes, small letters for shafts. */
struct ToleranceClass {
  std::string letters;  ///< "H", "js", "zc", ...
  int grade{7};         ///< Grade of the standard tolerance: 1 to 18; 0 is IT0, -1 is IT01.

  [[nodiscard]] bool is_hole() const { return letters.front() >= 'A' && letters.front() <= 'Z'; }

  [[nodiscard]] std::string ToString() const;
};

/** A hole and a shaft of one nominal size, such as "H7/p6". */
struct FitClass {
  ToleranceClass hole;
  ToleranceClass shaft;

  [[nodiscard]] std::string ToString() const;
};

/** Deviations from the nominal size [m]: EI and ES of a hole, ei and es of a shaft. */
struct Limits {
  double lower{0};
  double upper{0};
};

enum class FitKind { kClearance, kTransition, kInterference };

/** What a fit gives at one size. Clearances are diametral; negative is interference. */
struct FitLimits {
  Limits hole;
  Limits shaft;
  double min_clearance{0};  ///< EI - es [m].
  double max_clearance{0};  ///< ES - ei [m].
  FitKind kind{FitKind::kClearance};
};

/** Reads "H7", "js6", "IT01" grades as "H01". */
[[nodiscard]] Result<ToleranceClass> ParseToleranceClass(std::string_view text);

/** Reads "H7/p6", also with '-' or spaces between the two; the hole comes first. */
[[nodiscard]] Result<FitClass> ParseFit(std::string_view text);

/** Standard tolerance IT of a grade [m]. @param nominal  Nominal size [m], over 0 up to 3.15. */
[[nodiscard]] Result<double> CalcStandardTolerance(int grade, double nominal);

/** Limit deviations of a class at a nominal size [m]. Fails where the standard defines none. Holes
 J to ZC get the increment delta = IT(n) - IT(n-1) where the standard says so; JS and js are exactly
 half of IT on each side, not rounded. */
[[nodiscard]] Result<Limits> CalcLimits(const ToleranceClass& tolerance_class, double nominal);

[[nodiscard]] Result<FitLimits> CalcFitLimits(const FitClass& fit, double nominal);

/** The largest interference that a fit with a hole H or a shaft h has at a size [m]: that of the
 classes js up to grade 18, and of zc up to grade 11, where ISO 286-2 ends them. 0 beyond the sizes
 of the standard. @param nominal  Nominal size [m]. */
[[nodiscard]] double CalcLargestInterference(double nominal);

/** The largest interference of a press fit of round parts [m]: that of zc11, or 5 % of the
 diameter, which is more than thermoplastics bear before they yield; no more than
 CalcLargestInterference(). */
[[nodiscard]] double CalcLargestPress(double diameter);

/** Clearance where no pair has interference, interference where all have, transition between. */
[[nodiscard]] FitKind ClassifyFit(double min_clearance, double max_clearance);

}  // namespace hvas::fits
