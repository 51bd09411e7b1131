#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/assembly/run_report.h"
#include "app/product/load_product.h"
#include "assembly/run_assembly.h"
#include "base/result.h"
#include "orders/gap_reason.h"
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

/** Adds --reasons to a command: how long it looks into why parts have no way in [s]. */
void AddReasonsOption(CLI::App* command, double* reasons_s);

/** Explains why parts of a model have no way in, with progress.
 @param time_s  For all of them [s]; 0: none is looked into. */
[[nodiscard]] std::vector<orders::GapReason> ExplainLeftOut(const simulation::Model& model,
                                                            double time_s, bool is_quiet,
                                                            const std::stop_token& stop);

/** Words in which the progress of a run is told. */
struct TurnWords {
  const char* run;     ///< "assembly".
  const char* done;    ///< "in place".
  const char* failed;  ///< "NOT IN PLACE: ".
  bool (*is_done)(const simulation::PartResult& part);
};

/** How far a preparation has come. */
struct PreparationProgress {
  std::int64_t start_ns{0};        ///< When it began, on the monotonic clock.
  std::string stage;               ///< The last one that was reported; empty: none was.
  double fraction{0};              ///< The share of this stage that is done, from 0 to 1.
  std::vector<std::string> parts;  ///< Paths of the occurrences, once the product is read.
};

/** What the user wishes of the order of assembly. */
struct OrderChoice {
  std::vector<std::string> first_parts;  ///< PrepareOptions::first_parts.
  std::string base;                      ///< PrepareOptions::base.
  bool is_thorough{false};               ///< PrepareOptions::is_thorough.
  std::filesystem::path plan;            ///< A plan of `hvas plan`; empty: none.
};

/** Whether progress is shown. */
[[nodiscard]] bool IsShown(const RunCommandOptions& options);

/** Checks that the record can be written, opens the file and prepares its model.
 @param stop  Ends the preparation: kCancelled.
 @param progress  Says how far it came, also after an error. */
[[nodiscard]] Result<std::shared_ptr<const simulation::Model>> PrepareRun(
    const RunCommandOptions& options, const OrderChoice& order, const std::stop_token& stop,
    PreparationProgress* progress);

/** Reports a preparation that failed; with --json, where it was stopped or reached a limit, also
 how far it came (preparation.schema.json). @returns the exit status for it. */
int ReportUnprepared(const RunCommandOptions& options, const PreparationProgress& progress,
                     const Error& error);

/** Makes the options of the run, with callbacks that print its progress. */
[[nodiscard]] assembly::RunOptions MakeRunOptions(
    const RunCommandOptions& options, const std::shared_ptr<const simulation::Model>& model,
    const TurnWords& words);

[[nodiscard]] SessionReport MakeSessionReport(const RunCommandOptions& options,
                                              assembly::RunOutcome outcome,
                                              std::int64_t preparation_ns);

/** Adds --base and --thorough to a command. */
void AddOrderChoice(CLI::App* command, OrderChoice* order);

/** Adds --seed, --fit, --condition, --force-map and --device to a command. */
void AddFitAndDeviceOptions(CLI::App* command, RunCommandOptions* options);

/** Adds --scale, --rate, --realtime, --record, --force and --limit to a command. */
void AddRunOptions(CLI::App* command, RunCommandOptions* options);

}  // namespace hvas::app
