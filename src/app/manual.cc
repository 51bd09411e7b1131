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
std::string Line(std::string_view text) {
  const bool is_request = text.starts_with('.') || text.starts_with('\'');
  return (is_request ? "\\&" : "") + Escaped(text) + "\n";
}

std::string Verbatim(std::string_view lines) {
  std::string text = ".PP\n.nf\n";
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    text += Line(lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text + ".fi\n";
}

void AppendCommand(const CommandHelp& command, std::string* text) {
  *text += ".SS " + Escaped(command.Usage()) + "\n" + Line(command.description + ".");
  for (const OptionHelp& option : command.options) {
    *text += ".TP\n.B " + Escaped(option.Left()) + "\n" + Line(option.description);
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
      ".SH NAME\nhvas \\- {}\n"
      ".SH SYNOPSIS\n.B {}\n"
      ".SH DESCRIPTION\n"
      "HVAS opens a CAD assembly, finds out how its parts belong together, and lets a hand put it "
      "together again, feeling contact, mates and fits. The hand is a person at a haptic device, "
      "or a simulated one.\n",
      version, Escaped(root.description), Escaped(root.Usage()));
  for (const OptionHelp& option : root.options) {
    text += ".TP\n.B " + Escaped(option.Left()) + "\n" + Line(option.description);
  }
  text += ".SH COMMANDS\n";
  const auto commands = ListCommands(root);
  for (std::size_t i = 1; i < commands.size(); ++i) {
    AppendCommand(*commands[i], &text);
  }
  text += ".SH EXIT STATUS\n";
  for (const ExitStatus& row : ExitStatuses()) {
    text += fmt::format(".TP\n.B {}\n{}", row.status, Line(row.meaning));
  }
  text +=
      ".SH ENVIRONMENT\n"
      ".TP\n.B COLUMNS\nThe columns that text may take, in place of those of the terminal.\n"
      ".TP\n.B NO_COLOR\nWhere it is set, the terminal is given no colours.\n"
      ".TP\n.B XDG_CACHE_HOME\nThe folder that prepared parts are kept in, below hvas; ~/.cache "
      "without it.\n";
  return text + (root.footer.empty() ? "" : ".SH EXAMPLES\n" + Verbatim(root.footer));
}

void AddManual(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand("man", "Print the manual page, hvas(1)");
  command->footer(
      "An installed hvas has it where man looks for it. By hand:\n"
      "  hvas man | man -l -");
  command->callback([app, status] {
    fmt::print("{}", MakeManual(Describe(*app), Version()));
    *status = 0;
  });
}

}  // namespace hvas::app
