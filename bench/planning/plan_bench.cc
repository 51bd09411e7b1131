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
#include "planning/check_way.h"
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

int Run(int argc, char** argv) {
  CLI::App app{"Planning of ways: puzzles of OMPL.app and nuts of Factory, ours and a peer"};
  std::string folder;
  std::vector<std::string> names;
  int seeds = 5;
  int first_seed = 1;
  double limit = 60;
  std::optional<double> tolerance;
  std::uint64_t budget = 4'000'000;
  bool has_shortening = true;
  double spacing = 0;
  int peer_seeds = 0;
  bench::PeerOptions peer_options;
  app.add_option("folder", folder, "folder with ompl/ and factory/")->required();
  app.add_option("problems", names,
                 "Twistycool, alpha-1.5, ..., nut:m16_tight, free:m16_tight, pair:FOLDER");
  bool has_surfaces = true;
  app.add_flag("!--triangles", has_surfaces, "take the meshes of pairs as they are");
  app.add_option("--seeds", seeds, "seeds of each problem");
  app.add_option("--first-seed", first_seed, "the first of them");
  app.add_option("--limit", limit, "seconds of a run");
  app.add_option("--tolerance", tolerance, "penetration that is allowed [m]");
  app.add_option("--peer", peer_seeds, "seeds of OMPL's RRT-Connect with FCL, in the same run");
  app.add_option("--peer-resolution", peer_options.resolution,
                 "distance of the poses it checks, as a share of the space's extent")
      ->capture_default_str();
  app.add_option("--spacing", spacing, "of contact samples [m]; 0: as contact chooses");
  app.add_option("--budget", budget, "contact queries");
  app.add_flag("!--no-shortening", has_shortening, "leave ways as they are found");
  CLI11_PARSE(app, argc, argv);
  for (const std::string& name : names) {
    const bool is_nut = name.rfind("nut:", 0) == 0;
    const bool is_free_nut = name.rfind("free:", 0) == 0;
    auto puzzle =
        name.rfind("pair:", 0) == 0 ? bench::LoadPair(name.substr(5), has_surfaces, spacing)
        : is_nut || is_free_nut
            ? bench::LoadNut(folder + "/factory", name.substr(name.find(':') + 1), is_nut, spacing)
            : bench::LoadPuzzle(fmt::format("{}/ompl/{}.cfg", folder, name), spacing);
    if (!puzzle) {
      std::cerr << puzzle.error().ToString() << "\n";
      return 1;
    }
    contact::Scene scene;
    (void)scene.Add(puzzle->around_shape, spatial::Pose());
    planning::WayProblem problem;
    problem.scene = &scene;
    problem.part = puzzle->part_shape;
    problem.X_WB_start = puzzle->X_WB_start;
    problem.X_WB_goal = puzzle->X_WB_goal;
    problem.tolerance = tolerance.value_or(puzzle->tolerance);
    problem.axes = puzzle->axes;
    Tally tally;
    for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
      planning::WayOptions options;
      options.seed = static_cast<std::uint64_t>(seed);
      options.budget = budget;
      options.has_to_improve = has_shortening;
      std::stop_source stop;
      options.stop = stop.get_token();
      const auto start = std::chrono::steady_clock::now();
      options.progress = [&](double) {
        if (Seconds(start) > limit) {
          stop.request_stop();
        }
      };
      const auto found = planning::FindWay(problem, options);
      const double seconds = Seconds(start);
      if (!found) {
        std::cerr << found.error().ToString() << "\n";
        break;
      }
      ++tally.runs;
      std::string text = "none";
      if (found->way) {
        ++tally.solved;
        tally.seconds.push_back(seconds);
        tally.queries.push_back(static_cast<double>(found->queries));
        const double step = planning::CheckStepOf(problem.tolerance);
        const bench::FclFinding fcl =
            bench::CheckByFcl(*puzzle, found->way->path, step / 10, 20000);
        tally.colliding += fcl.colliding > 0 ? 1 : 0;
        text = fmt::format("{} {} poses, deepest {:.1f} um; FCL {} of {} samples collide",
                           planning::NameOf(found->way->method), found->way->path.size(),
                           1e6 * found->way->deepest, fcl.colliding, fcl.samples);
      } else {
        text = fmt::format("none, to go {:.2f} mm, {} stops", 1e3 * found->distance_to_go,
                           found->stops.size());
      }
      std::cout << fmt::format("{} seed {}: {:.2f} s, {} queries ({:.1f} us each), {}\n",
                               puzzle->name, seed, seconds, found->queries,
                               1e6 * seconds / static_cast<double>(found->queries), text)
                << std::flush;
    }
    std::cout << fmt::format(
        "{:24s} {} of {} solved, median {:.2f} s, most {:.2f} s, {:.0f} queries\n", puzzle->name,
        tally.solved, tally.runs, MedianOf(tally.seconds),
        tally.seconds.empty() ? 0.0 : *std::max_element(tally.seconds.begin(), tally.seconds.end()),
        MedianOf(tally.queries));
    Tally peer;
    for (int seed = 1; seed <= peer_seeds && puzzle->X_WB_goal; ++seed) {
      peer_options.seed = static_cast<std::uint32_t>(seed);
      peer_options.limit_s = limit;
      const bench::PeerRun run = bench::SolveByOmpl(*puzzle, peer_options);
      ++peer.runs;
      peer.solved += run.is_solved ? 1 : 0;
      peer.seconds.push_back(run.seconds);  // Of a run that did not solve it, the limit.
      peer.queries.push_back(static_cast<double>(run.queries));
      std::string text = "none";
      if (run.is_solved) {
        const bench::FclFinding fcl = bench::CheckByFcl(*puzzle, run.path, 5e-6, 20000);
        peer.colliding += fcl.colliding > 0 ? 1 : 0;
        text = fmt::format("{} poses, checked each {:.3f} mm; FCL {} of {} samples collide",
                           run.poses, 1e3 * run.check_step, fcl.colliding, fcl.samples);
      }
      std::cout << fmt::format("{} peer seed {}: {:.2f} s, {} queries, {}\n", puzzle->name, seed,
                               run.seconds, run.queries, text)
                << std::flush;
    }
    if (peer.runs > 0) {
      std::cout << fmt::format(
          "{:24s} peer {} of {} solved, {} of them through the mesh, median {:.2f} s, {:.0f} "
          "queries\n",
          puzzle->name, peer.solved, peer.runs, peer.colliding, MedianOf(peer.seconds),
          MedianOf(peer.queries));
    }
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
