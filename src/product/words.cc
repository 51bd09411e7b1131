#include "product/words.h"

#include <utility>

#include "product/ascii.h"

namespace hvas::product {
namespace {

// Letters of the second block of Unicode that stand in names, in UTF-8.
constexpr std::array<std::pair<std::string_view, std::string_view>, 28> kFolded{
    {{"ä", "ae"}, {"Ä", "ae"}, {"ö", "oe"}, {"Ö", "oe"}, {"ü", "ue"}, {"Ü", "ue"}, {"ß", "ss"},
     {"é", "e"},  {"É", "e"},  {"è", "e"},  {"È", "e"},  {"ê", "e"},  {"à", "a"},  {"á", "a"},
     {"Á", "a"},  {"ã", "a"},  {"â", "a"},  {"í", "i"},  {"ì", "i"},  {"ó", "o"},  {"Ó", "o"},
     {"õ", "o"},  {"ô", "o"},  {"ú", "u"},  {"ù", "u"},  {"ç", "c"},  {"ñ", "n"},  {"×", "x"}}};

bool IsCapital(char c) {
  return c >= 'A' && c <= 'Z';
}

/** Where a word that begins at `at` ends in a name; npos where it does not stand there. */
std::size_t MatchWord(std::string_view folded, std::string_view word, std::size_t at) {
  for (const char c : word) {
    if (c == ' ') {
      while (at < folded.size() && !IsLetter(folded[at]) && !IsDigit(folded[at])) {
        ++at;
      }
    } else if (at >= folded.size() || folded[at++] != c) {
      return std::string_view::npos;
    }
  }
  return at;
}

}  // namespace

std::string FoldName(std::string_view name) {
  std::string folded;
  folded.reserve(name.size() + 8);
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && IsCapital(name[i]) && IsLetter(name[i - 1])) {
      folded += ' ';
    }
    const std::string_view rest = name.substr(i);
    const auto* const letter = std::find_if(kFolded.begin(), kFolded.end(), [rest](const auto& l) {
      return rest.starts_with(l.first);
    });
    if (letter != kFolded.end()) {
      folded += letter->second;
      i += letter->first.size() - 1;
    } else {
      folded += IsCapital(name[i]) ? static_cast<char>(name[i] - 'A' + 'a') : name[i];
    }
  }
  return folded;
}

std::vector<Word> SplitWords(std::string_view folded) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < folded.size();) {
    const auto is_kind = IsDigit(folded[i]) ? IsDigit : IsLetter;
    std::size_t end = i;
    while (end < folded.size() && is_kind(folded[end])) {
      ++end;
    }
    if (end > i) {
      words.push_back({std::string(folded.substr(i, end - i)), i, end});
    }
    i = std::max(end, i + 1);
  }
  return words;
}

bool HasWord(std::string_view folded, std::string_view word) {
  if (word.empty()) {
    return false;
  }
  const bool is_number = IsDigit(word.back());
  for (std::size_t at = folded.find(word.front()); at != std::string_view::npos;
       at = folded.find(word.front(), at + 1)) {
    std::size_t end = MatchWord(folded, word, at);
    if (end == std::string_view::npos || (at > 0 && IsLetter(folded[at - 1]))) {
      continue;
    }
    if (!is_number && end < folded.size() && folded[end] == 's') {
      ++end;
    }
    if (end >= folded.size() || !(is_number ? IsDigit(folded[end]) : IsLetter(folded[end]))) {
      return true;
    }
  }
  return false;
}

bool NamesThing(std::string_view folded, const std::vector<Word>& words, std::string_view word,
                std::span<const std::string_view> others) {
  constexpr std::size_t kMostWords = 3;  // "o ring" in "O-Ring", "iso 3601": a choice.
  const auto is_other = [others](const std::string& text) {
    return std::any_of(others.begin(), others.end(),
                       [&text](std::string_view other) { return HasWord(text, other); });
  };
  for (std::size_t first = 0; first < words.size(); ++first) {
    const std::size_t begin = words[first].begin;
    std::size_t last = first;
    const std::size_t end = std::min(first + kMostWords, words.size());
    while (last < end && !HasWord(folded.substr(begin, words[last].end - begin), word)) {
      ++last;
    }
    if (last < end && (last + 1 == words.size() || !is_other(words[last + 1].text))) {
      return true;
    }
  }
  return false;
}

}  // namespace hvas::product
