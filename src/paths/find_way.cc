#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "paths/align_way.h"
#include "paths/check_way.h"
#include "paths/free_motion.h"
#include "paths/moves.h"
#include "paths/push_search.h"
#include "paths/shorten_way.h"
#include "paths/tree_search.h"
#include "paths/way.h"
#include "paths/widen_way.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

// Choices. Pushes find what they find soon, or not at all: a bayonet, a stepped channel and a hook
// among the pairs of the tests take 1,000 to 20,000 queries. Towards a goal pose they are fewer:
// what they reach is where the tree begins, without which Twistycool takes ten times as many
// queries.
constexpr std::uint64_t kQueriesOfPushesToGoal = 6'000;
constexpr std::uint64_t kQueriesOfPushes = 60'000;
constexpr std::uint64_t kQueriesOfFreeMotion = 6'000;  // Sixty turns take fewer: a choice.
constexpr std::uint64_t kShareOfPushes = 2;  // Of the budget: at most one in so many queries.
constexpr double kShareOfShortening = 0.3;
constexpr double kShareOfWidening = 0.3;
// A thread's motion strays from its screw by less, and goes along it by more, of the part's size:
// threads stray by 0.0003 to 0.06, a key that turns below its plate by 0.15, and a bayonet does not
// go along.
constexpr double kMostFromScrew = 0.1;
constexpr double kLeastAlongScrew = 0.05;
constexpr std::uint64_t kLeastOfImproving = 10'000;  // Queries, for either: a choice.

Result<void> CheckProblem(const WayProblem& problem, Probe* probe) {
  const auto is_free = [&](const Pose& X_WB) {
    return probe->Query(X_WB, 2 * std::abs(problem.tolerance)) >= -problem.tolerance;
  };
  if (!is_free(problem.X_WB_start)) {
    return Fail(ErrorCode::kInvalid, "the part is deeper in others at its start than the tolerance",
                "", "raise the tolerance or allow the overlap");
  }
  if (problem.X_WB_goal && !is_free(*problem.X_WB_goal)) {
    return Fail(ErrorCode::kInvalid, "the part is deeper in others at its goal than the tolerance",
                "", "raise the tolerance or allow the overlap");
  }
  return {};
}

std::optional<Path> SearchStraight(Probe* probe, const std::vector<Vec3>& directions, double step) {
  const WayProblem& problem = probe->problem();
  const Pose& X = problem.X_WB_start;
  if (problem.X_WB_goal) {
    return IsScrewFree(probe, X, *problem.X_WB_goal, step)
               ? std::optional<Path>({X, *problem.X_WB_goal})
               : std::nullopt;
  }
  for (const Vec3& direction : directions) {
    const double exit = probe->CalcExit(X, direction) + 1e-6;
    // From near to far: what is blocked mostly is so at once.
    const double stride = std::max(probe->size() / 200, step);
    bool is_free = true;
    for (int look = 1; look * stride < exit && is_free; ++look) {
      is_free = probe->IsFree(Pose(X.q(), Vec3(X.p() + look * stride * direction)));
    }
    const Path path{X, Pose(X.q(), Vec3(X.p() + exit * direction))};
    if (is_free && CheckWay(probe, path, step).is_free) {
      return path;
    }
  }
  return std::nullopt;
}

/** How far the poses of a free motion, but for its ends, stray from one screw, as lengths of
 displacements [m]. */
double CalcFarthestFromScrew(const Probe& probe, const Path& path, const ScrewAxis& axis) {
  double farthest = 0;
  double angle = 0;
  for (std::size_t i = 1; i + 2 < path.size(); ++i) {
    const Screw step = FindScrew(path[i + 1] * path[i].Inverse());
    angle += step.turn.dot(axis.axis_W);
    const Pose X_screw =
        MoveAlong({Vec3(angle * axis.axis_W), axis.p_WQ,
                   Vec3(axis.pitch * angle / (2 * std::numbers::pi) * axis.axis_W)},
                  1);
    const Displacement off = probe.CalcDisplacement(X_screw * path[1], path[i + 1]);
    farthest = std::max(farthest, probe.CalcLength(off));
  }
  return farthest;
}

bool IsThread(const Probe& probe, const Path& path, const FreeScrew& screw) {
  const double along = std::abs(screw.axis.pitch) * screw.turn / (2 * std::numbers::pi);
  return along > kLeastAlongScrew * probe.size() &&
         CalcFarthestFromScrew(probe, path, screw.axis) < kMostFromScrew * probe.size();
}

