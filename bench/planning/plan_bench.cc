#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "fcl_check.h"
#include "ompl_peer.h"
#include "paths/check_way.h"
#include "puzzles.h"

namespace {

using namespace hvas;  // NOLINT: a program, not a header.

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

struct Tally {
  int solved{0}, runs{0}, colliding{0};
  std::vector<double> seconds, queries;
};

double MedianOf(std::vector<double> values) {
  if (values.empty()) {
    return 0;
  }
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Options {
  std::string folder;
  std::vector<std::string> names;
  int seeds{5};
  int first_seed{1};
  double limit{60};
  std::optional<double> tolerance;
  std::uint64_t budget{4'000'000};
  bool has_shortening{true};
  bool has_surfaces{true};
  double spacing{0};
  int peer_seeds{0};
  bench::PeerOptions peer;
};

void AddOptions(CLI::App* app, Options* o) {
  app->add_option("folder", o->folder, "folder with ompl/ and factory/")->required();
  app->add_option("problems", o->names,
                  "Twistycool, alpha-1.5, ..., nut:m16_tight, free:m16_tight, pair:FOLDER");
  app->add_flag("!--triangles", o->has_surfaces, "take the meshes of pairs as they are");
  app->add_option("--seeds", o->seeds, "seeds of each problem");
  app->add_option("--first-seed", o->first_seed, "the first of them");
  app->add_option("--limit", o->limit, "seconds of a run");
  app->add_option("--tolerance", o->tolerance, "penetration that is allowed [m]");
  app->add_option("--peer", o->peer_seeds, "seeds of OMPL's RRT-Connect with FCL, in the same run");
  app->add_option("--peer-resolution", o->peer.resolution,
                  "distance of the poses it checks, as a share of the space's extent")
      ->capture_default_str();
  app->add_option("--spacing", o->spacing, "of contact samples [m]; 0: as contact chooses");
  app->add_option("--budget", o->budget, "contact queries");
  app->add_flag("!--no-shortening", o->has_shortening, "leave ways as they are found");
}

Result<bench::Puzzle> Load(const Options& o, const std::string& name) {
  if (name.rfind("pair:", 0) == 0) {
    return bench::LoadPair(name.substr(5), o.has_surfaces, o.spacing);
  }
  const bool is_nut = name.rfind("nut:", 0) == 0;
  if (is_nut || name.rfind("free:", 0) == 0) {
    return bench::LoadNut(o.folder + "/factory", name.substr(name.find(':') + 1), is_nut,
                          o.spacing);
  }
  return bench::LoadPuzzle(fmt::format("{}/ompl/{}.cfg", o.folder, name), o.spacing);
}

Result<paths::WaySearch> Search(const Options& o, const paths::WayProblem& problem, int seed,
                                double* seconds) {
  paths::WayOptions options;
  options.seed = static_cast<std::uint64_t>(seed);
  options.budget = o.budget;
  options.has_to_improve = o.has_shortening;
  std::stop_source stop;
  options.stop = stop.get_token();
  const auto start = std::chrono::steady_clock::now();
  options.progress = [&](double) {
    if (Seconds(start) > o.limit) {
      stop.request_stop();
    }
  };
  auto found = paths::FindWay(problem, options);
  *seconds = Seconds(start);
  return found;
}

/** Checks a way that was found, and counts it. */
std::string Judge(const bench::Puzzle& puzzle, const paths::WayProblem& problem,
                  const paths::WaySearch& found, double seconds, Tally* tally) {
  ++tally->runs;
  if (!found.way) {
    return fmt::format("none, to go {:.2f} mm, {} stops", 1e3 * found.distance_to_go,
                       found.stops.size());
  }
  ++tally->solved;
  tally->seconds.push_back(seconds);
  tally->queries.push_back(static_cast<double>(found.queries));
  const double step = paths::CheckStepOf(problem.tolerance);
  const bench::FclFinding fcl = bench::CheckByFcl(puzzle, found.way->path, step / 10, 20000);
  tally->colliding += fcl.colliding > 0 ? 1 : 0;
  return fmt::format("{} {} poses, deepest {:.1f} um; FCL {} of {} samples collide",
                     paths::NameOf(found.way->method), found.way->path.size(),
                     1e6 * found.way->deepest, fcl.colliding, fcl.samples);
}

void RunOurs(const Options& o, const bench::Puzzle& puzzle) {
  contact::Scene scene;
  (void)scene.Add(puzzle.around_shape, spatial::Pose());
  paths::WayProblem problem;
  problem.scene = &scene;
  problem.part = puzzle.part_shape;
  problem.X_WB_start = puzzle.X_WB_start;
  problem.X_WB_goal = puzzle.X_WB_goal;
  problem.tolerance = o.tolerance.value_or(puzzle.tolerance);
  problem.axes = puzzle.axes;
  Tally tally;
  for (int seed = o.first_seed; seed < o.first_seed + o.seeds; ++seed) {
    double seconds = 0;
    const auto found = Search(o, problem, seed, &seconds);
    if (!found) {
      std::cerr << found.error().ToString() << "\n";
      break;
    }
    const std::string text = Judge(puzzle, problem, *found, seconds, &tally);
    std::cout << fmt::format("{} seed {}: {:.2f} s, {} queries ({:.1f} us each), {}\n", puzzle.name,
                             seed, seconds, found->queries,
                             1e6 * seconds / static_cast<double>(found->queries), text)
              << std::flush;
  }
  std::cout << fmt::format(
      "{:24s} {} of {} solved, median {:.2f} s, most {:.2f} s, {:.0f} queries\n", puzzle.name,
      tally.solved, tally.runs, MedianOf(tally.seconds),
      tally.seconds.empty() ? 0.0 : *std::max_element(tally.seconds.begin(), tally.seconds.end()),
      MedianOf(tally.queries));
}

void RunPeer(const Options& o, const bench::Puzzle& puzzle) {
  Tally peer;
  for (int seed = 1; seed <= o.peer_seeds && puzzle.X_WB_goal; ++seed) {
    bench::PeerOptions options = o.peer;
    options.seed = static_cast<std::uint32_t>(seed);
    options.limit_s = o.limit;
    const bench::PeerRun run = bench::SolveByOmpl(puzzle, options);
    ++peer.runs;
    peer.solved += run.is_solved ? 1 : 0;
    peer.seconds.push_back(run.seconds);  // Of a run that did not solve it, the limit.
    peer.queries.push_back(static_cast<double>(run.queries));
    std::string text = "none";
    if (run.is_solved) {
      const bench::FclFinding fcl = bench::CheckByFcl(puzzle, run.path, 5e-6, 20000);
      peer.colliding += fcl.colliding > 0 ? 1 : 0;
      text = fmt::format("{} poses, checked each {:.3f} mm; FCL {} of {} samples collide",
                         run.poses, 1e3 * run.check_step, fcl.colliding, fcl.samples);
    }
    std::cout << fmt::format("{} peer seed {}: {:.2f} s, {} queries, {}\n", puzzle.name, seed,
                             run.seconds, run.queries, text)
              << std::flush;
  }
  if (peer.runs > 0) {
    std::cout << fmt::format(
        "{:24s} peer {} of {} solved, {} of them through the mesh, median {:.2f} s, {:.0f} "
        "queries\n",
        puzzle.name, peer.solved, peer.runs, peer.colliding, MedianOf(peer.seconds),
        MedianOf(peer.queries));
  }
}

int Run(int argc, char** argv) {
  CLI::App app{"Planning of ways: puzzles of OMPL.app and nuts of Factory, ours and a peer"};
  Options options;
  AddOptions(&app, &options);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& name : options.names) {
    const auto puzzle = Load(options, name);
    if (!puzzle) {
      std::cerr << puzzle.error().ToString() << "\n";
      return 1;
    }
    RunOurs(options, *puzzle);
    RunPeer(options, *puzzle);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "plan_bench: " << error.what() << "\n";
    return 1;
  }
}
