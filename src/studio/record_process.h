#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "studio/json.h"
#include "studio/record_parts.h"

namespace hvas::studio {

/** Reads a part of a record in a process of its own, hvas-record, which may take at most 20 s and
 2 GiB of memory: whatever the file does to it, it does to no one else.
 Errors: those of ReadRecordPart(); kUnreadable where the process failed or was ended; kCancelled
 when a stop was asked for; kNotFound without hvas-record. */
[[nodiscard]] Result<std::string> ReadInProcess(const std::filesystem::path& file, RecordPart part,
                                                const std::stop_token& stop,
                                                const RecordLabels& labels = {});

/** Reads the summary of a record, which also has its "product_digest". Errors: as ReadInProcess().
 */
[[nodiscard]] Result<Json> ReadSummary(const std::filesystem::path& file,
                                       const std::stop_token& stop);

/** What hvas-record hands over: a part of a record, or the error. */
[[nodiscard]] std::string PackOutcome(const Result<std::string>& outcome);

}  // namespace hvas::studio
