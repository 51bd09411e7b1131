// Kills recording sessions at random moments, and tells what is left: does every record open, how
// much does it lack, and does it run again bit for bit up to there? Exit status 1 when one does
// not.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/random.h"
#include "base/scratch_folder.h"
#include "load_model.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/replay.h"
#include "session/test/killed_session.h"

namespace hvas {
namespace {

struct Tally {
  int killed{0};
  int before_record{0};  ///< Killed before there was anything to read.
  int bad{0};
  std::int64_t most_lost_ticks{0};
  std::int64_t replayed_ticks{0};
};

/** Empty: the record is as it should be. */
std::string Judge(const std::filesystem::path& file, std::int64_t ran,
                  const assembly::PrepareOptions& options, Tally* tally) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    if (ran == 0) {
      ++tally->before_record;
      return {};
    }
    return reader.error().ToString();
  }
  if (const auto verified = reader->Verify(); !verified) {
    return verified.error().ToString();
  }
  const std::int64_t lost = ran - reader->tick_count();
  tally->most_lost_ticks = std::max(tally->most_lost_ticks, lost);
  if (lost > 1000) {
    return fmt::format("{} ticks are lost", lost);
  }
  if (reader->tick_count() == 0) {
    return {};
  }
  Diagnostics diagnostics;
  const auto model =
      session::LoadModel(&*reader, assembly::MakeCompileOptions(options), &diagnostics);
  if (!model) {
    return model.error().ToString();
  }
  const auto report = session::Replay(&*reader, *model, {});
  if (!report) {
    return report.error().ToString();
  }
  tally->replayed_ticks += report->ticks;
  return report->is_exact() && report->ticks == reader->tick_count()
             ? std::string()
             : fmt::format("{} of {} ticks differ", report->different_ticks, report->ticks);
}

int Run(const std::string& file, int runs, double longest_s, std::uint64_t seed) {
  auto folder = ScratchFolder::Make();
  if (!folder) {
    fmt::print(stderr, "{}\n", folder.error().ToString());
    return 1;
  }
  assembly::PrepareOptions options;
  options.shape_cache = assembly::MakeShapeCache(folder->path() / "shapes");
  const auto model = bench::LoadModel(file, options);
  if (!model) {
    fmt::print(stderr, "{}\n", model.error().ToString());
    return 1;
  }
  Random random(seed);
  Tally tally;
  for (int i = 0; i < runs; ++i) {
    const auto path = folder->path() / fmt::format("{}.hvasrec", i);
    const auto after = std::chrono::milliseconds(std::llround(1e3 * random.Uniform(0, longest_s)));
    const bool is_realtime = i % 2 == 0;
    const std::int64_t ran = session::testing::RecordAndKill(*model, path, is_realtime, after);
    tally.killed += ran >= 0 ? 1 : 0;
    const std::string problem = ran < 0 ? "it ended by itself" : Judge(path, ran, options, &tally);
    if (!problem.empty()) {
      ++tally.bad;
      fmt::print("run {} ({}, killed after {} ms, {} ticks): {}\n", i,
                 is_realtime ? "real time" : "virtual time", after.count(), ran, problem);
    }
    for (const char* suffix : {"", "-wal", "-shm"}) {
      std::error_code ignored;
      std::filesystem::remove(path.string() + suffix, ignored);
    }
  }
  fmt::print(
      "{} killed, {} of them before there was a record; {} bad; most lost: {:.3f} s; {} ticks run "
      "again\n",
      tally.killed, tally.before_record, tally.bad,
      1e-3 * static_cast<double>(tally.most_lost_ticks), tally.replayed_ticks);
  return tally.bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hvas

int main(int argc, char** argv) {
  CLI::App app("Kills recording sessions at random moments and replays what is left");
  std::string file;
  int runs = 200;
  double longest_s = 3;
  std::uint64_t seed = 1;
  app.add_option("file", file, "CAD file of the product")->required();
  app.add_option("--runs", runs, "Sessions, every other one in real time")->capture_default_str();
  app.add_option("--longest", longest_s, "Kill within so long [s]")->capture_default_str();
  app.add_option("--seed", seed, "Of the moments")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return hvas::Run(file, runs, longest_s, seed);
}
