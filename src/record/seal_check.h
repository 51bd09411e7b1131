#pragma once

#include <filesystem>

#include "base/result.h"
#include "record/database.h"

namespace hvas::record {

/** Compares the rows of a record of schema 4 or newer with its seals: that none was lost, added,
 changed or moved. The content of a row is told apart by its checksum only; whoever reads it checks
 that.
 Errors: kUnreadable, naming the first thing that is not as it was written. */
[[nodiscard]] Result<void> CheckSeals(Database* database, const std::filesystem::path& path);

}  // namespace hvas::record
