#include "paths/shorten_way.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "paths/check_way.h"
#include "paths/slide_step.h"

namespace hvas::paths {
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
  PushOut out(*probe, Interpolate(a, b, 0.5));
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

bool RepairStep(Probe* probe, const Pose& a, const Pose& b, double step, int depth, Path* out) {
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

/** A way with places along it by length, so that long pieces are chosen as often as they are long.
 */
class MeasuredWay {
 public:
  MeasuredWay(Probe* probe, Path way, double step)
      : probe_(*probe), way_(std::move(way)), step_(step) {
    Measure();
  }

  [[nodiscard]] const Path& way() const { return way_; }

  [[nodiscard]] double length() const { return at_.back(); }

  /** Goes straight from one place to another where that is free, and shorter. */
  void TryShortcut(double from, double to) {
    const Place a = from <= 0 ? Place{from, 0, way_.front()} : PlaceAt(from);
    const Place b = to >= length() ? Place{to, way_.size() - 2, way_.back()} : PlaceAt(to);
    if (a.edge != b.edge && IsShorter(a, b) && IsScrewFree(&probe_, a.X, b.X, step_) &&
        AreEndsFree(a, b)) {
      Replace(a, b);
    }
  }

 private:
  struct Place {
    double s;
    std::size_t edge;
    Pose X;
  };

  [[nodiscard]] Place PlaceAt(double s) const {
    const auto next = std::upper_bound(at_.begin() + 1, at_.end() - 1, s);
    const std::size_t edge = static_cast<std::size_t>(next - at_.begin()) - 1;
    const double length = at_[edge + 1] - at_[edge];
    return {s, edge,
            Interpolate(way_[edge], way_[edge + 1], length > 0 ? (s - at_[edge]) / length : 0.0)};
  }

  [[nodiscard]] bool IsShorter(const Place& a, const Place& b) const {
    const double along = b.s - a.s;
    const double direct = probe_.CalcLength(probe_.CalcDisplacement(a.X, b.X));
    return direct <= 0.98 * along || along - direct >= kShortest * probe_.size() ||
           b.edge - a.edge >= 2;
  }

  [[nodiscard]] bool HasRestBefore(const Place& a) const { return a.s > at_[a.edge]; }

  [[nodiscard]] bool HasRestAfter(const Place& b) const { return b.s < at_[b.edge + 1]; }

  /** Whether what stays of the first and last edge is free: it is sampled at other places now. */
  [[nodiscard]] bool AreEndsFree(const Place& a, const Place& b) {
    return (!HasRestBefore(a) || IsScrewFree(&probe_, way_[a.edge], a.X, step_)) &&
           (!HasRestAfter(b) || IsScrewFree(&probe_, b.X, way_[b.edge + 1], step_));
  }

  void Replace(const Place& a, const Place& b) {
    Path next(way_.begin(), way_.begin() + static_cast<std::ptrdiff_t>(a.edge) + 1);
    if (HasRestBefore(a)) {
      next.push_back(a.X);
    }
    if (HasRestAfter(b)) {
      next.push_back(b.X);
    }
    next.insert(next.end(), way_.begin() + static_cast<std::ptrdiff_t>(b.edge) + 1, way_.end());
    way_ = std::move(next);
    Measure();
  }

  void Measure() {
    at_.assign(1, 0.0);
    for (std::size_t i = 1; i < way_.size(); ++i) {
      at_.push_back(at_.back() + probe_.CalcLength(probe_.CalcDisplacement(way_[i - 1], way_[i])));
    }
  }

  Probe& probe_;
  Path way_;
  double step_;
  std::vector<double> at_;  // Length of the way to each of its poses.
};

}  // namespace

double CalcWayLength(const Probe& probe, const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += probe.CalcLength(probe.CalcDisplacement(path[i - 1], path[i]));
  }
  return length;
}

std::optional<Path> RepairWay(Probe* probe, const Path& path, double step, std::size_t* edge) {
  Path out{path.front()};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!RepairStep(probe, path[i], path[i + 1], step, 0, &out)) {
      *edge = i;
      return std::nullopt;
    }
  }
  return out;
}

Path ShortenWay(Probe* probe, const Path& path, double step, std::uint64_t seed,
                std::uint64_t budget) {
  Random random(seed);
  MeasuredWay way(probe, path, step);
  const std::uint64_t last = probe->queries() + budget;
  for (int i = 0; i < kShortcuts && probe->queries() < last && !probe->is_over(); ++i) {
    if (way.way().size() < 3) {
      break;
    }
    // Wide ones first, later also narrow ones.
    const double widest = way.length() * (i < kShortcuts / 4 ? 1.0 : 0.3);
    const double from = i == 0 ? 0 : random.Uniform(0, way.length());
    const double to = i == 0 ? way.length() : from + random.Uniform(0.02, 1) * widest;
    way.TryShortcut(from, std::min(to, way.length()));
  }
  return way.way();
}

}  // namespace hvas::paths
