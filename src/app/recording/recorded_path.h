#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/result.h"
#include "paths/path.h"
#include "product/product.h"

namespace hvas::app {

/** Where a part was, and when. */
struct TimedPath {
  paths::Path X_WB;
  std::vector<std::int64_t> t_ns;  ///< Session time of each pose; empty where it has none.
};

/** The way of a part while a hand held it, from a record of `hvas assemble --record`.
 @param hold  Which time that it was held, from 1; 0: the last one.
 Errors: those of record::Reader; kInvalid when the record is of another product; kNotFound when the
 part was not held so often. */
[[nodiscard]] Result<TimedPath> ReadRecordedPath(const std::filesystem::path& record,
                                                 const product::Product& product,
                                                 product::OccurrenceId id, std::size_t hold);

}  // namespace hvas::app
