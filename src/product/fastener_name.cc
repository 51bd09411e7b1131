#include "product/fastener_name.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
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

// Numbers of standards of screws, bolts, studs and threaded rods, and of nuts, ascending.
// DIN: screws.
constexpr std::array<int, 84> kDinScrews{
    84,   85,   186,  188,  261,  316,  404,  417,  427,  438,  444,  464,  478,  479,
    480,  529,  551,  553,  561,  564,  571,  580,  601,  603,  604,  605,  607,  608,
    609,  610,  653,  835,  906,  908,  910,  912,  913,  914,  915,  916,  920,  921,
    923,  927,  931,  933,  938,  939,  940,  960,  961,  963,  964,  965,  966,  975,
    976,  6900, 6912, 6914, 6921, 7500, 7504, 7505, 7513, 7516, 7964, 7968, 7969, 7971,
    7972, 7973, 7976, 7981, 7982, 7983, 7984, 7985, 7990, 7991, 7996, 7997, 7999, 15237};
// DIN: nuts.
constexpr std::array<int, 44> kDinNuts{
    315,  431,  439,  466,  467,  508,  546,  547,  548,  555,  557,  562,  582,   917,  928,
    929,  934,  935,  936,  937,  970,  971,  972,  979,  980,  981,  982,  985,   986,  1587,
    1804, 1816, 6303, 6330, 6331, 6334, 6915, 6923, 6924, 6925, 6926, 6927, 70852, 80705};
// ISO: screws.
constexpr std::array<int, 56> kIsoScrews{
    1207,  1479,  1481,  1482,  1483,  1580,  2009,  2010,  2342,  3266,  4014,  4015,
    4016,  4017,  4018,  4026,  4027,  4028,  4029,  4162,  4753,  4762,  4766,  7045,
    7046,  7047,  7048,  7049,  7050,  7051,  7053,  7379,  7380,  7411,  7412,  7434,
    7435,  7436,  8676,  8677,  8678,  8765,  10642, 14579, 14580, 14581, 14582, 14583,
    14584, 14585, 14586, 14587, 15480, 15481, 15482, 15483};
// ISO: nuts.
constexpr std::array<int, 29> kIsoNuts{
    299,  4032, 4033, 4034, 4035, 4036, 4161, 7040, 7041,  7042,  7043,  7044,  7413,  7414, 7417,
    7418, 7419, 7719, 7720, 7721, 8673, 8674, 8675, 10511, 10512, 10513, 10663, 12125, 12126};
// EN: screws.
constexpr std::array<int, 2> kEnScrews{1662, 1665};
// EN: nuts.
constexpr std::array<int, 5> kEnNuts{1661, 1663, 1664, 1666, 1667};
// JIS B: screws.
constexpr std::array<int, 5> kJisScrews{1111, 1176, 1177, 1180, 1189};
// JIS B: nuts.
constexpr std::array<int, 4> kJisNuts{1163, 1181, 1183, 1185};
// GB: screws.
constexpr std::array<int, 18> kGbScrews{65,  67,  68,  69,  70,  77,   78,   79,   80,
                                        818, 819, 820, 845, 846, 5780, 5781, 5782, 5783};
// GB: nuts.
constexpr std::array<int, 16> kGbNuts{41,   56,   62,   802,  889,  923,  6170, 6171,
                                      6172, 6173, 6174, 6175, 6177, 6178, 6182, 6184};

/** The standards of one body. */
struct Standards {
  std::string_view body;
  std::span<const int> screws;
  std::span<const int> nuts;
};

constexpr std::array kStandards{
    Standards{"din", kDinScrews, kDinNuts}, Standards{"iso", kIsoScrews, kIsoNuts},
    Standards{"en", kEnScrews, kEnNuts}, Standards{"jis", kJisScrews, kJisNuts},
    Standards{"gb", kGbScrews, kGbNuts}};

/** What a standard of the B18 series of ANSI and ASME is of, by the numbers behind: B18.2.4.1M. */
FastenerKind ClassifyB18(int part, int section) {
  // B18.2: 2 and 4 are of nuts, the others of bolts and screws; B18.16 and B18.17 are of nuts.
  if ((part == 2 && (section == 2 || section == 4)) || part == 16 || part == 17) {
    return FastenerKind::kNut;
  }
  return part == 2 || part == 3 || part == 5 || part == 6 || part == 10 ? FastenerKind::kScrew
                                                                        : FastenerKind::kNone;
}

/** The number that a word is; 0 for all others. */
int ReadNumberWord(const std::vector<Word>& words, std::size_t at) {
  constexpr std::size_t kMostDigits = 6;  // Of a standard; GB has up to five. A choice.
  const bool is_number =
      at < words.size() && IsDigit(words[at].text.front()) && words[at].text.size() <= kMostDigits;
  return is_number ? std::stoi(words[at].text) : 0;
}

/** What a name is by the standard that it states: "ISO4762", "DIN 934", "GB/T 6170", "ANSI
 B18.2.4.1M". */
