/** How long contact queries take, and how exact they are: ours and others on the same poses in one
 run. Times are processor time of the thread; of each pose, the least over a few passes. */
#include <algorithm>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "speed.h"

namespace {

using namespace hvas::bench;  // NOLINT: a program of its own.

struct Options {
  int poses{kTrackPoses};
  std::vector<std::size_t> scenes{10, 100, 500, 5000};
  std::vector<std::string> methods;
  std::vector<std::string> tracks;
  std::string json;
};

constexpr const char* kExamples =
    "Examples:\n"
    "  contact_bench --methods ours                 our queries alone\n"
    "  contact_bench --scenes 500 --json out.json   everything, in one scene\n"
    "  contact_bench --tracks T1 --poses 400        fewer poses of one track\n";

bool IsWanted(const std::vector<std::string>& list, const std::string& name) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

std::vector<Entrant> MakeEntrants(const std::vector<BenchPart>& parts) {
  return {{"ours", "distance fields, exact faces; AVX2", kTrackPoses, 5,
           [&] { return MakeOurs(&parts, false); }},
          {"ours-scalar", "the same without vector instructions", kTrackPoses, 3,
           [&] { return MakeOurs(&parts, true); }}};
}

void PrintHead() {
  fmt::print(
      "{:3s} {:>5s} {:13s}{:>5s} {:>2s} {:>9s} {:>9s} {:>9s} {:>8s} {:>8s} {:>5s} {:>9s} {:>9s} "
      "{:>8s} {:>8s}\n",
      "", "parts", "method", "poses", "n", "median_us", "p99_us", "max_us", "ratio", "contacts",
      "% hit", "depth_um", "max_um", "points", "found");
}

void PrintRow(const SpeedRow& row) {
  fmt::print(
      "{:3s} {:5d} {:13s}{:5d} {:2d} {:9.1f} {:9.1f} {:9.1f} {:8.2f} {:8.1f} {:5.0f} {:9.1f} "
      "{:9.1f} "
      "{:8.0f} {:8.0f}\n",
      row.track, row.scene, row.method, row.poses, row.passes, 1e6 * row.time.median,
      1e6 * row.time.p99, 1e6 * row.time.max, row.ratio, row.contacts, 100 * row.touching,
      1e6 * row.depth.median, 1e6 * row.depth.max, row.points.median, row.candidates.median);
  std::cout.flush();
}

nlohmann::json ToJson(const Spread& spread, double scale = 1) {
  return {
      {"median", scale * spread.median}, {"p99", scale * spread.p99}, {"max", scale * spread.max}};
}

nlohmann::json ToJson(const SpeedRow& row) {
  return {{"track", row.track},
          {"parts", row.scene},
          {"method", row.method},
          {"poses", row.poses},
          {"passes", row.passes},
          {"time_us", ToJson(row.time, 1e6)},
          {"ratio", row.ratio},
          {"contacts_mean", row.contacts},
          {"touching", row.touching},
          {"depth_um", ToJson(row.depth, 1e6)},
          {"points_tested", ToJson(row.points)},
          {"candidates", ToJson(row.candidates)},
          {"bodies_tested", ToJson(row.bodies)}};
}

int Run(const Options& options) {
  std::cerr << "drawing, meshing and building the parts\n";
  std::vector<Track> tracks;
  std::set<std::size_t> needed;
  for (Track& track : MakeTracks()) {
    if (IsWanted(options.tracks, track.name)) {
      needed.merge(ListParts(track));
      tracks.push_back(std::move(track));
    }
  }
  const auto parts = MakeParts(needed);
  if (!parts) {
    std::cerr << parts.error().ToString() << '\n';
    return 1;
  }
  std::vector<Entrant> entrants;
  for (Entrant& entrant : MakeEntrants(*parts)) {
    if (IsWanted(options.methods, entrant.name)) {
      entrant.poses = std::min(entrant.poses, options.poses);
      entrants.push_back(std::move(entrant));
    }
  }
  nlohmann::json out = nlohmann::json::array();
  PrintHead();
  for (const Track& track : tracks) {
    for (const std::size_t count : options.scenes) {
      std::cerr << fmt::format("{} {} ({} parts)\n", track.name, track.description, count);
      for (const SpeedRow& row : RunTrack(track, MakeScene(track, *parts, count), entrants)) {
        PrintRow(row);
        out.push_back(ToJson(row));
      }
    }
  }
  if (!options.json.empty()) {
    std::ofstream(options.json) << out.dump(1) << '\n';
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times of contact queries on three tracks: ours, and others on the same poses");
  app.footer(kExamples);
  Options options;
  app.add_option("--poses", options.poses, "at most so many poses of each track")
      ->check(CLI::Range(1, kTrackPoses));
  app.add_option("--scenes", options.scenes, "numbers of parts")->delimiter(',');
  app.add_option("--methods", options.methods, "the first is what others are compared with")
      ->delimiter(',');
  app.add_option("--tracks", options.tracks, "of T1, T2, T3")->delimiter(',');
  app.add_option("--json", options.json, "file for the rows");
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}
