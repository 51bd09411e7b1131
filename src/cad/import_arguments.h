#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad/import.h"

namespace hvas::cad {

/** Options as words of a command line, for the process that reads files. */
[[nodiscard]] std::vector<std::string> MakeArguments(const ImportOptions& options);

/** The options that words stand for; nothing where one of them is unknown or damaged. */
[[nodiscard]] std::optional<ImportOptions> ParseArguments(std::span<const std::string> words);

}  // namespace hvas::cad