void DescribeFailure(SearchState* state, WaySearch* search) {
  Probe& probe = *state->probe;
  search->farthest = state->tree.ListPath(state->best);
  search->distance_to_go = std::max(0.0, state->best_to_go);
  probe.Query(search->farthest.back(), std::max(2 * std::abs(probe.tolerance()), probe.grain()));
  search->stops = ListStops(probe.contacts(), std::numeric_limits<double>::infinity());
}

struct FoundPath {
  Path path;
  WayMethod method;
  FreeScrew screw{};  // Of a free motion along one.
};

/** Searches by one method after the other, the quick ones first. */
std::optional<FoundPath> FindPath(const WayProblem& problem, const WayOptions& options, double step,
                                  SearchState* state) {
  Probe* const probe = state->probe;
  const std::vector<Vec3> directions = ListDirections(probe);
  if (auto path = SearchStraight(probe, directions, step)) {
    return FoundPath{*std::move(path), WayMethod::kStraight};
  }
  const std::uint64_t of_free_motion = std::min(kQueriesOfFreeMotion, options.budget);
  if (auto found = FindFreeMotion(probe, options, of_free_motion, step)) {
    return FoundPath{std::move(found->path), WayMethod::kFreeMotion, std::move(found->screw)};
  }
  const std::vector<ScrewAxis> axes = ListAxes(probe);
  const std::uint64_t of_pushes =
      std::min(problem.X_WB_goal ? kQueriesOfPushesToGoal : kQueriesOfPushes,
               options.budget / kShareOfPushes);
  if (const auto pushed = SearchByPushes(state, directions, axes, of_pushes)) {
    std::size_t edge = 0;
    if (auto path = RepairWay(probe, *pushed, step, &edge)) {
      return FoundPath{*std::move(path), WayMethod::kPushes};
    }
  }
  if (auto path = SearchByTree(state, directions, axes, options)) {
    return FoundPath{*std::move(path), WayMethod::kTree};
  }
  return std::nullopt;
}

/** Makes a path shorter, wider and straight. The middle of a thread's play is clear, and it has no
 shorter way. */
void Improve(const WayOptions& options, double step, Probe* probe, FoundPath* found) {
  if (found->screw.turn > 0 && IsThread(*probe, found->path, found->screw)) {
    return;
  }
  const auto share_of = [&options](double share) {
    return kLeastOfImproving +
           static_cast<std::uint64_t>(share * static_cast<double>(options.budget));
  };
  found->screw = FreeScrew();
  found->path = ShortenWay(probe, found->path, step, options.seed, share_of(kShareOfShortening));
  found->path = WidenWay(probe, found->path, step, share_of(kShareOfWidening));
  found->path = AlignWay(probe, found->path, step);
}

}  // namespace

const char* NameOf(WayMethod method) {
  switch (method) {
    case WayMethod::kStraight:
      return "straight";
    case WayMethod::kFreeMotion:
      return "free motion";
    case WayMethod::kPushes:
      return "pushes";
    case WayMethod::kTree:
      return "tree";
  }
  return "";
}

Result<WaySearch> FindWay(const WayProblem& problem, const WayOptions& options) {
  if (problem.scene == nullptr || problem.part == nullptr) {
    return Fail(ErrorCode::kInvalid, "the problem has no scene or no part", "", "");
  }
  Probe probe(problem, options);
  if (const auto valid = CheckProblem(problem, &probe); !valid) {
    return Unexpected(valid.error());
  }
  const double step = CheckStepOf(problem.tolerance);
  SearchState state(&probe);
  WaySearch search;
  std::optional<FoundPath> found = FindPath(problem, options, step, &state);
  search.is_stopped = options.stop.stop_requested();
  search.is_budget_over = probe.is_over() && !search.is_stopped;
  if (!found) {
    DescribeFailure(&state, &search);
  } else {
    probe.Extend(options.budget + 2 * kLeastOfImproving);
    if (options.has_to_improve && found->method != WayMethod::kStraight) {
      Improve(options, step, &probe, &*found);
    }
    double deepest = std::numeric_limits<double>::infinity();
    for (const Pose& X_WB : found->path) {
      deepest = std::min(deepest, probe.Query(X_WB, std::abs(problem.tolerance)));
    }
    search.way = Way{std::move(found->path), deepest, found->method, std::move(found->screw)};
  }
  search.queries = probe.queries();
  search.points = probe.points();
  return search;
}

}  // namespace hvas::paths
