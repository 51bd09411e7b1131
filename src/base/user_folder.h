#pragma once

#include <filesystem>
#include <optional>

namespace hvas {

/** This program's folder of one kind for the user who runs it, as the XDG Base Directory
 Specification has them: $VARIABLE/hvas, else ~/UNDER_HOME/hvas. None when there is no home. It may
 not be there yet.
 @param variable  "XDG_CACHE_HOME", "XDG_STATE_HOME" or "XDG_DATA_HOME". */
[[nodiscard]] std::optional<std::filesystem::path> FindUserFolder(const char* variable,
                                                                  const char* under_home);

}  // namespace hvas