FastenerKind ClassifyStandard(const std::vector<Word>& words) {
  const auto has = [](std::span<const int> numbers, int number) {
    return std::binary_search(numbers.begin(), numbers.end(), number);
  };
  for (std::size_t i = 1; i < words.size(); ++i) {
    const int number = ReadNumberWord(words, i);
    if (number == 18 && words[i - 1].text == "b" && ReadNumberWord(words, i + 2) > 0) {
      return ClassifyB18(ReadNumberWord(words, i + 1), ReadNumberWord(words, i + 2));
    }
    // GB/T and JIS B have a letter between the body and the number.
    const bool has_letter = i > 1 && words[i - 1].text.size() == 1;
    const std::string& body = words[has_letter ? i - 2 : i - 1].text;
    for (const Standards& standards : kStandards) {
      if (number > 0 && standards.body == body) {
        if (has(standards.nuts, number)) {
          return FastenerKind::kNut;
        }
        if (has(standards.screws, number)) {
          return FastenerKind::kScrew;
        }
      }
    }
  }
  return FastenerKind::kNone;
}

constexpr std::array<std::string_view, 24> kNutWords{
    "nut",      "locknut",        "lock nut",       "wingnut",       "hexnut",
    "heat set", "helicoil",       "rivnut",         "tuerca",        "ecrou",
    "porca",    "dado esagonale", "gewindeeinsatz", "gewindebuchse", "nutsert",
    "moer",     "mutteri",        "matica",         "nakretka",      "gaika",
    "гайка",    "Гайка",          "螺母",           "ナット"};
constexpr std::array<std::string_view, 45> kScrewWords{"screw",
                                                       "bolt",
                                                       "bhcs",
                                                       "shcs",
                                                       "fhcs",
                                                       "stud",
                                                       "hexbolt",
                                                       "grub screw",
                                                       "set screw",
                                                       "cap screw",
                                                       "tornillo",
                                                       "parafuso",
                                                       "boulon",
                                                       "bullone",
                                                       "machinescrew",
                                                       "gewindestift",
                                                       "gewindestange",
                                                       "gewindebolzen",
                                                       "threaded rod",
                                                       "threadedrod",
                                                       "allthread",
                                                       "tige filetee",
                                                       "barra filettata",
                                                       "varilla roscada",
                                                       "barra roscada",
                                                       "vite",
                                                       "vis",
                                                       "schroef",
                                                       "skruv",
                                                       "skrue",
                                                       "ruuvi",
                                                       "sruba",
                                                       "wkret",
                                                       "sroub",
                                                       "болт",
                                                       "Болт",
                                                       "винт",
                                                       "Винт",
                                                       "шпилька",
                                                       "Шпилька",
                                                       "螺栓",
                                                       "螺钉",
                                                       "螺丝",
                                                       "ボルト",
                                                       "ねじ"};
// German and Dutch compounds have the noun at their end: Zylinderschraube, Sechskantmutter.
constexpr std::array<std::string_view, 3> kScrewEnds{"schraube", "schrauben", "schroef"};
constexpr std::array<std::string_view, 3> kNutEnds{"mutter", "muttern", "moer"};

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
    // Words are of Latin letters; those of other scripts are found as they are written.
    const bool is_latin = IsLetter(fastener.front());
    return is_latin ? NamesThing(text, words, fastener, kOtherThings)
                    : text.find(fastener) != std::string_view::npos;
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
    CoarsePitch{68, 6},     CoarsePitch{9, 1.25},   CoarsePitch{11, 1.5},   CoarsePitch{1, 0.25},
    CoarsePitch{1.1, 0.25}, CoarsePitch{1.2, 0.25}, CoarsePitch{1.4, 0.3},  CoarsePitch{1.6, 0.35},
    CoarsePitch{1.8, 0.35}, CoarsePitch{2, 0.4},    CoarsePitch{2.2, 0.45}, CoarsePitch{2.5, 0.45},
    CoarsePitch{3, 0.5},    CoarsePitch{3.5, 0.6},  CoarsePitch{4, 0.7},    CoarsePitch{4.5, 0.75},
    CoarsePitch{5, 0.8},    CoarsePitch{6, 1},      CoarsePitch{7, 1},      CoarsePitch{8, 1.25},
    CoarsePitch{10, 1.5},   CoarsePitch{12, 1.75},  CoarsePitch{14, 2},     CoarsePitch{16, 2},
    CoarsePitch{18, 2.5},   CoarsePitch{20, 2.5},   CoarsePitch{22, 2.5},   CoarsePitch{24, 3},
    CoarsePitch{27, 3},     CoarsePitch{30, 3.5},   CoarsePitch{33, 3.5},   CoarsePitch{36, 4},
    CoarsePitch{39, 4},     CoarsePitch{42, 4.5},   CoarsePitch{45, 4.5},   CoarsePitch{48, 5},
    CoarsePitch{52, 5},     CoarsePitch{56, 5.5},   CoarsePitch{60, 5.5},   CoarsePitch{64, 6}};

struct InchThread {
  std::string_view size;
  double diameter_in;
  std::array<int, 2> threads_per_inch;  // UNC, UNF (ASME B1.1).
};

