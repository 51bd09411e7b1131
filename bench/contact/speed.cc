#include "speed.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace hvas::bench {
namespace {

std::size_t PoseAt(int i, int poses) {
  return static_cast<std::size_t>(i) * kTrackPoses / static_cast<std::size_t>(poses);
}

}  // namespace

Spread CalcSpread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {values[n / 2], values[std::min(n - 1, n * 99 / 100)], values[n - 1]};
}

PoseTimes Measure(Method* method, const Track& track, int poses, int passes) {
  PoseTimes times;
  times.least.assign(static_cast<std::size_t>(poses), std::numeric_limits<double>::infinity());
  times.contacts.assign(static_cast<std::size_t>(poses), 0);
  times.deepest.assign(static_cast<std::size_t>(poses), 0);
  times.effort.assign(static_cast<std::size_t>(poses), {});
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < poses; ++i) {
      const double start = ThreadSeconds();
      const std::size_t found = method->Query(track.poses[PoseAt(i, poses)]);
      const double taken = ThreadSeconds() - start;
      const auto k = static_cast<std::size_t>(i);
      times.least[k] = std::min(times.least[k], taken);
      if (pass == 0) {
        times.contacts[k] = found;
        times.effort[k] = method->effort();
        for (const FoundContact& c : method->contacts()) {
          times.deepest[k] = std::max(times.deepest[k], c.depth);
        }
      }
    }
  }
  return times;
}

std::vector<SpeedRow> RunTrack(const Track& track, const std::vector<PlacedPart>& scene,
                               const std::vector<Entrant>& entrants) {
  std::vector<SpeedRow> rows;
  PoseTimes first;
  for (const Entrant& entrant : entrants) {
    const std::unique_ptr<Method> method = entrant.make();
    method->Load(track.held, scene);
    const int poses = std::min(entrant.poses, kTrackPoses);
    const PoseTimes times = Measure(method.get(), track, poses, entrant.passes);
    if (rows.empty()) {
      first = times;
    }
    SpeedRow row;
    row.track = track.name;
    row.method = entrant.name;
    row.scene = scene.size();
    row.poses = poses;
    row.passes = entrant.passes;
    row.time = CalcSpread(times.least);
    std::vector<double> same;  // Of the first entrant, at the same poses.
    const int first_poses = static_cast<int>(first.least.size());
    for (int i = 0; i < poses; ++i) {
      const auto k = PoseAt(i, poses) * static_cast<std::size_t>(first_poses) / kTrackPoses;
      same.push_back(first.least[k]);
    }
    row.ratio = row.time.median / CalcSpread(same).median;
    const double n = static_cast<double>(poses);
    row.contacts = static_cast<double>(std::accumulate(times.contacts.begin(), times.contacts.end(),
                                                       std::size_t{0})) /
                   n;
    row.touching =
        static_cast<double>(poses - std::count(times.contacts.begin(), times.contacts.end(), 0U)) /
        n;
    row.depth = CalcSpread(times.deepest);
    const auto spread = [&](std::size_t Effort::*count) {
      std::vector<double> values;
      for (const Effort& e : times.effort) {
        values.push_back(static_cast<double>(e.*count));
      }
      return CalcSpread(values);
    };
    row.bodies = spread(&Effort::bodies);
    row.points = spread(&Effort::points);
    row.candidates = spread(&Effort::candidates);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace hvas::bench
