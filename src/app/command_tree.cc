#include "app/command_tree.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"

namespace hvas::app {
namespace {

// Descriptions begin at this column, behind most names of options: a choice.
constexpr std::size_t kDescriptionColumn = 26;

std::string ToUpper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

/** The words of "{none,din2001,din2017}", where a type has them. */
std::vector<std::string> FindChoices(const std::string& type) {
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    return {};
  }
  std::vector<std::string> choices =
      CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
  for (std::string& choice : choices) {
    choice = CLI::detail::trim_copy(choice.substr(0, choice.find("->")));
  }
  return choices;
}

/** CLI11 joins the type and what checks it: "FLOAT:OVER 0", "INT:INT in [1 - 256]". */
void DescribeType(const CLI::Option& option, OptionHelp* help, std::vector<std::string>* notes) {
  if (option.get_expected_max() == 0) {  // A flag.
    return;
  }
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  const std::string base = type.substr(0, colon);
  const std::string check = colon == std::string::npos ? "" : type.substr(colon + 1);
  help->choices = FindChoices(type);
  const bool is_number =
      base.starts_with("FLOAT") || base.starts_with("INT") || base.starts_with("UINT");
  help->value = is_number ? "NUMBER" : base.empty() ? "TEXT" : base;
  if (!help->choices.empty()) {
    help->value = "WORD";
    notes->push_back(fmt::format("{}", fmt::join(help->choices, ", ")));
  } else if (const std::size_t in = check.find("in ["); in != std::string::npos) {
    std::string range = check.substr(in + 4, check.find(']', in) - in - 4);
    range.replace(range.find(" - "), 3, " to ");
    notes->push_back(range);
  } else if (!check.empty()) {
    std::string text = check;
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    notes->push_back(text);
  }
}

template <typename Options>
std::string JoinNames(const Options& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) {
    names.push_back(option->get_name());
  }
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

OptionHelp DescribeOption(const CLI::Option& option, const std::string& group) {
  OptionHelp help;
  help.group = group.empty() ? option.get_group() : group;
  help.is_required = option.get_required();
  help.is_repeated = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  help.is_argument = !option.nonpositional();
  if (help.is_argument) {
    help.names = {ToUpper(option.get_name())};
  }
  for (const std::string& name : option.get_snames()) {
    help.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    help.names.push_back("--" + name);
  }
  std::vector<std::string> notes;
  DescribeType(option, &help, &notes);
  if (!option.get_default_str().empty() && option.get_expected_max() != 0) {
    notes.push_back(fmt::format("without it {}", option.get_default_str()));
  }
  if (const auto needs = option.get_needs(); !needs.empty()) {
    notes.push_back("needs " + JoinNames(needs));
  }
  if (const auto excludes = option.get_excludes(); !excludes.empty()) {
    notes.push_back("not with " + JoinNames(excludes));
  }
  if (help.is_required && !help.is_argument) {
    notes.emplace_back("required");
  }
  help.description = option.get_description();
  if (!notes.empty()) {
    help.description +=
        fmt::format("{}[{}]", help.description.empty() ? "" : " ", fmt::join(notes, "; "));
  }
  return help;
}

void AddOptions(const CLI::App& app, const std::string& group, CommandHelp* help) {
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    // A group has a help of its own, which is that of its command.
    const bool is_help_of_group = !group.empty() && option == app.get_help_ptr();
    if (!option->get_group().empty() && !is_help_of_group) {
      help->options.push_back(DescribeOption(*option, group));
    }
  }
}

/** A line of two columns. */
std::string FormatEntry(const std::string& left, const std::string& text) {
  std::string lines = Wrap(text, kDescriptionColumn);
  const std::string begin = "  " + left;
  const std::string painted = "  " + Painted(left, Style::kName);
  if (text.empty()) {
    return painted + "\n";
  }
  if (CalcWidth(begin) + 2 > kDescriptionColumn) {
    return painted + "\n" + lines;
  }
  return lines.replace(0, CalcWidth(begin), painted);
}

std::string FormatHeading(const std::string& name) {
  return "\n" + Painted(name + ":", Style::kHeading) + "\n";
}

}  // namespace

std::string OptionHelp::Left() const {
  std::string left = fmt::format("{}", fmt::join(names, ", "));
  if (!is_argument && !value.empty()) {
    left += " " + value;
  }
  return left + (is_repeated ? " ..." : "");
}

std::string CommandHelp::LastName() const {
  return name.substr(name.rfind(' ') + 1);
}

std::string CommandHelp::Usage() const {
  std::string usage = name;
  if (std::any_of(options.begin(), options.end(), [](const auto& o) { return !o.is_argument; })) {
    usage += " [OPTIONS]";
  }
  for (const OptionHelp& option : options) {
    if (option.is_argument) {
      usage += option.is_required ? " " + option.Left() : fmt::format(" [{}]", option.Left());
    }
  }
  if (!commands.empty()) {
    usage += needs_command ? " COMMAND" : " [COMMAND]";
  }
  return usage;
}

CommandHelp Describe(const CLI::App& app, const std::string& parent) {
  CommandHelp help;
  help.name = parent + app.get_name();
  help.description = app.get_description();
  help.group = app.get_group();
  help.footer = app.get_footer();
  help.needs_command = app.get_require_subcommand_min() > 0;
  AddOptions(app, "", &help);
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (below->get_name().empty()) {
      AddOptions(*below, below->get_description(), &help);
    } else {
      help.commands.push_back(Describe(*below, help.name + " "));
    }
  }
  std::stable_partition(help.options.begin(), help.options.end(),
                        [](const OptionHelp& option) { return option.is_argument; });
  return help;
}

std::vector<const CommandHelp*> ListCommands(const CommandHelp& root) {
  std::vector<const CommandHelp*> list{&root};
  for (const CommandHelp& command : root.commands) {
    const auto below = ListCommands(command);
    list.insert(list.end(), below.begin(), below.end());
  }
  return list;
}

std::string ToHelp(const CommandHelp& command) {
  std::string text = Wrap(command.description, 0);
  text += "\n" + Fold("Usage: " + command.Usage());
  std::vector<std::string> groups;
  const auto remember = [&groups](const std::string& group) {
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) {
      groups.push_back(group);
    }
  };
  for (const CommandHelp& below : command.commands) {
    remember(below.group);
  }
  for (const std::string& group : groups) {
    text += FormatHeading(group == "Subcommands" ? "Commands" : group);
    for (const CommandHelp& below : command.commands) {
      if (below.group == group) {
        text += FormatEntry(below.LastName(), below.description);
      }
    }
  }
  groups.clear();
  for (const OptionHelp& option : command.options) {
    remember(option.is_argument ? "Arguments" : option.group);
  }
  for (const std::string& group : groups) {
    text += FormatHeading(group);
    for (const OptionHelp& option : command.options) {
      if ((option.is_argument ? "Arguments" : option.group) == group) {
        text += FormatEntry(option.Left(), option.description);
      }
    }
  }
  return command.footer.empty() ? text : text + "\n" + Fold(command.footer);
}

}  // namespace hvas::app
