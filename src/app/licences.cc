#include "app/licences.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "mates/side_file.h"

asm(".pushsection .rodata\n"
    "hvas_third_party:\n"
    ".incbin \"" HVAS_THIRD_PARTY
    "\"\n"
    "hvas_third_party_end:\n"
    ".popsection\n");

extern "C" {
extern const char hvas_third_party[];
extern const char hvas_third_party_end[];
}

namespace hvas::app {
namespace {

/** An entry of THIRD-PARTY.md. */
struct Licensed {
  std::string name;
  std::string version;
  std::string terms;  ///< "MIT, bundled."
  std::string_view text;
};

std::string_view GetAllTerms() {
  return {hvas_third_party, static_cast<std::size_t>(hvas_third_party_end - hvas_third_party)};
}

std::vector<Licensed> ListLicensed() {
  constexpr std::string_view kHead = "\n### ";
  std::vector<Licensed> list;
  const std::string_view all = GetAllTerms();
  for (std::size_t at = all.find(kHead); at != std::string_view::npos;
       at = all.find(kHead, at + 1)) {
    const std::size_t begin = at + kHead.size();
    const std::size_t end = std::min(all.find("\n##", begin), all.size());
    const std::string_view text = all.substr(begin, end - begin);
    const std::string title(text.substr(0, text.find('\n')));
    const std::string_view terms = text.substr(title.size() + 2);
    const std::size_t blank = title.rfind(' ');
    list.push_back({title.substr(0, blank), title.substr(blank + 1),
                    std::string(terms.substr(0, terms.find('\n'))), text});
  }
  return list;
}

std::string ToLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/** A text without the marks of Markdown. */
std::string WithoutMarks(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("```")) {
      continue;
    }
    while (line.starts_with('#')) {
      line.remove_prefix(1);
      line.remove_prefix(line.starts_with(' ') ? 1 : 0);
    }
    plain += line;
    plain += '\n';
  }
  return plain;
}

std::string ListText() {
  TextTable table({"name", "version", "licence"}, 3);
  for (const Licensed& one : ListLicensed()) {
    table.Add({one.name, one.version, one.terms.substr(0, one.terms.find_last_of('.'))});
  }
  return "hvas is licensed under the Apache License 2.0. Its third-party components:\n"
         "\n" +
         table.ToText(2) +
         "\n"
         "hvas licences NAME prints the terms of one component, hvas licences all terms.\n";
}

int ShowLicences(const std::string& name, bool is_list) {
  if (is_list) {
    fmt::print("{}", ListText());
    return 0;
  }
  if (name.empty()) {
    fmt::print("{}", Fold(WithoutMarks(GetAllTerms())));
    return 0;
  }
  std::vector<std::string> names;
  for (const Licensed& one : ListLicensed()) {
    names.push_back(one.name);
    if (ToLower(one.name) == ToLower(name)) {
      fmt::print("{}", Fold(WithoutMarks(one.text)));
      return 0;
    }
  }
  const std::string nearest = mates::FindNearest(name, names);
  return ReportMisuse({ErrorCode::kNotFound,
                       fmt::format("hvas contains no component \"{}\"", name),
                       {},
                       nearest.empty() ? "hvas licences --list lists the components"
                                       : fmt::format("did you mean \"{}\"?", nearest)});
}

}  // namespace

void AddLicences(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("licences", "Print the licences of third-party components");
  const auto name = std::make_shared<std::string>();
  const auto is_list = std::make_shared<bool>(false);
  CLI::Option* one = command->add_option("name", *name, "Only this library or package");
  command->add_flag("--list", *is_list, "List names, versions and licences only")->excludes(one);
  command->footer("Examples:\n  hvas licences --list\n  hvas licences zlib");
  command->callback([name, is_list, status] { *status = ShowLicences(*name, *is_list); });
}

}  // namespace hvas::app
