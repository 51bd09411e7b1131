#include "base/user_folder.h"

#include <cstdlib>

namespace hvas {
namespace {

/** What an environment variable names; only absolute paths count, as the specification says. */
std::optional<std::filesystem::path> AbsolutePathIn(const char* variable) {
  const char* value = std::getenv(variable);
  const std::filesystem::path path(value == nullptr ? "" : value);
  return path.is_absolute() ? std::optional(path) : std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> FindUserFolder(const char* variable, const char* under_home) {
  if (const auto folder = AbsolutePathIn(variable)) {
    return *folder / "hvas";
  }
  const auto home = AbsolutePathIn("HOME");
  return home ? std::optional(*home / under_home / "hvas") : std::nullopt;
}

}  // namespace hvas
