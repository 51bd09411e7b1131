#include "app/manual.h"

#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/command_line.h"

namespace hvas::app {
namespace {

/** A hyphen that is typed is no hyphen of a word; a backslash is no escape. */
std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  }
  return escaped;
}

/** A line of text that begins with no request. */
std::string FormatLine(std::string_view text) {
  const bool is_request = text.starts_with('.') || text.starts_with('\'');
  return (is_request ? "\\&" : "") + Escaped(text) + "\n";
}

std::string Verbatim(std::string_view lines) {
  std::string text = ".PP\n.nf\n";
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    text += FormatLine(lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text + ".fi\n";
}

void AppendCommand(const CommandHelp& command, std::string* text) {
  *text += ".SS " + Escaped(command.Usage()) + "\n" + FormatLine(command.description + ".");
  for (const OptionHelp& option : command.options) {
    *text += ".TP\n.B " + Escaped(option.Left()) + "\n" + FormatLine(option.description);
  }
  if (!command.footer.empty()) {
    *text += Verbatim(command.footer);
  }
}

}  // namespace

std::string MakeManual(const CommandHelp& root, const std::string& version) {
  std::string text = fmt::format(
      ".\\\" Written by `hvas man`.\n"
      ".TH HVAS 1 \"\" \"hvas {}\" \"User Commands\"\n"
      ".SH NAME\n"
      "hvas \\- {}\n"
      ".SH SYNOPSIS\n"
      ".B {}\n"
      ".SH DESCRIPTION\n"
      "HVAS opens a CAD assembly, infers the mates of its parts, and lets a user assemble it with "
      "a haptic device, feeling contact, mates and fits. A simulated person can take the place of "
      "the user.\n",
      version, Escaped(root.description), Escaped(root.Usage()));
  for (const OptionHelp& option : root.options) {
    text += ".TP\n.B " + Escaped(option.Left()) + "\n" + FormatLine(option.description);
  }
  text += ".SH COMMANDS\n";
  const auto commands = ListCommands(root);
  for (std::size_t i = 1; i < commands.size(); ++i) {
    AppendCommand(*commands[i], &text);
  }
  text += ".SH EXIT STATUS\n";
  for (const ExitStatus& row : ExitStatuses()) {
    text += fmt::format(".TP\n.B {}\n{}", row.status, FormatLine(row.meaning));
  }
  text +=
      ".SH ENVIRONMENT\n"
      ".TP\n"
      ".B COLUMNS\n"
      "Width of text in columns, instead of that of the terminal.\n"
      ".TP\n"
      ".B NO_COLOR\n"
      "When it is set, output has no colours.\n"
      ".TP\n"
      ".B XDG_CACHE_HOME\n"
      "Parent of the folder hvas, in which prepared parts are cached; default ~/.cache.\n";
  return text + (root.footer.empty() ? "" : ".SH EXAMPLES\n" + Verbatim(root.footer));
}

void AddManual(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand("man", "Print the manual page, hvas(1)");
  command->footer(
      "An installation contains the page where man finds it. To read it otherwise:\n"
      "  hvas man | man -l -");
  command->callback([app, status] {
    fmt::print("{}", MakeManual(Describe(*app), Version()));
    *status = 0;
  });
}

}  // namespace hvas::app
