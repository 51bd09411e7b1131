#include "app/completion.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/output/choice.h"

namespace hvas::app {
namespace {

/** The text in single quotes, as POSIX shells take it. */
std::string Quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return quoted + "'";
}

std::string QuotedForFish(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' || c == '\\' ? "\\" + std::string(1, c) : std::string(1, c);
  }
  return quoted + "'";
}

/** One line, and not much of it. */
std::string Brief(const std::string& text) {
  // A candidate and its description stand beside each other in most terminals: a choice.
  constexpr std::size_t kMost = 70;
  if (text.size() <= kMost) {
    return text;
  }
  return text.substr(0, text.rfind(' ', kMost)) + " ..";
}

/** Patterns of a case: 'hvas fit'|'hvas study', of every command below the program. */
std::string CommandPatterns(const std::vector<const CommandHelp*>& commands) {
  std::vector<std::string> patterns;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    patterns.push_back(Quoted(commands[i]->name));
  }
  return fmt::format("{}", fmt::join(patterns, "|"));
}

/** Calls `take` with "'command --option'" and the option, of each that `selects`. */
template <typename Selects, typename Take>
void ForEachOption(const std::vector<const CommandHelp*>& commands, const Selects& selects,
                   const Take& take) {
  for (const CommandHelp* command : commands) {
    for (const OptionHelp& option : command->options) {
      if (!option.is_argument && selects(option)) {
        for (const std::string& name : option.names) {
          take(Quoted(command->name + " " + name), option);
        }
      }
    }
  }
}

/** Patterns of a case of the options of all commands that `selects`. */
template <typename Selects>
std::string OptionPatterns(const std::vector<const CommandHelp*>& commands,
                           const Selects& selects) {
  std::vector<std::string> patterns;
  ForEachOption(commands, selects, [&](std::string pattern, const OptionHelp&) {
    patterns.push_back(std::move(pattern));
  });
  return fmt::format("{}", fmt::join(patterns, "|"));
}

bool HasChoices(const OptionHelp& option) {
  return !option.choices.empty();
}

bool IsNumber(const OptionHelp& option) {
  return option.value == "NUMBER";
}

bool IsFile(const OptionHelp& option) {
  return !option.value.empty() && !IsNumber(option) && option.choices.empty();
}

std::vector<std::string> WordsOf(const CommandHelp& command) {
  std::vector<std::string> words;
  for (const CommandHelp& below : command.commands) {
    words.push_back(below.LastName());
  }
  for (const OptionHelp& option : command.options) {
    if (option.is_argument) {
      words.insert(words.end(), option.choices.begin(), option.choices.end());
    } else {
      words.insert(words.end(), option.names.begin(), option.names.end());
    }
  }
  return words;
}

/** For zsh's _describe: a colon ends the word that is completed. */
std::string Described(const std::string& word, const std::string& text) {
  return Quoted(word + ":" + Brief(text));
}

}  // namespace

std::string MakeBashCompletion(const CommandHelp& root) {
  const auto commands = ListCommands(root);
  std::string text = fmt::format(
      "# bash completion for hvas, written by `hvas completion bash`\n"
      "_hvas() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}\n"
      "  local command=hvas words= i\n"
      "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
      "    case \"$command ${{COMP_WORDS[i]}}\" in\n"
      "      {}) command=\"$command ${{COMP_WORDS[i]}}\" ;;\n"
      "    esac\n"
      "  done\n"
      "  COMPREPLY=()\n"
      "  case \"$command $previous\" in\n",
      CommandPatterns(commands));
  ForEachOption(commands, HasChoices, [&](const std::string& pattern, const OptionHelp& option) {
    text += fmt::format("    {}) words={} ;;\n", pattern,
                        Quoted(fmt::format("{}", fmt::join(option.choices, " "))));
  });
  text += fmt::format(
      "    {}) compopt +o default 2>/dev/null; return ;;\n"
      "    {}) return ;;\n"
      "    *)\n"
      "      case \"$command\" in\n",
      OptionPatterns(commands, IsNumber), OptionPatterns(commands, IsFile));
  for (const CommandHelp* command : commands) {
    text += fmt::format("        {}) words={} ;;\n", Quoted(command->name),
                        Quoted(fmt::format("{}", fmt::join(WordsOf(*command), " "))));
  }
  return text +
         "      esac ;;\n"
         "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
         "}\n"
         "complete -o default -F _hvas hvas\n";
}

