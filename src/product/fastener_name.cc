#include "product/fastener_name.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/units.h"
#include "product/ascii.h"
#include "product/words.h"

namespace hvas::product {
namespace {

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

// The standards of screws and nuts met most in drawings.
constexpr std::array<std::string_view, 30> kScrewStandards{
    "din 84",   "din 912",  "din 913",  "din 914",   "din 916",   "din 931",
    "din 933",  "din 963",  "din 965",  "din 6912",  "din 7981",  "din 7982",
    "din 7984", "din 7985", "din 7991", "iso 1207",  "iso 2009",  "iso 2010",
    "iso 4014", "iso 4017", "iso 4026", "iso 4027",  "iso 4029",  "iso 4762",
    "iso 7045", "iso 7046", "iso 7380", "iso 10642", "iso 14579", "iso 14583"};
constexpr std::array<std::string_view, 11> kNutStandards{
    "din 439",  "din 555",  "din 562",  "din 934",  "din 985",  "din 1587",
    "iso 4032", "iso 4033", "iso 4035", "iso 7040", "iso 10511"};

constexpr std::array<std::string_view, 13> kNutWords{
    "nut",    "locknut", "wingnut", "hexnut",         "heat set",      "helicoil", "rivnut",
    "tuerca", "ecrou",   "porca",   "gewindeeinsatz", "gewindebuchse", "nutsert"};
constexpr std::array<std::string_view, 15> kScrewWords{
    "screw",    "bolt",     "bhcs",         "shcs",         "fhcs",
    "stud",     "hexbolt",  "grub screw",   "set screw",    "cap screw",
    "tornillo", "parafuso", "machinescrew", "gewindestift", "gewindestange"};
// German compounds have the noun at their end: Zylinderschraube, Sechskantmutter.
constexpr std::array<std::string_view, 2> kScrewEnds{"schraube", "schrauben"};
constexpr std::array<std::string_view, 2> kNutEnds{"mutter", "muttern"};

// What makes an insert one with a thread; others are of foam, or hold a lens.
constexpr std::array<std::string_view, 6> kInsertWords{"threaded", "thread", "heat",
                                                       "brass",    "press",  "knurled"};

// What a fastener's name or a thread's size stands before, where it is something else: "nut
// holder", "screw hole", "M4 spacer".
constexpr std::array<std::string_view, 37> kOtherThings{
    "washer", "spacer",   "standoff", "plate",    "bracket", "holder", "mount", "housing",
    "cover",  "hole",     "block",    "terminal", "driver",  "trap",   "guide", "clamp",
    "seat",   "retainer", "key",      "post",     "boss",    "tower",  "box",   "case",
    "tray",   "jig",      "knob",     "bearing",  "gear",    "pulley", "ring",  "spring",
    "hub",    "arm",      "frame",    "carrier",  "scheibe"};

/** Whether one of the words is there, or a compound that ends in one of `ends`, and not just before
 the name of another thing ("nut holder"). */
template <std::size_t kCount, std::size_t kEnds>
bool HasFastenerWord(std::string_view text, const std::vector<Word>& words,
                     const std::array<std::string_view, kCount>& fasteners,
                     const std::array<std::string_view, kEnds>& ends) {
  const auto is_named = [&](std::string_view fastener) {
    return NamesThing(text, words, fastener, kOtherThings);
  };
  const auto is_compound = [&](const Word& word) {
    return std::any_of(ends.begin(), ends.end(), [&word, &is_named](std::string_view end) {
      return word.text.ends_with(end) && is_named(word.text);
    });
  };
  return std::any_of(fasteners.begin(), fasteners.end(), is_named) ||
         std::any_of(words.begin(), words.end(), is_compound);
}

/** "Heat-set insert", "insert M3", "Insert"; not "foam insert". */
bool IsThreadedInsert(std::string_view text, const std::vector<Word>& words) {
  const auto letters = std::count_if(words.begin(), words.end(),
                                     [](const Word& word) { return IsLetter(word.text.front()); });
  return HasWord(text, "insert") &&
         (letters == 1 || HasThreadSize(text) || HasOneOf(text, kInsertWords));
}

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
  const std::string text = FoldName(name);
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
  const std::string text = FoldName(name);
  const std::vector<Word> words = SplitWords(text);
  if (HasFastenerWord(text, words, kNutWords, kNutEnds) || IsThreadedInsert(text, words) ||
      HasOneOf(text, kNutStandards)) {
    return FastenerKind::kNut;
  }
  if (HasFastenerWord(text, words, kScrewWords, kScrewEnds) || HasOneOf(text, kScrewStandards)) {
    return FastenerKind::kScrew;
  }
  return HasThreadSize(text) && !HasOneOf(text, kOtherThings) ? FastenerKind::kScrew
                                                              : FastenerKind::kNone;
}

bool IsPinName(std::string_view name) {
  static constexpr std::array<std::string_view, 13> kWords{
      "pin",       "dowel",   "dowelpin", "stift", "passstift", "zylinderstift", "spannstift",
      "springpin", "rollpin", "goupille", "spina", "axle",      "achse"};
  // Standards of parallel pins, taper pins and slotted spring pins.
  static constexpr std::array<std::string_view, 6> kStandards{"iso 2338", "iso 8734", "iso 8752",
                                                              "din 7",    "din 6325", "din 1481"};
  const std::string text = FoldName(name);
  // A standard counts before words and sizes: "m6" behind it is a tolerance class.
  return HasOneOf(text, kStandards) ||
         (ClassifyName(name) == FastenerKind::kNone && HasOneOf(text, kWords));
}

}  // namespace hvas::product
