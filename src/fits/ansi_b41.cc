#include "fits/ansi_b41.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

constexpr std::size_t kMostRanges = 13;  // The most ranges of sizes that a table has.
constexpr double kNone = -1;             // The table has no such fit there.

/** Ends of the ranges of diameters [in]; a range is over the one before, up to and including its
 end. */
constexpr std::array<double, kMostRanges> kRanges_in{0.12, 0.24, 0.40, 0.71,  1.19,  1.97, 3.15,
                                                     4.73, 7.09, 9.85, 12.41, 15.75, 19.69};
constexpr std::array<double, 11> kForceRanges_in{0.12, 0.24, 0.40, 0.56, 0.71, 0.95,
                                                 1.19, 1.58, 1.97, 2.56, 3.15};

/** Deviations in thousandths of an inch: the hole's upper one (its lower is 0), and the shaft's. */
struct Table {
  std::string_view name;
  std::string_view hole;
  std::string_view shaft;
  std::array<double, kMostRanges> hole_upper_thou;
  std::array<double, kMostRanges> shaft_upper_thou;
  std::array<double, kMostRanges> shaft_lower_thou;
};

// clang-format off
constexpr std::array<double, kMostRanges> kH5{0.2, 0.2, 0.25, 0.3, 0.4, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.0};
constexpr std::array<double, kMostRanges> kH6{0.25, 0.3, 0.4, 0.4, 0.5, 0.6, 0.7, 0.9, 1.0, 1.2, 1.2, 1.4, 1.6};
constexpr std::array<double, kMostRanges> kH7{0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5};
constexpr std::array<double, kMostRanges> kH8{0.6, 0.7, 0.9, 1.0, 1.2, 1.6, 1.8, 2.2, 2.5, 2.8, 3.0, 3.5, 4.0};
constexpr std::array<double, kMostRanges> kH9{1.0, 1.2, 1.4, 1.6, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 6.0};
constexpr std::array<double, kMostRanges> kH10{1.6, 1.8, 2.2, 2.8, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0};
constexpr std::array<double, kMostRanges> kH11{2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 9.0, 10.0, 12.0, 12.0, 14.0, 16.0};
constexpr std::array<double, kMostRanges> kG{-0.1, -0.15, -0.2, -0.25, -0.3, -0.4, -0.4, -0.5, -0.6, -0.6, -0.8, -1.0, -1.2};
constexpr std::array<double, kMostRanges> kF{-0.3, -0.4, -0.5, -0.6, -0.8, -1.0, -1.2, -1.4, -1.6, -2.0, -2.5, -3.0, -4.0};
constexpr std::array<double, kMostRanges> kE{-0.6, -0.8, -1.0, -1.2, -1.6, -2.0, -2.5, -3.0, -3.5, -4.0, -5.0, -6.0, -8.0};

constexpr std::array<Table, 12> kTables{{
    {"RC1", "H5", "g4", kH5, kG, {-0.25, -0.3, -0.35, -0.45, -0.55, -0.7, -0.7, -0.9, -1.1, -1.2, -1.4, -1.7, -2.0}},
    {"RC2", "H6", "g5", kH6, kG, {-0.3, -0.35, -0.45, -0.55, -0.7, -0.8, -0.9, -1.1, -1.3, -1.4, -1.7, -2.0, -2.2}},
    {"RC3", "H7", "f6", kH7, kF, {-0.55, -0.7, -0.9, -1.0, -1.3, -1.6, -1.9, -2.3, -2.6, -3.2, -3.7, -4.4, -5.6}},
    {"RC4", "H8", "f7", kH8, kF, {-0.7, -0.9, -1.1, -1.3, -1.6, -2.0, -2.4, -2.8, -3.2, -3.8, -4.5, -5.2, -6.5}},
    {"RC5", "H8", "e7", kH8, kE, {-1.0, -1.3, -1.6, -1.9, -2.4, -3.0, -3.7, -4.4, -5.1, -5.8, -7.0, -8.2, -10.5}},
    {"RC6", "H9", "e8", kH9, kE, {-1.2, -1.5, -1.9, -2.2, -2.8, -3.6, -4.3, -5.2, -6.0, -6.8, -8.0, -9.5, -12.0}},
    {"RC7", "H9", "d8", kH9,
     {-1.0, -1.2, -1.6, -2.0, -2.5, -3.0, -4.0, -5.0, -6.0, -7.0, -8.0, -10.0, -12.0},
     {-1.6, -1.9, -2.5, -3.0, -3.7, -4.6, -5.8, -7.2, -8.5, -9.8, -11.0, -13.5, -16.0}},
    {"RC8", "H10", "c9", kH10,
     {-2.5, -2.8, -3.0, -3.5, -4.5, -5.0, -6.0, -7.0, -8.0, -10.0, -12.0, -14.0, -16.0},
     {-3.5, -4.0, -4.4, -5.1, -6.5, -7.5, -9.0, -10.5, -12.0, -14.5, -17.0, -20.0, -22.0}},
    {"RC9", "H11", "", kH11,
     {-4.0, -4.5, -5.0, -6.0, -7.0, -8.0, -9.0, -10.0, -12.0, -15.0, -18.0, -22.0, -25.0},
     {-5.6, -6.0, -7.2, -8.8, -10.5, -12.0, -13.5, -15.0, -18.0, -22.0, -26.0, -31.0, -35.0}},
    {"LN1", "H6", "n5", kH6,
     {0.45, 0.5, 0.65, 0.8, 1.0, 1.1, 1.3, 1.6, 1.9, 2.2, 2.3, 2.6, 2.8},
     {0.25, 0.3, 0.4, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.4, 1.6, 1.8}},
    {"LN2", "H7", "p6", kH7,
     {0.65, 0.8, 1.0, 1.1, 1.3, 1.6, 2.1, 2.5, 2.8, 3.2, 3.4, 3.9, 4.4},
     {0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5, 2.8}},
    {"LN3", "H7", "r6", kH7,
     {0.75, 0.9, 1.2, 1.4, 1.7, 2.0, 2.3, 2.9, 3.5, 4.2, 4.7, 5.9, 6.6},
     {0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.5, 3.0, 3.5, 4.5, 5.0}},
}};

