#include "product/fastener_name.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/units.h"
#include "product/ascii.h"

namespace hvas::product {
namespace {

/** True where the word stands for itself: not inside another word ("nut" in "minute"). A plural s
 and digits may follow. */
bool HasWord(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const bool starts = at == 0 || !IsLetter(text[at - 1]);
    std::size_t end = at + word.size();
    if (end < text.size() && text[end] == 's') {
      ++end;
    }
    if (starts && (end >= text.size() || !IsLetter(text[end]))) {
      return true;
    }
  }
  return false;
}

/** "m3", "m2.5x8": a thread size between M1 and M64 that is not part of a longer word. */
bool HasThreadSize(std::string_view text) {
  for (std::size_t at = text.find('m'); at != std::string_view::npos; at = text.find('m', at + 1)) {
    if ((at > 0 && (IsLetter(text[at - 1]) || IsDigit(text[at - 1]))) || at + 1 >= text.size() ||
        !IsDigit(text[at + 1])) {
      continue;
    }
    int size = 0;
    std::size_t end = at + 1;
    for (; end < text.size() && IsDigit(text[end]) && size < 1000; ++end) {
      size = 10 * size + (text[end] - '0');
    }
    const bool ends = end >= text.size() || !IsLetter(text[end]) || text[end] == 'x';
    if (ends && size >= 1 && size <= 64) {
      return true;
    }
  }
  return false;
}

/** "din 912", "iso_4762", "din-7991", "iso4762". */
bool HasStandard(std::string_view text, std::string_view body, std::string_view number) {
  for (std::size_t at = text.find(body); at != std::string_view::npos;
       at = text.find(body, at + 1)) {
    std::size_t begin = at + body.size();
    while (begin < text.size() && !IsDigit(text[begin]) && !IsLetter(text[begin])) {
      ++begin;
    }
    std::size_t end = begin;
    while (end < text.size() && IsDigit(text[end])) {
      ++end;
    }
    if (text.substr(begin, end - begin) == number) {
      return true;
    }
  }
  return false;
}

struct Standard {
  std::string_view body;
  std::string_view number;
  FastenerKind kind;
};

// The screw and nut standards met most in drawings.
constexpr std::array kStandards{
    Standard{"din", "84", FastenerKind::kScrew},    Standard{"din", "912", FastenerKind::kScrew},
    Standard{"din", "913", FastenerKind::kScrew},   Standard{"din", "914", FastenerKind::kScrew},
    Standard{"din", "916", FastenerKind::kScrew},   Standard{"din", "931", FastenerKind::kScrew},
    Standard{"din", "933", FastenerKind::kScrew},   Standard{"din", "963", FastenerKind::kScrew},
    Standard{"din", "965", FastenerKind::kScrew},   Standard{"din", "6912", FastenerKind::kScrew},
    Standard{"din", "7984", FastenerKind::kScrew},  Standard{"din", "7985", FastenerKind::kScrew},
    Standard{"din", "7991", FastenerKind::kScrew},  Standard{"iso", "1207", FastenerKind::kScrew},
    Standard{"iso", "2009", FastenerKind::kScrew},  Standard{"iso", "2010", FastenerKind::kScrew},
    Standard{"iso", "4014", FastenerKind::kScrew},  Standard{"iso", "4017", FastenerKind::kScrew},
    Standard{"iso", "4026", FastenerKind::kScrew},  Standard{"iso", "4027", FastenerKind::kScrew},
    Standard{"iso", "4029", FastenerKind::kScrew},  Standard{"iso", "4762", FastenerKind::kScrew},
    Standard{"iso", "7045", FastenerKind::kScrew},  Standard{"iso", "7046", FastenerKind::kScrew},
    Standard{"iso", "7380", FastenerKind::kScrew},  Standard{"iso", "10642", FastenerKind::kScrew},
    Standard{"iso", "14579", FastenerKind::kScrew}, Standard{"iso", "14583", FastenerKind::kScrew},
    Standard{"din", "439", FastenerKind::kNut},     Standard{"din", "555", FastenerKind::kNut},
    Standard{"din", "562", FastenerKind::kNut},     Standard{"din", "934", FastenerKind::kNut},
    Standard{"din", "985", FastenerKind::kNut},     Standard{"din", "1587", FastenerKind::kNut},
    Standard{"iso", "4032", FastenerKind::kNut},    Standard{"iso", "4033", FastenerKind::kNut},
    Standard{"iso", "4035", FastenerKind::kNut},    Standard{"iso", "7040", FastenerKind::kNut},
    Standard{"iso", "10511", FastenerKind::kNut},
};

constexpr std::array<std::string_view, 4> kNutWords{"nut", "insert", "heatset", "locknut"};
constexpr std::array<std::string_view, 9> kScrewWords{
    "screw", "bolt", "bhcs", "shcs", "fhcs", "stud", "grubscrew", "setscrew", "capscrew"};

struct CoarsePitch {
  double diameter_mm;
  double pitch_mm;
};

// ISO 261:1998, table 2, coarse pitches.
constexpr std::array kCoarsePitches{
    CoarsePitch{1, 0.25},   CoarsePitch{1.1, 0.25}, CoarsePitch{1.2, 0.25}, CoarsePitch{1.4, 0.3},
    CoarsePitch{1.6, 0.35}, CoarsePitch{1.8, 0.35}, CoarsePitch{2, 0.4},    CoarsePitch{2.2, 0.45},
    CoarsePitch{2.5, 0.45}, CoarsePitch{3, 0.5},    CoarsePitch{3.5, 0.6},  CoarsePitch{4, 0.7},
    CoarsePitch{4.5, 0.75}, CoarsePitch{5, 0.8},    CoarsePitch{6, 1},      CoarsePitch{7, 1},
    CoarsePitch{8, 1.25},   CoarsePitch{10, 1.5},   CoarsePitch{12, 1.75},  CoarsePitch{14, 2},
    CoarsePitch{16, 2},     CoarsePitch{18, 2.5},   CoarsePitch{20, 2.5},   CoarsePitch{22, 2.5},
    CoarsePitch{24, 3},     CoarsePitch{27, 3},     CoarsePitch{30, 3.5},   CoarsePitch{33, 3.5},
    CoarsePitch{36, 4},     CoarsePitch{39, 4},     CoarsePitch{42, 4.5},   CoarsePitch{45, 4.5},
    CoarsePitch{48, 5},     CoarsePitch{52, 5},     CoarsePitch{56, 5.5},   CoarsePitch{60, 5.5},
    CoarsePitch{64, 6}};

struct InchThread {
  std::string_view size;
  double diameter_in;
  std::array<int, 2> threads_per_inch;  // UNC, UNF (ASME B1.1).
};

constexpr std::array kInchThreads{
    InchThread{"2", 0.086, {56, 64}},     InchThread{"4", 0.112, {40, 48}},
    InchThread{"5", 0.125, {40, 44}},     InchThread{"6", 0.138, {32, 40}},
    InchThread{"8", 0.164, {32, 36}},     InchThread{"10", 0.19, {24, 32}},
    InchThread{"12", 0.216, {24, 28}},    InchThread{"1/4", 0.25, {20, 28}},
    InchThread{"5/16", 0.3125, {18, 24}}, InchThread{"3/8", 0.375, {16, 24}},
    InchThread{"7/16", 0.4375, {14, 20}}, InchThread{"1/2", 0.5, {13, 20}},
    InchThread{"9/16", 0.5625, {12, 18}}, InchThread{"5/8", 0.625, {11, 18}},
    InchThread{"3/4", 0.75, {10, 16}},    InchThread{"7/8", 0.875, {9, 14}},
    InchThread{"1", 1, {8, 12}}};

/** Reads digits with at most one point, "2.5"; moves `at` past them. */
std::optional<double> ReadNumber(std::string_view text, std::size_t* at) {
  double value = 0;
  double place = 0;  // 0 before the point, then 0.1, 0.01, ...
  std::size_t i = *at;
  for (; i < text.size() && i < *at + 8; ++i) {
    if (IsDigit(text[i])) {
      const double digit = text[i] - '0';
      value = place == 0 ? 10 * value + digit : value + place * digit;
      place *= 0.1;
    } else if (text[i] == '.' && place == 0 && i > *at && i + 1 < text.size() &&
               IsDigit(text[i + 1])) {
      place = 0.1;
    } else {
      break;
    }
  }
  if (i == *at) {
    return std::nullopt;
  }
  *at = i;
  return value;
}

std::optional<ThreadSize> ParseMetric(std::string_view text) {
  constexpr double kLargestPitch = 0.3;  // Of the diameter; what is larger is a length.
  for (std::size_t m = text.find('m'); m != std::string_view::npos; m = text.find('m', m + 1)) {
    std::size_t at = m + 1;
    if (m > 0 && (IsLetter(text[m - 1]) || IsDigit(text[m - 1]))) {
      continue;
    }
    const auto diameter_mm = ReadNumber(text, &at);
    const bool ends = at >= text.size() || !IsLetter(text[at]) || text[at] == 'x';
    if (!diameter_mm || !ends || *diameter_mm < 1 || *diameter_mm > 64) {
      continue;
    }
    ThreadSize size{units::FromMm(*diameter_mm), 0};
    while (at < text.size() && (text[at] == ' ' || text[at] == 'x' || text[at] == '_')) {
      ++at;
    }
    const auto second_mm = ReadNumber(text, &at);
    const bool is_pitch = second_mm && *second_mm > 0 && *second_mm <= kLargestPitch * *diameter_mm;
    size.pitch = is_pitch ? units::FromMm(*second_mm) : FindCoarsePitch(size.diameter);
    return size;
  }
  return std::nullopt;
}

std::optional<ThreadSize> ParseInch(std::string_view text) {
  for (const InchThread& thread : kInchThreads) {
    for (const int count : thread.threads_per_inch) {
      const std::string word = std::string(thread.size) + "-" + std::to_string(count);
      const std::size_t at = text.find(word);
      const std::size_t end = at + word.size();
      const auto is_part = [](char c) { return IsDigit(c) || c == '/' || c == '.' || c == '-'; };
      if (at != std::string_view::npos && (at == 0 || !is_part(text[at - 1])) &&
          (end >= text.size() || !IsDigit(text[end]))) {
        return ThreadSize{thread.diameter_in * units::kMetresPerInch,
                          units::kMetresPerInch / count};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<ThreadSize> ParseThreadSize(std::string_view name) {
  const std::string text = ToLower(name);
  const auto metric = ParseMetric(text);
  return metric ? metric : ParseInch(text);
}

double FindCoarsePitch(double diameter, double tolerance) {
  for (const CoarsePitch& row : kCoarsePitches) {
    if (std::abs(units::FromMm(row.diameter_mm) - diameter) <= tolerance) {
      return units::FromMm(row.pitch_mm);
    }
  }
  return 0;
}

FastenerKind ClassifyName(std::string_view name) {
  const std::string text = ToLower(name);
  for (const std::string_view word : kNutWords) {
    if (HasWord(text, word)) {
      return FastenerKind::kNut;
    }
  }
  if (text.find("heat-set") != std::string::npos || text.find("heat set") != std::string::npos ||
      text.find("heat_set") != std::string::npos) {
    return FastenerKind::kNut;
  }
  for (const std::string_view word : kScrewWords) {
    if (HasWord(text, word)) {
      return FastenerKind::kScrew;
    }
  }
  for (const Standard& standard : kStandards) {
    if (HasStandard(text, standard.body, standard.number)) {
      return standard.kind;
    }
  }
  return HasThreadSize(text) && !HasWord(text, "washer") ? FastenerKind::kScrew
                                                         : FastenerKind::kNone;
}

}  // namespace hvas::product
