#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace hvas::app {

/** Adds --json. @param schema  Of the document, in data/schemas; several with "or" between. */
inline CLI::Option* AddJsonFlag(CLI::App* command, bool* is_json, const std::string& schema) {
  return command->add_flag("--json", *is_json,
                           "Print one JSON document; schema: " + schema + ".schema.json has it");
}

}  // namespace hvas::app
