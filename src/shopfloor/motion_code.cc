#include "shopfloor/motion_code.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "orders/hand_time.h"

namespace hvas::shopfloor {
namespace {

/** A code of MODAPTS with its MOD. The number in a code is its MOD. */
struct ModCode {
  const char* code;
  double mods;
};

constexpr std::array kModCodes{
    ModCode{"M1", 1},       ModCode{"M2", 2},       ModCode{"M3", 3},   ModCode{"M4", 4},
    ModCode{"M5", 5},       ModCode{"M7", 7},       ModCode{"G0", 0},   ModCode{"G1", 1},
    ModCode{"G3", 3},       ModCode{"P0", 0},       ModCode{"P2", 2},   ModCode{"P5", 5},
    ModCode{"E2", 2},       ModCode{"E4", 4},       ModCode{"D3", 3},   ModCode{"R2", 2},
    ModCode{"R3", 3},       ModCode{"N3", 3},       ModCode{"N6", 6},   ModCode{"W5", 5},
    ModCode{"W2.36", 2.36}, ModCode{"W7.75", 7.75}, ModCode{"F3", 3},   ModCode{"C3", 3},
    ModCode{"C4", 4},       ModCode{"B17", 17},     ModCode{"S30", 30}, ModCode{"J2", 2},
    ModCode{"X4", 4},       ModCode{"A4", 4},       ModCode{"V3", 3},   ModCode{"U0.5", 0.5},
    ModCode{"U1", 1},       ModCode{"U2", 2},       ModCode{"U3", 3},   ModCode{"L0", 0},
    ModCode{"L1", 1},       ModCode{"L2", 2},       ModCode{"H4", 4},   ModCode{"H5", 5},
    ModCode{"H6", 6},       ModCode{"H7", 7},       ModCode{"H21", 21}, ModCode{"H26", 26},
    ModCode{"H35", 35}};
// One more MOD for each 4 kg (simulation/hand_time.h), up to what a hoist is for: a choice.
constexpr int kMostLoad = 30;

bool IsDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/** The longest code of a card that a text begins with; empty: none. What follows a code that ends
 with a digit is no digit, or "M4" would be found in "M45". */
std::string_view FindCode(std::string_view text, const TimeCard& card) {
  std::string_view longest;
  for (const auto& [code, seconds] : card.seconds) {
    const bool is_cut = code.size() < text.size() && IsDigit(code.back()) &&
                        (IsDigit(text[code.size()]) || text[code.size()] == '.');
    if (text.starts_with(code) && !is_cut && code.size() > longest.size()) {
      longest = text.substr(0, code.size());
    }
  }
  return longest;
}

}  // namespace

const TimeCard& ModaptsCard() {
  static const TimeCard card = [] {
    TimeCard made{"MODAPTS", {}};
    for (const ModCode& code : kModCodes) {
      made.seconds[code.code] = orders::kModSeconds * code.mods;
    }
    for (int load = 3; load <= kMostLoad; ++load) {
      made.seconds[fmt::format("L{}", load)] = orders::kModSeconds * load;
    }
    return made;
  }();
  return card;
}

Result<std::vector<CodedMotion>> ParseMotions(std::string_view sequence, const TimeCard& card) {
  std::vector<CodedMotion> motions;
  std::size_t at = 0;
  int count = 1;
  bool has_count = false;
  const auto fail = [&](const std::string& what) {
    return Fail(ErrorCode::kInvalid, fmt::format("{}, at character {}", what, at + 1),
                std::string(sequence),
                fmt::format("write codes of {}, as in \"M3 E2 G3 M3 E2 P5\"", card.name));
  };
  while (at < sequence.size()) {
    const std::string_view rest = sequence.substr(at);
    if (rest.front() == ' ' || rest.front() == '+' || rest.front() == '\t') {
      ++at;
      continue;
    }
    if (IsDigit(rest.front())) {
      const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count);
      constexpr int kMostTimes = 100'000;  // The turns of a long thread are far fewer: a choice.
      if (has_count || error != std::errc() || count < 1 || count > kMostTimes) {
        return fail("there is no number of times from 1 to 100000");
      }
      has_count = true;
      at += static_cast<std::size_t>(end - rest.data());
      continue;
    }
    const std::string_view code = FindCode(rest, card);
    if (code.empty()) {
      return fail(fmt::format("there is no code of {}", card.name));
    }
    const std::string name(code);
    motions.push_back({name, count, count * card.seconds.at(name)});
    at += code.size();
    count = 1;
    has_count = false;
  }
  if (has_count) {
    return fail("a code is missing after its number of times");
  }
  return motions;
}

double SumSeconds(const std::vector<CodedMotion>& motions) {
  double sum = 0;
  for (const CodedMotion& motion : motions) {
    sum += motion.seconds;
  }
  return sum;
}

Result<double> CalcMostSeconds(std::string_view sequence) {
  constexpr int kTmuPerIndex = 10;       // The multiplier of BasicMOST.
  constexpr int kLargestIndex = 10'000;  // Walks of kilometres have less: a choice.
  int sum = 0;
  std::size_t at = 0;
  while (at < sequence.size()) {
    if (sequence[at] == ' ') {
      ++at;
      continue;
    }
    const std::string_view rest = sequence.substr(at);
    int index = 0;
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
    if (rest.front() < 'A' || rest.front() > 'Z' || error != std::errc() || index < 0 ||
        index > kLargestIndex) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("there is no capital letter with an index at character {}", at + 1),
                  std::string(sequence), "write a sequence as \"A1 B0 G3 A1 B0 P6 A0\"");
    }
    sum += index;
    at += static_cast<std::size_t>(end - rest.data());
  }
  return kTmuPerIndex * kTmuSeconds * sum;
}

}  // namespace hvas::shopfloor
