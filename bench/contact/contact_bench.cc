/** How long contact queries take, and how exact they are: ours and others on the same poses in one
 run. Times are processor time of the thread; of each pose, the least over a few passes. */
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy.h"
#include "speed.h"

namespace hvas::bench {
namespace {

struct Options {
  int poses{kTrackPoses};
  std::vector<std::size_t> scenes{10, 100, 500, 5000};
  std::vector<std::string> methods;
  std::vector<std::string> tracks;
  std::string json;
  bool is_speed_wanted{true};
  bool is_accuracy_wanted{true};
};

constexpr const char* kExamples =
    "Examples:\n"
    "  contact_bench --methods ours --no-accuracy   times of our queries alone\n"
    "  contact_bench --scenes 500 --json out.json   everything, in one scene\n"
    "  contact_bench --tracks T1 --poses 400        fewer poses of one track\n"
    "Methods: ours, ours-scalar, fcl-bool-5k (yes or no), fcl-20-5k (at most 20 contacts of a "
    "pair),\n"
    "fcl-5k, fcl-50k, gimpact-5k, gimpact-50k, cells-5k (the 3 x 3 x 3 cells of Xia et al. 2011).\n"
    "The slow ones are asked fewer poses; each row says how many.\n";

bool IsWanted(const std::vector<std::string>& list, const std::string& name) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

/** Meshes of the parts for methods on triangles, made when first asked for. */
class PeerMeshes {
 public:
  PeerMeshes(const std::vector<BenchPart>* parts, double deflection, std::size_t at_least)
      : parts_(parts), deflection_(deflection), at_least_(at_least) {}

  const PeerMesh& Get(std::size_t part) {
    const auto found = meshes_.find(part);
    if (found != meshes_.end()) {
      return found->second;
    }
    const auto source = MeshSolid((*parts_)[part].solid, deflection_);
    PeerMesh mesh = source ? MakePeerMesh(*source, at_least_) : PeerMesh();
    std::cerr << fmt::format("  {} at {} um: {} triangles\n", (*parts_)[part].name,
                             1e6 * deflection_, mesh.triangles.size());
    return meshes_.emplace(part, std::move(mesh)).first->second;
  }

  [[nodiscard]] MeshOf of() {
    return [this](std::size_t part) -> const PeerMesh& { return Get(part); };
  }

