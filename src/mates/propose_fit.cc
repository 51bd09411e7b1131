#include "mates/propose_fit.h"

#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>

#include "fits/iso286.h"

namespace hvas::mates {
namespace {

using product::Fit;
using product::FitKind;

constexpr double kEqual = 1e-6;                // Radii closer than this are drawn equal [m].
constexpr double kThreadInterference = 0.015;  // Part of d.
constexpr double kLargestDrawnThread = 12e-3;  // [m]

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z');
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return lower;
}

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

std::string Describe(double diameter) {
  // Micrometres are enough to say what a drawing has.
  std::string text = std::to_string(std::round(diameter * 1e6) / 1e3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text + " mm";
}

Fit MakeThread(double shaft_radius, std::string reason) {
  return {FitKind::kThread, "", 2 * shaft_radius, true, std::move(reason)};
}

std::optional<fits::FitLimits> FindLimits(std::string_view code, double nominal) {
  const Result<fits::FitClass> fit = fits::ParseFit(code);
  const Result<fits::FitLimits> limits =
      fit ? fits::CalcFitLimits(*fit, nominal) : Unexpected(fit.error());
  return limits ? std::optional(*limits) : std::nullopt;
}

/** The closest running fit that may have the drawn clearance, or the widest that the size has. */
std::string ChooseClearanceCode(double nominal, double clearance) {
  constexpr double kRounding = 1e-9;  // [m]
  std::string widest;
  for (const std::string_view code : {"H7/g6", "H8/f7", "H9/d9", "H11/c11"}) {
    if (const auto limits = FindLimits(code, nominal)) {
      widest = code;
      if (limits->max_clearance + kRounding >= clearance) {
        break;
      }
    }
  }
  return widest;
}

/** The lightest press fit that is one at this size: H7/p6 may have clearance below 3 mm. */
std::string ChoosePressCode(double nominal) {
  for (const std::string_view code : {"H7/p6", "H7/r6", "H7/s6"}) {
    const auto limits = FindLimits(code, nominal);
    if (limits && limits->kind == fits::FitKind::kInterference) {
      return std::string(code);
    }
  }
  return {};
}

}  // namespace

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

Fit ProposeFit(const FitEvidence& evidence) {
  const double d = 2 * evidence.shaft_radius;
  const double clearance = 2 * (evidence.hole_radius - evidence.shaft_radius);
  const bool is_larger = clearance > 2 * kEqual;
  const bool is_nut = evidence.hole_part == FastenerKind::kNut;
  const bool is_screw = evidence.shaft_part == FastenerKind::kScrew;
  if (is_nut && is_screw) {
    return MakeThread(evidence.shaft_radius, "the names say nut and screw");
  }
  if (!is_larger && is_nut) {
    return MakeThread(evidence.shaft_radius, "the name says nut");
  }
  if (!is_larger && is_screw && !evidence.nut_on_shaft) {
    return MakeThread(evidence.shaft_radius, "the name says screw");
  }
  if (-clearance > kThreadInterference * d && d <= kLargestDrawnThread) {
    return MakeThread(evidence.shaft_radius, "drawn interference of " + Describe(-clearance) +
                                                 " is a thread's, not a press fit's");
  }
  const double nominal = 2 * evidence.hole_radius;
  if (clearance < -2 * kEqual) {
    return {FitKind::kInterference, ChoosePressCode(nominal), nominal, true,
            "drawn interference of " + Describe(-clearance)};
  }
  if (!is_larger) {
    return {FitKind::kClearance, ChooseClearanceCode(nominal, 0), nominal, true, "drawn equal"};
  }
  return {FitKind::kClearance, ChooseClearanceCode(nominal, clearance), nominal, true,
          "drawn clearance of " + Describe(clearance)};
}

}  // namespace hvas::mates
