#include "app/recording/record_options.h"

#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/progress.h"
#include "assembly/prepare_model.h"
#include "base/file_cache.h"
#include "session/recorded_model.h"

namespace hvas::app {

void AddRecordOptions(CLI::App* command, RecordOptions* options) {
  command->add_option("file", options->file, "A record of `hvas assemble --record` or the studio")
      ->required();
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->add_flag("!--no-cache", options->is_cache_used,
                    "Do not use the caches on disk: prepare everything again");
}

Result<std::shared_ptr<const simulation::Model>> PrepareModel(record::Reader* reader,
                                                              const RecordOptions& options) {
  assembly::PrepareOptions prepare;
  if (options.is_cache_used) {
    prepare.shape_cache = assembly::MakeShapeCache(FileCache::DefaultDirectory());
  }
  if (!options.is_quiet && IsWatched()) {
    prepare.progress = ShowProgress;
  }
  Diagnostics diagnostics;
  auto model = session::LoadModel(reader, assembly::MakeCompileOptions(prepare), &diagnostics);
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "model-differs" || item.code == "shape-cache") {
      fmt::print(stderr, "hvas: {}: {} ({})\n", item.entity, item.message, item.remedy);
    }
  }
  return model;
}

}  // namespace hvas::app