 private:
  const std::vector<BenchPart>* parts_;
  double deflection_;
  std::size_t at_least_;
  std::map<std::size_t, PeerMesh> meshes_;
};

constexpr std::size_t kAllContacts = 1'000'000;

std::vector<Entrant> MakeEntrants(const std::vector<BenchPart>& parts, PeerMeshes* coarse,
                                  PeerMeshes* fine) {
  const auto peer = [](const char* name, int poses, int passes, auto make, PeerMeshes* meshes) {
    return Entrant{name, poses, passes, [=] { return make(meshes->of()); }};
  };
  const auto fcl = [](std::size_t max_contacts) {
    return [=](MeshOf mesh_of) { return MakeFcl(std::move(mesh_of), max_contacts); };
  };
  return {{"ours", kTrackPoses, 5, [&] { return MakeOurs(&parts, false); }},
          {"ours-scalar", kTrackPoses, 3, [&] { return MakeOurs(&parts, true); }},
          peer("fcl-bool-5k", 200, 2, fcl(0), coarse),
          peer("fcl-20-5k", 200, 2, fcl(20), coarse),
          peer("fcl-5k", 100, 2, fcl(kAllContacts), coarse),
          peer("fcl-50k", 50, 1, fcl(kAllContacts), fine),
          peer("gimpact-5k", 200, 2, MakeGImpact, coarse),
          peer("gimpact-50k", 50, 1, MakeGImpact, fine),
          peer("cells-5k", 50, 1, MakeCellScheme, coarse)};
}

std::vector<AccuracyEntrant> MakeAccuracyEntrants() {
  const auto ours = [](const std::vector<BenchPart>* parts, const MeshOf&) {
    return MakeOurs(parts, false);
  };
  const auto fcl = [](const std::vector<BenchPart>*, MeshOf mesh_of) {
    return MakeFcl(std::move(mesh_of), kAllContacts);
  };
  const auto gimpact = [](const std::vector<BenchPart>*, MeshOf mesh_of) {
    return MakeGImpact(std::move(mesh_of));
  };
  const auto cells = [](const std::vector<BenchPart>*, MeshOf mesh_of) {
    return MakeCellScheme(std::move(mesh_of));
  };
  constexpr double kCoarse = 50e-6, kFine = 1e-6;
  return {{"ours", kFine, 0, 1000, ours},
          {"fcl-5k", kCoarse, 5000, 20, fcl},
          {"fcl-50k", kFine, 50000, 10, fcl},
          {"gimpact-5k", kCoarse, 5000, 50, gimpact},
          {"gimpact-50k", kFine, 50000, 10, gimpact},
          {"cells-5k", kCoarse, 5000, 20, cells}};
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

template <typename Entry>
std::vector<Entry> Wanted(const std::vector<Entry>& all, const std::vector<std::string>& names) {
  std::vector<Entry> wanted;
  std::copy_if(all.begin(), all.end(), std::back_inserter(wanted),
               [&](const Entry& entry) { return IsWanted(names, entry.name); });
  return wanted;
}

bool RunSpeed(const Options& options, nlohmann::json* out) {
  std::vector<Track> tracks;
  std::set<std::size_t> needed;
  for (Track& track : MakeTracks()) {
    if (IsWanted(options.tracks, track.name)) {
      needed.merge(ListParts(track));
      tracks.push_back(std::move(track));
    }
  }
  std::cerr << "drawing, meshing and building the parts\n";
  const auto parts = MakeParts(needed);
  if (!parts) {
    std::cerr << parts.error().ToString() << '\n';
    return false;
  }
  PeerMeshes coarse(&*parts, 50e-6, 5000);
  PeerMeshes fine(&*parts, 5e-6, 50000);
  std::vector<Entrant> entrants = Wanted(MakeEntrants(*parts, &coarse, &fine), options.methods);
  for (Entrant& entrant : entrants) {
    entrant.poses = std::min(entrant.poses, options.poses);
  }
  PrintHead();
  for (const Track& track : tracks) {
    for (const std::size_t count : options.scenes) {
      std::cerr << fmt::format("{} {} ({} parts)\n", track.name, track.description, count);
      for (const SpeedRow& row : RunTrack(track, MakeScene(track, *parts, count), entrants)) {
        PrintRow(row);
        out->push_back(ToJson(row));
      }
    }
  }
  return true;
}

nlohmann::json ToJson(const AccuracyRow& row) {
  return {{"test", row.test},
          {"method", row.method},
          {"poses", row.poses},
          {"depth_error_mean_um", 1e6 * row.depth_error_mean},
          {"depth_error_max_um", 1e6 * row.depth_error_max},
          {"pooled_change_mn_per_ms", 1e3 * row.force_change}};
}

void RunAccuracyTests(const Options& options, nlohmann::json* out) {
  const auto rows = RunAccuracy(Wanted(MakeAccuracyEntrants(), options.methods));
  fmt::print("\n{:7s} {:12s} {:>5s} {:>14s} {:>14s} {:>14s}\n", "test", "method", "poses",
             "depth_mean_um", "depth_max_um", "force_mn_ms");
  for (const AccuracyRow& row : rows) {
    fmt::print("{:7s} {:12s} {:5d} {:14.4f} {:14.4f} {:14.4f}\n", row.test, row.method, row.poses,
               1e6 * row.depth_error_mean, 1e6 * row.depth_error_max, 1e3 * row.force_change);
    out->push_back(ToJson(row));
  }
}

int Run(const Options& options) {
  nlohmann::json out = {{"speed", nlohmann::json::array()}, {"accuracy", nlohmann::json::array()}};
  if (options.is_speed_wanted && !RunSpeed(options, &out["speed"])) {
    return 1;
  }
  if (options.is_accuracy_wanted) {
    RunAccuracyTests(options, &out["accuracy"]);
  }
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << out.dump(1) << '\n';
    if (!file.flush()) {
      std::cerr << options.json << ": could not be written\n";
      return 1;
    }
  }
  return 0;
}

int Main(int argc, char** argv) {
  CLI::App app("Times of contact queries on three tracks: ours, and others on the same poses");
  app.footer(kExamples);
  Options options;
  app.add_option("--poses", options.poses, "at most so many poses of each track")
      ->check(CLI::Range(1, kTrackPoses));
  app.add_option("--scenes", options.scenes, "numbers of parts")->delimiter(',');
  const std::vector<std::string> methods{"ours",       "ours-scalar", "fcl-bool-5k",
                                         "fcl-20-5k",  "fcl-5k",      "fcl-50k",
                                         "gimpact-5k", "gimpact-50k", "cells-5k"};
  app.add_option("--methods", options.methods, "the first asked is what others are compared with")
      ->delimiter(',')
      ->check(CLI::IsMember(methods));
  app.add_option("--tracks", options.tracks, "of T1, T2, T3")
      ->delimiter(',')
      ->check(CLI::IsMember({"T1", "T2", "T3"}));
  app.add_flag("!--no-speed", options.is_speed_wanted, "leave the times out");
  app.add_flag("!--no-accuracy", options.is_accuracy_wanted, "leave the tests of accuracy out");
  app.add_option("--json", options.json, "file for the rows");
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

}  // namespace
}  // namespace hvas::bench

int main(int argc, char** argv) {
  return hvas::bench::Main(argc, argv);
}
