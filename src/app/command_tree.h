#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/** What the tree of commands and options tells of itself: for help, the manual page and completion,
 so that none of them can differ from what the program takes. */
namespace hvas::app {

struct OptionHelp {
  std::vector<std::string> names;    ///< "-o", "--output"; of an argument its name, in capitals.
  std::string value;                 ///< "NUMBER", "TEXT", "FILE"; empty where it takes none.
  std::vector<std::string> choices;  ///< All words that it takes, where these are few.
  std::string description;           ///< Ends with default, range and what it needs, in brackets.
  std::string group;
  bool is_argument{false};
  bool is_required{false};
  bool is_repeated{false};

  /** "-o, --output FILE", or "FILE ...". */
  [[nodiscard]] std::string Left() const;
};

struct CommandHelp {
  std::string name;  ///< "hvas fit design".
  std::string description;
  std::string group;                  ///< The heading under which its neighbours and it are listed.
  std::string footer;                 ///< Exit status and examples, in lines.
  std::vector<OptionHelp> options;    ///< Arguments first.
  std::vector<CommandHelp> commands;  ///< Below it.
  bool needs_command{false};

  [[nodiscard]] std::string LastName() const;
  /** "hvas fit design [OPTIONS] FILE". */
  [[nodiscard]] std::string Usage() const;
};

/** @param parent  The name of the command above, with a blank behind it; empty for the program. */
[[nodiscard]] CommandHelp Describe(const CLI::App& app, const std::string& parent = {});

/** The command itself and all below it, parents first. */
[[nodiscard]] std::vector<const CommandHelp*> ListCommands(const CommandHelp& root);

/** What stands behind --help, in CountColumns() columns. */
[[nodiscard]] std::string ToHelp(const CommandHelp& command);

}  // namespace hvas::app
