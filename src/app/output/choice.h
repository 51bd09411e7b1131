#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace hvas::app {

/** Words of the command line, and what each stands for. */
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

/** Adds an option that takes one of some words, in capitals or not.
 @param target  Of T, or optional; outlives the command. */
template <typename T, typename Target>
CLI::Option* AddChoice(CLI::App* command, const std::string& name, Target* target,
                       const Choices<T>& choices, const std::string& help) {
  std::vector<std::string> words(choices.size());
  std::transform(choices.begin(), choices.end(), words.begin(),
                 [](const auto& choice) { return choice.first; });
  const auto take = [target, choices](const std::string& word) {
    for (const auto& [spelling, value] : choices) {
      if (word == spelling) {
        *target = value;
      }
    }
  };
  return command->add_option_function<std::string>(name, take, help)
      ->transform(CLI::IsMember(words, CLI::ignore_case));  // to the word as it is spelt here
}

}  // namespace hvas::app