// ANSI B4.1 has these upper deviations, in thousandths of an inch.
constexpr std::array<double, kMostRanges> kForceH7{0.4, 0.5, 0.6, 0.7, 0.7, 0.8, 0.8, 1.0, 1.0, 1.2, 1.2};

constexpr std::array<Table, 5> kForceTables{{
    {"FN1", "H6", "", {0.25, 0.3, 0.4, 0.4, 0.4, 0.5, 0.5, 0.6, 0.6, 0.7, 0.7},
     {0.5, 0.6, 0.75, 0.8, 0.9, 1.1, 1.2, 1.3, 1.4, 1.8, 1.9},
     {0.3, 0.4, 0.5, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.3, 1.4}},
    {"FN2", "H7", "s6", kForceH7,
     {0.85, 1.0, 1.4, 1.6, 1.6, 1.9, 1.9, 2.4, 2.4, 2.7, 2.9},
     {0.6, 0.7, 1.0, 1.2, 1.2, 1.4, 1.4, 1.8, 1.8, 2.0, 2.2}},
    {"FN3", "H7", "t6", {kNone, kNone, kNone, kNone, kNone, kNone, 0.8, 1.0, 1.0, 1.2, 1.2},
     {0, 0, 0, 0, 0, 0, 2.1, 2.6, 2.8, 3.2, 3.7},
     {0, 0, 0, 0, 0, 0, 1.6, 2.0, 2.2, 2.5, 3.0}},
    {"FN4", "H7", "u6", kForceH7,
     {0.95, 1.2, 1.6, 1.8, 1.8, 2.1, 2.3, 3.1, 3.4, 4.2, 4.7},
     {0.7, 0.9, 1.2, 1.4, 1.4, 1.6, 1.8, 2.5, 2.8, 3.5, 4.0}},
    {"FN5", "H8", "x7", {0.6, 0.7, 0.9, 1.0, 1.0, 1.2, 1.2, 1.6, 1.6, 1.8, 1.8},
     {1.3, 1.7, 2.0, 2.3, 2.5, 3.0, 3.3, 4.0, 5.0, 6.2, 7.2},
     {0.9, 1.2, 1.4, 1.6, 1.8, 2.2, 2.5, 3.0, 4.0, 5.0, 6.0}},
}};

// clang-format on

/** "RC4" for "rc 4" and "RC-4". */
std::string CanonicalName(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (c != ' ' && c != '-') {
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return name;
}

double FromThou(double thou) {
  return 1e-3 * thou * units::kMetresPerInch;
}

const Table* FindTable(std::span<const Table> tables, std::string_view name) {
  const auto table =
      std::find_if(tables.begin(), tables.end(), [name](const Table& t) { return t.name == name; });
  return table != tables.end() ? &*table : nullptr;
}

}  // namespace

bool IsAnsiFit(std::string_view text) {
  const std::string name = CanonicalName(text);
  constexpr std::array<std::string_view, 5> kFamilies{"RC", "LC", "LT", "LN", "FN"};
  return name.size() >= 3 && name.size() <= 4 &&
         std::any_of(kFamilies.begin(), kFamilies.end(),
                     [&name](std::string_view family) { return name.starts_with(family); }) &&
         std::all_of(name.begin() + 2, name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

Result<AnsiFit> FindAnsiFit(std::string_view text, double nominal) {
  const std::string name = CanonicalName(text);
  const Table* const usual = FindTable(kTables, name);
  const Table* const table = usual != nullptr ? usual : FindTable(kForceTables, name);
  if (table == nullptr) {
    return Fail(ErrorCode::kNotFound, fmt::format("there is no table of ANSI B4.1 for {}", name),
                {},
                "the tables have RC1 to RC9, LN1 to LN3 and FN1 to FN5; for others give the "
                "classes of hole and shaft, for example 1.5in H7/h6");
  }
  const std::span<const double> ends = usual != nullptr ? std::span<const double>(kRanges_in)
                                                        : std::span<const double>(kForceRanges_in);
  const double nominal_in = nominal / units::kMetresPerInch;
  // A diameter that meets the end of a range up to rounding is in it.
  const auto end = std::find_if(ends.begin(), ends.end(),
                                [nominal_in](double e) { return nominal_in <= e * (1 + 1e-12); });
  const auto i = static_cast<std::size_t>(end - ends.begin());
  if (!(nominal_in > 0) || end == ends.end() || table->hole_upper_thou[i] == kNone) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("{} is not tabulated at a diameter of {:g} in", name, nominal_in), {},
                fmt::format("choose one up to {:g} in{}", ends.back(),
                            name == "FN3" ? " and over 0.95 in" : ""));
  }
  AnsiFit fit;
  fit.name = name;
  fit.hole = table->hole;
  fit.shaft = table->shaft;
  FitLimits& limits = fit.limits;
  limits.hole = {0, FromThou(table->hole_upper_thou[i])};
  limits.shaft = {FromThou(table->shaft_lower_thou[i]), FromThou(table->shaft_upper_thou[i])};
  limits.min_clearance = limits.hole.lower - limits.shaft.upper;
  limits.max_clearance = limits.hole.upper - limits.shaft.lower;
  limits.kind = ClassifyFit(limits.min_clearance, limits.max_clearance);
  return fit;
}

}  // namespace hvas::fits
