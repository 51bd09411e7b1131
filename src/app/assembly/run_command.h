#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/assembly/run_report.h"
#include "app/product/load_product.h"
#include "assembly/run_assembly.h"
#include "base/result.h"
#include "simulation/model.h"

namespace CLI {
class App;
}

namespace hvas::app {

/** Options of a command that runs hands on a product. */
struct RunCommandOptions {
  LoadOptions load;
  fits::PairChoice pairs{fits::PairChoice::kOfKind};
  std::string device;        ///< Address of the device in the hand; empty: none.
  assembly::RunOptions run;  ///< All but the devices and the callbacks.
  bool is_json{false};
};

/** Words in which the progress of a run is told. */
struct TurnWords {
  const char* run;     ///< "assembly".
  const char* done;    ///< "in place".
  const char* failed;  ///< "NOT IN PLACE: ".
  bool (*is_done)(const simulation::PartResult& part);
};

/** A model that is ready for a run. */
struct PreparedRun {
  std::shared_ptr<const simulation::Model> model;
  std::int64_t start_ns{0};  ///< When its preparation began, on the monotonic clock.
};

/** Whether progress is shown. */
[[nodiscard]] bool IsShown(const RunCommandOptions& options);

/** Checks that the record can be written, opens the file and prepares its model.
 @param first_parts  As in assembly::PrepareOptions. */
[[nodiscard]] Result<PreparedRun> PrepareRun(const RunCommandOptions& options,
                                             const std::vector<std::string>& first_parts);

/** Makes the options of the run, with callbacks that print its progress. */
[[nodiscard]] assembly::RunOptions MakeRunOptions(
    const RunCommandOptions& options, const std::shared_ptr<const simulation::Model>& model,
    const TurnWords& words);

[[nodiscard]] SessionReport MakeSessionReport(const RunCommandOptions& options,
                                              assembly::RunOutcome outcome,
                                              std::int64_t preparation_ns);

/** Adds --seed, --fit, --condition, --force-map and --device to a command. */
void AddFitAndDeviceOptions(CLI::App* command, RunCommandOptions* options);

/** Adds --scale, --rate, --realtime, --record, --force and --limit to a command. */
void AddRunOptions(CLI::App* command, RunCommandOptions* options);

}  // namespace hvas::app
