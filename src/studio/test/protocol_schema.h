#pragma once

#include <set>
#include <string>
#include <vector>

#include "studio/workbench.h"

namespace hvas::studio::testing {

/** The JSON messages of src/studio/protocol.json, to hold what the server sends against them: every
 field has to be there, with its type, and no other. Each function @returns what is wrong, with the
 path of the field; empty: nothing. */
[[nodiscard]] std::string FindFault(const std::string& type, const Json& value);
[[nodiscard]] std::string FindEventFault(const Json& event);
/** @param result  Of the answer to a command that was obeyed. */
[[nodiscard]] std::string FindResultFault(const std::string& command, const Json& result);

/** A command of the schema, or an action of the command "study", with a value of the right type in
 each of its fields. */
struct CommandExample {
  std::string name;
  std::string right;
  Json message;                     ///< Has no id.
  std::vector<std::string> fields;  ///< Names of the fields that can be given.
};

/** One for each command, and for each action of a study. */
[[nodiscard]] std::vector<CommandExample> MakeCommandExamples();

/** Names of all events, or of all commands. */
[[nodiscard]] std::set<std::string> EventNames();
[[nodiscard]] std::set<std::string> CommandNames();

}  // namespace hvas::studio::testing
