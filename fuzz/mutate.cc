#include "fuzz/mutate.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>

namespace hvas::fuzz {
namespace {

constexpr std::array<std::string_view, 16> kAwkward{"0",
                                                    "-1",
                                                    "1",
                                                    "NaN",
                                                    "inf",
                                                    "-inf",
                                                    "1e308",
                                                    "-1e308",
                                                    "1e-320",
                                                    "2147483648",
                                                    "4294967295",
                                                    "18446744073709551616",
                                                    "99999999999999999999",
                                                    "''",
                                                    "$",
                                                    "#1"};

std::size_t Below(std::size_t bound, Random* random) {
  return bound == 0 ? 0 : static_cast<std::size_t>(random->NextBits() % bound);
}

/** A stretch of at most `longest` bytes somewhere in the text. */
struct Stretch {
  std::size_t begin{0};
  std::size_t length{0};
};

Stretch Pick(const std::string& text, std::size_t longest, Random* random) {
  const std::size_t begin = Below(text.size() + 1, random);
  return {begin, Below(std::min(longest, text.size() - begin) + 1, random)};
}

void ReplaceNumber(std::string* text, Random* random) {
  const auto is_digit = [text](std::size_t i) {
    return std::isdigit(static_cast<unsigned char>((*text)[i])) != 0;
  };
  std::size_t begin = Below(text->size(), random);
  while (begin < text->size() && !is_digit(begin)) {
    ++begin;
  }
  std::size_t end = begin;
  while (end < text->size() && is_digit(end)) {
    ++end;
  }
  text->replace(begin, end - begin, kAwkward[Below(kAwkward.size(), random)]);
}

void MutateOnce(std::string* text, Random* random) {
  constexpr std::size_t kShort = 16;
  constexpr std::size_t kLong = 4096;
  const std::size_t kind = Below(8, random);
  const Stretch piece = Pick(*text, kind < 5 ? kShort : kLong, random);
  switch (kind) {
    case 0:
      if (!text->empty()) {
        char& byte = (*text)[Below(text->size(), random)];
        byte = static_cast<char>(byte ^ (1 << Below(8, random)));
      }
      return;
    case 1:
      for (std::size_t i = piece.begin; i < piece.begin + piece.length; ++i) {
        (*text)[i] = static_cast<char>(random->NextBits() & 0xff);
      }
      return;
    case 2:
    case 3:
      ReplaceNumber(text, random);
      return;
    case 4:
    case 5:
      text->erase(piece.begin, piece.length);
      return;
    case 6: {
      const std::string copy = text->substr(piece.begin, piece.length);
      text->insert(Below(text->size() + 1, random), copy);
      return;
    }
    default:
      if (Below(4, random) == 0) {  // Rare, or nothing of the other damage would be seen.
        text->resize(Below(text->size() + 1, random));
      }
      return;
  }
}

}  // namespace

std::string Mutate(std::string_view seed, Random* random) {
  std::string text(seed);
  const std::size_t changes = 1 + Below(8, random);
  for (std::size_t i = 0; i < changes; ++i) {
    MutateOnce(&text, random);
  }
  return text;
}

}  // namespace hvas::fuzz
