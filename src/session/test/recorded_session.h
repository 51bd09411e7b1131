#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "person/simulated_person.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/replay.h"
#include "session/session_recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/test/small_models.h"

namespace hvas::session::testing {

inline std::unique_ptr<record::Recorder> MakeRecorder(const std::filesystem::path& path,
                                                      bool is_threaded = false) {
  record::RecorderOptions options;
  options.path = path;
  options.is_threaded = is_threaded;
  auto recorder = record::Recorder::Create(options, {});
  EXPECT_TRUE(recorder.has_value()) << recorder.error().ToString();
  return std::move(*recorder);
}

/** A stretch with a simulated person in each hand. */
struct Stretch {
  explicit Stretch(const std::shared_ptr<const simulation::Model>& model, std::size_t hands,
                   simulation::Sink* sink, const haptics::TickOptions& options = {})
      : simulation(hands == 1 ? std::make_unique<simulation::Simulation>(model, options)
                              : std::make_unique<simulation::Simulation>(
                                    model, std::vector{options, options})),
        first({}, 1, simulation::StartOfHand(*model)),
        second({}, 2, simulation::StartOfHand(*model)),
        run(simulation.get(), simulation::TaskOperators{&first, hands == 2 ? &second : nullptr},
            sink) {}

  [[nodiscard]] simulation::Execution MakeExecution(double limit_s) {
    return run.MakeExecution({&first, simulation->hand_count() == 2 ? &second : nullptr}, limit_s);
  }

  std::unique_ptr<simulation::Simulation> simulation;
  person::SimulatedPerson first;
  person::SimulatedPerson second;
  simulation::AssemblyRun run;
};

/** Reads it from the file alone. */
inline Result<ReplayReport> ReplayFile(const std::filesystem::path& path,
                                       const ReplayOptions& options = {}) {
  auto reader = record::Reader::Open(path);
  if (!reader) {
    return Unexpected(reader.error());
  }
  Diagnostics diagnostics;
  const auto model = LoadModel(&*reader, simulation::testing::FastOptions(), &diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 0);
  return Replay(&*reader, *model, options);
}

}  // namespace hvas::session::testing
