#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/** Words in the names of parts, subassemblies and materials. */
namespace hvas::product {

/** Makes names comparable: small letters, the Latin letters of German, French, Spanish, Italian and
 Portuguese in ASCII ("Lüfter" is "luefter", "écrou" is "ecrou"), "x" for the sign of
 multiplication, and a blank where a capital letter follows a small one ("HexNut" is "hex nut"). */
[[nodiscard]] std::string FoldName(std::string_view name);

/** A run of letters or a run of digits of a folded name: "lm8uu-2" is lm, 8, uu, 2. */
struct Word {
  std::string text;
  std::size_t begin{0};  ///< Position in the name.
  std::size_t end{0};    ///< Position behind it.
};

[[nodiscard]] std::vector<Word> SplitWords(std::string_view folded);

/** Whether a word stands for itself in a folded name, not inside of another one: "nut" is in
 "nuts_2" and not in "minute", "din 912" in "din912" and not in "din 9120". A plural s and digits
 may follow letters. A blank in the word stands for any separators, or none. */
[[nodiscard]] bool HasWord(std::string_view folded, std::string_view word);

/** Whether a word names the thing itself, and not what it belongs to: it stands in a folded name,
 and not just before one of `others`. "nut" does in "hex nut", not in "nut holder".
 @param words  Those of the name, by SplitWords. */
[[nodiscard]] bool NamesThing(std::string_view folded, const std::vector<Word>& words,
                              std::string_view word, std::span<const std::string_view> others);

/** Whether a folded name has one of the words. */
template <std::size_t kCount>
[[nodiscard]] bool HasOneOf(std::string_view folded,
                            const std::array<std::string_view, kCount>& words) {
  return std::any_of(words.begin(), words.end(),
                     [folded](std::string_view word) { return HasWord(folded, word); });
}

}  // namespace hvas::product
