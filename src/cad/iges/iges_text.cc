#include "cad/iges/iges_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

namespace hvas::cad {
namespace {

constexpr std::size_t kSectionColumn = 72;  // Column 73, counted from 0.
constexpr std::size_t kColumns = 80;        // Of a line.
constexpr std::string_view kSections = "SGDPT";
constexpr const char* kRemedy = "export the file again from the CAD system";

/** A line of fixed columns. */
struct Line {
  char section{' '};
  std::optional<std::uint32_t> number;  // None where the columns hold anything else.
  std::string_view text;
};

std::optional<std::uint32_t> ParseNumber(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) {
    return std::nullopt;
  }
  text.remove_prefix(begin);
  std::uint32_t number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view rest = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
  const bool is_number =
      parsed.ec == std::errc() && rest.find_first_not_of(' ') == std::string_view::npos;
  return is_number ? std::optional(number) : std::nullopt;
}

Line ParseLine(std::string_view text) {
  Line line;
  line.text = text;
  if (text.size() > kSectionColumn) {
    line.section = text[kSectionColumn];
    line.number = ParseNumber(text.substr(kSectionColumn + 1, kColumns - kSectionColumn - 1));
  }
  return line;
}

/** Takes the first line from a text; line feeds, carriage returns or both end it. */
std::string_view TakeLine(std::string_view* text) {
  const std::size_t end = text->find_first_of("\r\n");
  const std::string_view line = text->substr(0, end);
  if (end == std::string_view::npos) {
    *text = {};
    return line;
  }
  const bool is_pair = (*text)[end] == '\r' && end + 1 < text->size() && (*text)[end + 1] == '\n';
  text->remove_prefix(end + (is_pair ? 2 : 1));
  return line;
}

Unexpected FailAt(std::size_t line, const std::string& what, const std::string& name) {
  return Fail(ErrorCode::kUnreadable, "the IGES file is damaged: " + what,
              fmt::format("{}:{}", name, line), kRemedy);
}

/** "S      2G      4D     92P     46": how many lines each section has. */
Result<void> CheckCounts(const Line& line, const std::array<std::uint32_t, 4>& counts,
                         std::size_t at, const std::string& name) {
  constexpr std::size_t kField = 8;  // A letter and seven digits.
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::string_view field = line.text.substr(i * kField, kField);
    const auto stated = field.empty() ? std::nullopt : ParseNumber(field.substr(1));
    if (!stated || field.front() != kSections[i]) {
      return FailAt(at, "the terminate section does not count the lines of the other sections",
                    name);
    }
    if (*stated != counts[i]) {
      return FailAt(at,
                    fmt::format("section {} has {} lines, and {} by the terminate section",
                                kSections[i], counts[i], *stated),
                    name);
    }
  }
  return {};
}

}  // namespace

bool IsIgesFile(const std::filesystem::path& file, std::string_view head) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const Line line = ParseLine(TakeLine(&head));
  const bool has_start = line.section == 'S' || line.section == 'C' || line.section == 'B';
  return extension == ".igs" || extension == ".iges" || (has_start && line.number == 1U);
}

Result<void> CheckIgesText(std::string_view text, const std::string& name) {
  std::array<std::uint32_t, 4> counts{};
  std::size_t section = 0;  // Index into kSections.
  std::size_t at = 0;
  while (!text.empty()) {
    const Line line = ParseLine(TakeLine(&text));
    ++at;
    if (line.text.empty()) {
      continue;
    }
    if (at == 1 && (line.section == 'C' || line.section == 'B')) {
      return Fail(ErrorCode::kUnsupported,
                  fmt::format("the file is an IGES file in {} form, which cannot be read",
                              line.section == 'C' ? "compressed ASCII" : "binary"),
                  name, "export it in the fixed ASCII form, or as STEP");
    }
    const std::size_t found = kSections.find(line.section);
    if (line.text.size() <= kSectionColumn || found == std::string_view::npos) {
      return FailAt(at, "the line has no letter of a section (S, G, D, P or T) in column 73", name);
    }
    if (found < section || found > section + 1) {
      return FailAt(at,
                    fmt::format("a line of section {} stands behind section {}", line.section,
                                kSections[section]),
                    name);
    }
    section = found;
    if (section == counts.size()) {
      return CheckCounts(line, counts, at, name);
    }
    ++counts[section];
    const bool is_referred_to = kSections[section] == 'D' || kSections[section] == 'P';
    if (is_referred_to && line.number != counts[section]) {
      return FailAt(at,
                    fmt::format("the line should have the number {}{:07} in columns 73 to 80",
                                line.section, counts[section]),
                    name);
    }
  }
  return FailAt(at, "it ends without a terminate section; it may have been cut off", name);
}

}  // namespace hvas::cad
