#include "app/output/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include <fmt/format.h>

namespace hvas::app {
namespace {

// Columns where no terminal says how many it has, and the fewest that tables are made for.
constexpr std::size_t kUsual = 80;
constexpr std::size_t kLeast = 40;

bool HasColours(std::FILE* stream) {
  const char* const refused = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return (refused == nullptr || *refused == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb" && isatty(fileno(stream)) != 0;
}

const char* CodeOf(Style style) {
  switch (style) {
    case Style::kHeading:
      return "1";
    case Style::kName:
      return "36";
    case Style::kGood:
      return "32";
    case Style::kBad:
      return "1;31";
  }
  return "0";
}

}  // namespace

std::size_t CountColumns() {
  if (const char* const stated = std::getenv("COLUMNS"); stated != nullptr) {
    const std::string_view text(stated);
    std::size_t columns = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
    if (error == std::errc() && end == text.data() + text.size() && columns > 0) {
      return std::max(columns, kLeast);
    }
  }
  winsize size{};
  if (isatty(STDOUT_FILENO) != 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 &&
      size.ws_col > 0) {
    return std::max<std::size_t>(size.ws_col, kLeast);
  }
  return kUsual;
}

std::string Painted(std::string_view text, Style style, std::FILE* stream) {
  return HasColours(stream) ? fmt::format("\033[{}m{}\033[0m", CodeOf(style), text)
                            : std::string(text);
}

}  // namespace hvas::app
