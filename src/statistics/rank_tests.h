#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"

namespace hvas::statistics {

/** Ranks from 1; what is tied has the mean of its ranks. */
struct MidRanks {
  std::vector<double> ranks;  ///< Ordered as the values are.
  double tie_sum{0};          ///< Sum of t^3 - t over groups of t tied values.
};

/** Values closer than `tolerance` to their neighbour in order are tied. @pre all are finite. */
[[nodiscard]] MidRanks CalcMidRanks(std::span<const double> values, double tolerance = 0);

/** Whether the exact p of a test is computed, too: takes much longer than the rest. */
enum class Exact { kNo, kYes };

/** Do conditions differ? Friedman, J. Am. Stat. Assoc. 32, 1937, with correction for ties. */
struct Friedman {
  std::size_t row_count{0};
  std::size_t condition_count{0};
  std::vector<double> mean_ranks;  ///< Each condition's; 1 is the smallest value.
  /** Chi-square with condition_count - 1 degrees of freedom, its p and Kendall's W from 0 to 1.
   None where every row is one tie. */
  std::optional<double> chi_square;
  std::optional<double> p;
  std::optional<double> kendall_w;
  /** F = (n - 1) chi-square / (n (k - 1) - chi-square) with k - 1 and (k - 1) (n - 1) degrees of
   freedom: Iman and Davenport, Communications in Statistics A9, 1980. None where all rows agree,
   too, and F has no bound. */
  std::optional<double> iman_davenport_f;
  std::optional<double> iman_davenport_p;
  /** p by all permutations of ranks within rows. None where there are too many to go through:
   without ties three conditions go up to 125 rows, four to 26, five to 9. */
  std::optional<double> exact_p;
};

/** @param rows One value a condition each. Errors: kInvalid for fewer than two rows or conditions,
 rows of different length, values that are not finite. */
[[nodiscard]] Result<Friedman> TestFriedman(std::span<const std::vector<double>> rows,
                                            Exact exact = Exact::kYes);

/** Are differences around zero? Wilcoxon, Biometrics Bulletin 1, 1945: signed ranks. Zero
 differences are dropped. */
struct Wilcoxon {
  std::size_t n{0};           ///< Differences that are not zero.
  std::size_t zero_count{0};  ///< Those that were dropped.
  double positive_rank_sum{0};
  double negative_rank_sum{0};
  /** Normal approximation with the variance corrected for ties and no correction for continuity,
   both sides. None where all differences are zero. */
  std::optional<double> z;  ///< Above zero where positive differences weigh more.
  std::optional<double> p;
  /** p with the distance from the mean one half smaller, as other programs have it. */
  std::optional<double> continuity_p;
  /** Zero differences kept while ranks are given, and left out of the sums: Pratt, J. Am. Stat.
   Assoc. 54, 1959; the moments after Cureton, J. Am. Stat. Assoc. 62, 1967. No correction for
   continuity. */
  std::optional<double> pratt_z;
  std::optional<double> pratt_p;
  /** p by all 2^n signs, both sides; up to kMostExactPairs. */
  std::optional<double> exact_p;
  /** Matched-pairs rank biserial correlation, -1 to 1: the difference of the rank sums over their
   sum (Kerby, Comprehensive Psychology 3, 2014). */
  std::optional<double> rank_biserial;
  std::optional<double> r;  ///< z over the root of n.
};

inline constexpr std::size_t kMostExactPairs = 200;  // Sums of 2^n signs are counted in n^3 steps.

/** @param first, second One pair each; differences are second minus first. Errors: kInvalid for
 samples of different size, none, or values that are not finite. */
[[nodiscard]] Result<Wilcoxon> TestWilcoxon(std::span<const double> first,
                                            std::span<const double> second,
                                            Exact exact = Exact::kYes);

/** p times their number, at most 1. */
[[nodiscard]] std::vector<double> AdjustBonferroni(std::span<const double> p);

/** Holm, Scandinavian Journal of Statistics 6, 1979: never larger than Bonferroni's. In the order
 of `p`. */
[[nodiscard]] std::vector<double> AdjustHolm(std::span<const double> p);

}  // namespace hvas::statistics