std::string MakeZshCompletion(const CommandHelp& root) {
  const auto commands = ListCommands(root);
  std::string text = fmt::format(
      "#compdef hvas\n"
      "# zsh completion for hvas, written by `hvas completion zsh`\n"
      "_hvas() {{\n"
      "  local command=hvas previous=$words[CURRENT-1] i\n"
      "  local -a commands options\n"
      "  for ((i = 2; i < CURRENT; i++)); do\n"
      "    case \"$command $words[i]\" in\n"
      "      ({}) command=\"$command $words[i]\" ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$command $previous\" in\n",
      CommandPatterns(commands));
  ForEachOption(commands, HasChoices, [&](const std::string& pattern, const OptionHelp& option) {
    text +=
        fmt::format("    ({}) compadd -- {}; return ;;\n", pattern, fmt::join(option.choices, " "));
  });
  text += fmt::format(
      "    ({}) _message number; return ;;\n"
      "    ({}) _files; return ;;\n"
      "  esac\n"
      "  case $command in\n",
      OptionPatterns(commands, IsNumber), OptionPatterns(commands, IsFile));
  for (const CommandHelp* command : commands) {
    std::vector<std::string> below;
    std::vector<std::string> options;
    for (const CommandHelp& next : command->commands) {
      below.push_back(Described(next.LastName(), next.description));
    }
    for (const OptionHelp& option : command->options) {
      for (const std::string& word : option.is_argument ? option.choices : option.names) {
        (option.is_argument ? below : options).push_back(Described(word, option.description));
      }
    }
    text += fmt::format("    ({})\n      commands=({})\n      options=({}) ;;\n",
                        Quoted(command->name), fmt::join(below, " "), fmt::join(options, " "));
  }
  return text +
         "  esac\n"
         "  if [[ $words[CURRENT] == -* ]]; then\n"
         "    _describe option options\n"
         "  else\n"
         "    (( $#commands )) && _describe command commands\n"
         "    _files\n"
         "  fi\n"
         "}\n"
         "_hvas \"$@\"\n";
}

std::string MakeFishCompletion(const CommandHelp& root) {
  const auto commands = ListCommands(root);
  std::vector<std::string> names;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    names.push_back(QuotedForFish(commands[i]->name));
  }
  std::string text = fmt::format(
      "# fish completion for hvas, written by `hvas completion fish`\n"
      "function __hvas_is_at\n"
      "    set -l command hvas\n"
      "    for word in (commandline -opc)[2..-1]\n"
      "        if contains -- \"$command $word\" {}\n"
      "            set command \"$command $word\"\n"
      "        end\n"
      "    end\n"
      "    test \"$command\" = \"$argv\"\n"
      "end\n",
      fmt::join(names, " "));
  for (const CommandHelp* command : commands) {
    const std::string begin =
        fmt::format("complete -c hvas -n {}", QuotedForFish("__hvas_is_at " + command->name));
    for (const CommandHelp& below : command->commands) {
      text += fmt::format("{} -a {} -d {}\n", begin, below.LastName(),
                          QuotedForFish(Brief(below.description)));
    }
    for (const OptionHelp& option : command->options) {
      if (option.is_argument) {
        for (const std::string& choice : option.choices) {
          text += fmt::format("{} -a {}\n", begin, choice);
        }
        continue;
      }
      text += begin;
      for (const std::string& name : option.names) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.choices.empty()) {
        text += fmt::format(" -x -a {}",
                            QuotedForFish(fmt::format("{}", fmt::join(option.choices, " "))));
      } else if (IsNumber(option)) {
        text += " -x";
      } else if (IsFile(option)) {
        text += " -r";
      }
      text += fmt::format(" -d {}\n", QuotedForFish(Brief(option.description)));
    }
  }
  return text;
}

void AddCompletion(CLI::App* app, int* status) {
  using Make = std::string (*)(const CommandHelp&);
  const auto make = std::make_shared<Make>(nullptr);
  CLI::App* command =
      app->add_subcommand("completion", "Print a script that completes commands in a shell");
  AddChoice(
      command, "shell", make.get(),
      Choices<Make>{
          {"bash", MakeBashCompletion}, {"zsh", MakeZshCompletion}, {"fish", MakeFishCompletion}},
      "The shell")
      ->required();
  command->footer(
      "An installation contains the scripts in the folders that shells search. To install one by "
      "hand:\n"
      "  source <(hvas completion bash)\n"
      "  hvas completion zsh > ~/.zfunc/_hvas\n"
      "  hvas completion fish > ~/.config/fish/completions/hvas.fish");
  command->callback([app, make, status] {
    fmt::print("{}", (*make)(Describe(*app)));
    *status = 0;
  });
}

}  // namespace hvas::app
