#include "planning/shorten_way.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "planning/check_way.h"
#include "planning/slide_step.h"

namespace hvas::planning {
namespace {

using spatial::Pose;

constexpr int kMostRepairs = 12;     // Bisections of one step, one in the other: a choice.
constexpr int kMostPushesOut = 6;    // Until a pose between two others is free: a choice.
constexpr int kShortcuts = 200;      // Tries; the length of puzzles' ways has settled by then.
constexpr double kShortest = 0.005;  // Of the part's size: detours shorter than this stay.

// The pose between two others, pushed out of contact.
std::optional<Pose> FindBetween(Probe* probe, const Pose& a, const Pose& b, double step) {
  const double length = probe->CalcReachOf(probe->CalcDisplacement(a, b));
  const double target = PushTargetOf(probe->tolerance());
  PushOut out(*probe, sweep::Interpolate(a, b, 0.5));
  for (int push = 0; push <= kMostPushesOut; ++push) {
    const Pose X = out.pose();
    if (probe->Query(X, std::max(0.0, target)) >= -probe->tolerance()) {
      const double longest = 0.9 * length + step;
      const auto is_near = [&](const Pose& end) {
        return probe->CalcReachOf(probe->CalcDisplacement(X, end)) < longest;
      };
      return is_near(a) && is_near(b) ? std::optional<Pose>(X) : std::nullopt;
    }
    out.Add(probe->contacts(), target);
  }
  return std::nullopt;
}

bool RepairStep(Probe* probe, const Pose& a, const Pose& b, double step, int depth,
                sweep::Path* out) {
  if (IsScrewFree(probe, a, b, step)) {
    out->push_back(b);
    return true;
  }
  if (depth == kMostRepairs || probe->is_over()) {
    return false;
  }
  const std::optional<Pose> between = FindBetween(probe, a, b, step);
  return between && RepairStep(probe, a, *between, step, depth + 1, out) &&
         RepairStep(probe, *between, b, step, depth + 1, out);
}

}  // namespace

double CalcWayLength(const Probe& probe, const sweep::Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += probe.CalcLength(probe.CalcDisplacement(path[i - 1], path[i]));
  }
  return length;
}

std::optional<sweep::Path> RepairWay(Probe* probe, const sweep::Path& path, double step,
                                     std::size_t* edge) {
  sweep::Path out{path.front()};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!RepairStep(probe, path[i], path[i + 1], step, 0, &out)) {
      *edge = i;
      return std::nullopt;
    }
  }
  return out;
}

sweep::Path ShortenWay(Probe* probe, const sweep::Path& path, double step, std::uint64_t seed,
                       std::uint64_t budget) {
  Random random(seed);
  sweep::Path way = path;
  const std::uint64_t last = probe->queries() + budget;
  // Places along the way by length, so that long pieces are chosen as often as they are long.
  std::vector<double> at;
  const auto measure = [&] {
    at.assign(1, 0.0);
    for (std::size_t i = 1; i < way.size(); ++i) {
      at.push_back(at.back() + probe->CalcLength(probe->CalcDisplacement(way[i - 1], way[i])));
    }
  };
  const auto find = [&](double s, std::size_t* edge) {
    const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, s);
    *edge = static_cast<std::size_t>(next - at.begin()) - 1;
    const double length = at[*edge + 1] - at[*edge];
    return sweep::Interpolate(way[*edge], way[*edge + 1],
                              length > 0 ? (s - at[*edge]) / length : 0.0);
  };
  measure();
  for (int i = 0; i < kShortcuts && probe->queries() < last && !probe->is_over(); ++i) {
    if (way.size() < 3) {
      break;
    }
    // Wide ones first, later also narrow ones.
    const double widest = at.back() * (i < kShortcuts / 4 ? 1.0 : 0.3);
    double from = i == 0 ? 0 : random.Uniform(0, at.back());
    double to = i == 0 ? at.back() : from + random.Uniform(0.02, 1) * widest;
    to = std::min(to, at.back());
    std::size_t first = 0;
    std::size_t second = 0;
    const Pose a = from <= 0 ? way.front() : find(from, &first);
    const Pose b = to >= at.back() ? way.back() : find(to, &second);
    second = to >= at.back() ? way.size() - 2 : second;
    if (first == second) {
      continue;
    }
    const double direct = probe->CalcLength(probe->CalcDisplacement(a, b));
    if (direct > 0.98 * (to - from) && to - from - direct < kShortest * probe->size() &&
        second - first < 2) {
      continue;
    }
    if (!IsScrewFree(probe, a, b, step)) {
      continue;
    }
    // What stays of the first and last edge is sampled at other places than it was.
    if ((from > at[first] && !IsScrewFree(probe, way[first], a, step)) ||
        (to < at[second + 1] && !IsScrewFree(probe, b, way[second + 1], step))) {
      continue;
    }
    sweep::Path next(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(first) + 1);
    if (from > at[first]) {
      next.push_back(a);
    }
    if (to < at[second + 1]) {
      next.push_back(b);
    }
    next.insert(next.end(), way.begin() + static_cast<std::ptrdiff_t>(second) + 1, way.end());
    way = std::move(next);
    measure();
  }
  return way;
}

}  // namespace hvas::planning
