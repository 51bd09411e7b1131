#pragma once

#include <filesystem>
#include <memory>

#include "base/diagnostics.h"
#include "base/result.h"
#include "record/reader.h"
#include "simulation/model.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** What every command that opens a record asks for. */
struct RecordOptions {
  std::filesystem::path file;
  bool is_quiet{false};      ///< No progress on stderr.
  bool is_cache_used{true};  ///< Keeps and takes what was prepared on disk.
};

/** Adds the file, --quiet and --no-cache to a command. */
void AddRecordOptions(CLI::App* command, RecordOptions* options);

/** The model of an open record, prepared with progress; warnings are told on stderr. */
[[nodiscard]] Result<std::shared_ptr<const simulation::Model>> PrepareModel(
    record::Reader* reader, const RecordOptions& options);

}  // namespace hvas::app
