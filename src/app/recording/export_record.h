#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/result.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** What of a record is written. */
struct RecordSelection {
  double from_s{-1e9};
  double to_s{1e9};
  std::int64_t every{1};
  bool is_demonstrations{false};  ///< Holds of parts as demonstrations, in an HDF5 file.
};

/** Adds --from, --to and --every to a command. */
void AddRecordSelection(CLI::App* command, RecordSelection* selection);

/** Whether a file is a database as records are, by its first bytes. */
[[nodiscard]] bool IsRecord(const std::filesystem::path& file);

/** The endings that ExportRecord() knows, for people. */
inline constexpr const char* kRecordFormats = ".csv, .json, .h5, .mcap or .glb";

/** Whether an ending is that of an HDF5 file. */
[[nodiscard]] bool IsHdf5(const std::string& ending);

[[nodiscard]] bool IsRecordFormat(const std::string& ending);

/** Writes a record by the ending of the output, one of the above. Errors: the reader's and the
 writer's.
 @returns What of the record is not as it was written; empty: nothing. */
[[nodiscard]] Result<std::string> ExportRecord(const std::filesystem::path& file,
                                               const std::filesystem::path& output,
                                               const std::string& ending,
                                               const RecordSelection& selection);

}  // namespace hvas::app