constexpr std::array kInchThreads{
    InchThread{"0", 0.06, {80, 80}},     InchThread{"1", 0.073, {64, 72}},
    InchThread{"2", 0.086, {56, 64}},    InchThread{"3", 0.099, {48, 56}},
    InchThread{"4", 0.112, {40, 48}},    InchThread{"5", 0.125, {40, 44}},
    InchThread{"6", 0.138, {32, 40}},    InchThread{"8", 0.164, {32, 36}},
    InchThread{"10", 0.19, {24, 32}},    InchThread{"12", 0.216, {24, 28}},
    InchThread{"1/4", 0.25, {20, 28}},   InchThread{"5/16", 0.3125, {18, 24}},
    InchThread{"3/8", 0.375, {16, 24}},  InchThread{"7/16", 0.4375, {14, 20}},
    InchThread{"1/2", 0.5, {13, 20}},    InchThread{"9/16", 0.5625, {12, 18}},
    InchThread{"5/8", 0.625, {11, 18}},  InchThread{"3/4", 0.75, {10, 16}},
    InchThread{"7/8", 0.875, {9, 14}},   InchThread{"1", 1, {8, 12}},
    InchThread{"1 1/8", 1.125, {7, 12}}, InchThread{"1 1/4", 1.25, {7, 12}},
    InchThread{"1 3/8", 1.375, {6, 12}}, InchThread{"1 1/2", 1.5, {6, 12}}};

/** Reads digits with at most one point, or comma, "2.5"; moves `at` past them. */
std::optional<double> ReadNumber(std::string_view text, std::size_t* at) {
  double value = 0;
  double place = 0;  // 0 before the point, then 0.1, 0.01, ...
  std::size_t i = *at;
  for (; i < text.size() && i < *at + 8; ++i) {
    if (IsDigit(text[i])) {
      const double digit = text[i] - '0';
      value = place == 0 ? 10 * value + digit : value + place * digit;
      place *= 0.1;
    } else if ((text[i] == '.' || text[i] == ',') && place == 0 && i > *at && i + 1 < text.size() &&
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
    ThreadSize size{units::FromMm(*diameter_mm), 0, false};
    constexpr std::string_view kBetween = " x_*";
    while (at < text.size() && kBetween.find(text[at]) != std::string_view::npos) {
      ++at;
    }
    const auto second_mm = ReadNumber(text, &at);
    const bool is_pitch = second_mm && *second_mm > 0 && *second_mm <= kLargestPitch * *diameter_mm;
    size.pitch = is_pitch ? units::FromMm(*second_mm) : FindCoarsePitch(size.diameter);
    size.is_pitch_stated = is_pitch;
    return size;
  }
  return std::nullopt;
}

/** A folded name without signs of inches and blanks around dashes: "1/4 in - 20" is "1/4-20". */
std::string CloseUpInches(std::string_view text) {
  std::string closed;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view rest = text.substr(i);
    const bool is_unit = i > 0 && (IsDigit(text[i - 1]) || text[i - 1] == ' ') &&
                         rest.starts_with("in") && (rest.size() == 2 || !IsLetter(rest[2]));
    if (is_unit) {
      ++i;
    } else if (text[i] != '"') {
      closed += text[i];
    }
  }
  for (std::size_t at = closed.find('-'); at != std::string::npos; at = closed.find('-', at + 1)) {
    while (at > 0 && closed[at - 1] == ' ') {
      closed.erase(--at, 1);
    }
    while (at + 1 < closed.size() && closed[at + 1] == ' ') {
      closed.erase(at + 1, 1);
    }
  }
  return closed;
}

std::optional<ThreadSize> ParseInch(std::string_view folded) {
  const std::string text = CloseUpInches(folded);
  const auto is_part = [](char c) { return IsDigit(c) || c == '/' || c == '.' || c == '-'; };
  for (const InchThread& thread : kInchThreads) {
    for (const int count : thread.threads_per_inch) {
      const std::string number = std::to_string(count);
      const std::string dashed = std::string(thread.size) + "-" + number;
      // "3/8 16 UNC": without a dash the series has to be there.
      for (const std::string& word : {dashed, std::string(thread.size) + " " + number + " un",
                                      std::string(thread.size) + " " + number + "un"}) {
        const std::size_t at = text.find(word);
        const std::size_t end = at + word.size();
        if (at != std::string::npos && (at == 0 || !is_part(text[at - 1])) &&
            (end >= text.size() || !IsDigit(text[end]))) {
          return ThreadSize{thread.diameter_in * units::kMetresPerInch,
                            units::kMetresPerInch / count, true};
        }
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
  const FastenerKind by_standard = ClassifyStandard(words);
  if (HasFastenerWord(text, words, kNutWords, kNutEnds) || IsThreadedInsert(text, words) ||
      by_standard == FastenerKind::kNut) {
    return FastenerKind::kNut;
  }
  if (HasFastenerWord(text, words, kScrewWords, kScrewEnds) ||
      by_standard == FastenerKind::kScrew) {
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
