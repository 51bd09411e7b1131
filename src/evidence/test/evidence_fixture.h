#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "person/simulated_person.h"
#include "record/recorder.h"
#include "session/recorded_model.h"
#include "session/session_recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/test/small_models.h"

namespace hvas::evidence::testing {

inline std::string ReadAll(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/** A number of a file, little-endian. */
template <typename T>
[[nodiscard]] T NumberAt(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(value) <= bytes.size()) {
    std::memcpy(&value, bytes.data() + at, sizeof(value));
  }
  return value;
}

/** A peg that is put into its block, recorded once for all tests here. */
class EvidenceTest : public ::testing::Test {
 public:
  static void SetUpTestSuite() {
    folder = std::make_unique<hvas::testing::TemporaryFolder>();
    const auto& model = simulation::testing::PegInBlockModel();
    record::RecorderOptions options;
    options.path = *folder / "session";
    const auto recorder = record::Recorder::Create(options, session::MakeModelMeta(*model));
    session::SessionRecorder sink(recorder->get(), *model);
    simulation::Simulation simulation(model, haptics::TickOptions());
    person::SimulatedPerson person({}, 1, simulation::StartOfHand(*model));
    simulation::AssemblyRun run(&simulation, &person, &sink);
    sink.Begin(&simulation);
    (void)RunLockstep(run.MakeExecution(&person, 60));
    (*recorder)->AddEvent({1'000'000'000, "safety", 1, R"({"hand":0,"reasons":["limited"]})"});
    ASSERT_TRUE((*recorder)->Finish().has_value());
  }

  static void TearDownTestSuite() { folder.reset(); }

  record::Reader reader = *record::Reader::Open(*folder / "session");
  const std::vector<record::TickRecord> ticks = *reader.ReadTicks({});
  hvas::testing::TemporaryFolder out;

 private:
  static inline std::unique_ptr<hvas::testing::TemporaryFolder> folder;
};

}  // namespace hvas::evidence::testing
