#include "app/output/text_layout.h"

#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "app/output/terminal.h"

namespace hvas::app {
namespace {

struct Letter {
  std::string_view bytes;
  std::size_t width;
};

/** Blocks whose letters are wide, as in UAX #11, roughly. */
bool IsWide(std::uint32_t code) {
  return (code >= 0x1100 && code <= 0x115F) || (code >= 0x2E80 && code <= 0xA4CF) ||
         (code >= 0xAC00 && code <= 0xD7A3) || (code >= 0xF900 && code <= 0xFAFF) ||
         (code >= 0xFE30 && code <= 0xFE6F) || (code >= 0xFF00 && code <= 0xFF60) ||
         (code >= 0xFFE0 && code <= 0xFFE6) || (code >= 0x1F300 && code <= 0x1FAFF) ||
         (code >= 0x20000 && code <= 0x3FFFD);
}

bool IsCombining(std::uint32_t code) {
  return (code >= 0x0300 && code <= 0x036F) || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0xFE00 && code <= 0xFE0F);
}

/** Bytes that are no UTF-8 count as a letter each. */
std::vector<Letter> Split(std::string_view text) {
  std::vector<Letter> letters;
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t length = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    const std::string_view bytes = text.substr(0, length);
    std::uint32_t code = length == 1 ? first : first & (0x7FU >> length);
    for (std::size_t i = 1; i < bytes.size(); ++i) {
      code = (code << 6U) | (static_cast<unsigned char>(bytes[i]) & 0x3FU);
    }
    if (code < 0x20 || code == 0x7F) {
      letters.push_back({"?", 1});
    } else {
      letters.push_back({bytes, IsCombining(code) ? 0U : IsWide(code) ? 2U : 1U});
    }
    text.remove_prefix(bytes.size());
  }
  return letters;
}

}  // namespace

std::size_t CalcWidth(std::string_view text) {
  std::size_t width = 0;
  for (const Letter& letter : Split(text)) {
    width += letter.width;
  }
  return width;
}

std::string Shorten(std::string_view text, std::size_t width) {
  const std::vector<Letter> letters = Split(text);
  std::size_t all = CalcWidth(text);
  std::string shortened;
  std::size_t first = 0;
  if (all > width && width >= 2) {
    shortened = "..";
    while (first < letters.size() && all > width - 2) {
      all -= letters[first++].width;
    }
  }
  for (; first < letters.size(); ++first) {
    shortened += letters[first].bytes;
  }
  return shortened;
}

std::string PadTo(std::string_view text, std::size_t width) {
  std::string padded = Shorten(text, width);
  const std::size_t used = CalcWidth(padded);
  padded.append(width - std::min(width, used), ' ');
  return padded;
}

namespace {

/** Appends words, the first line from the column that it is at, further ones from `indent`. */
void AppendWrapped(std::string_view text, std::size_t column, std::size_t indent,
                   std::string* lines) {
  const std::size_t columns = CountColumns();
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string word = Shorten(text.substr(0, end), columns - indent);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t width = CalcWidth(word);
    if (!is_first && column + 1 + width > columns) {
      *lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      *lines += ' ';
      ++column;
    }
    *lines += word;
    column += width;
    is_first = false;
  }
  *lines += '\n';
}

}  // namespace

std::string Wrap(std::string_view text, std::size_t indent) {
  std::string lines(indent, ' ');
  AppendWrapped(text, indent, indent, &lines);
  return lines;
}

std::string Fold(std::string_view text) {
  std::string folded;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (CalcWidth(line) <= CountColumns()) {
      folded += line;
      folded += '\n';
      continue;
    }
    const std::size_t indent = std::min(line.find_first_not_of(' '), CountColumns() / 2);
    folded.append(indent, ' ');
    AppendWrapped(line.substr(indent), indent, indent + 2, &folded);
  }
  return folded;
}

void ListLimit::PrintRest() const {
  if (!is_all_ && count_ > kMost) {
    fmt::print("  ... and {} more (--all shows them)\n", count_ - kMost);
  }
}

}  // namespace hvas::app
