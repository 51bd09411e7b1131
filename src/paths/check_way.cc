#include "paths/check_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hvas::paths {
namespace {

using spatial::Pose;

constexpr double kLeastCheckStep = 20e-6;  // [m]; samples of the same face are further apart.
constexpr double kTooDeep = 1e3;           // [m]: deeper than any part, whatever it is: a choice.
// Samples in contact until the next look around, which takes as long as many samples where much is
// near, as on a thread: choices.
constexpr int kCloseLooks = 12;
constexpr int kCloseLooksOfMany = 200;
constexpr std::uint32_t kManyCandidates = 400;
constexpr double kFarthestLook =
    0.05;  // Of the part's size: a query further costs more than it saves.

}  // namespace

double CheckStepOf(double tolerance) {
  return std::max(std::abs(tolerance), kLeastCheckStep);
}

std::vector<StoppingFaces> ListStops(std::span<const contact::Contact> contacts, double limit) {
  std::vector<StoppingFaces> stops;
  for (const contact::Contact& c : contacts) {
    const bool is_known = std::any_of(stops.begin(), stops.end(), [&c](const StoppingFaces& s) {
      return s.body == c.body && s.held_face == c.held_face && s.scene_face == c.scene_face;
    });
    if (c.distance <= limit && !is_known) {
      stops.push_back({c.body, c.held_face, c.scene_face});
    }
  }
  return stops;
}

namespace {

// Checks one screw without its first pose. What it samples depends on nothing before it, so that a
// way passes where each of its screws does.
class ScrewCheck {
 public:
  ScrewCheck(Probe* probe, double step, WayCheck* check)
      : probe_(*probe),
        check_(*check),
        step_(step),
        farthest_(std::max(kFarthestLook * probe->size(), 4 * step)),
        margin_(4 * step) {}

  // @returns whether it is free; else check->fraction and check->X_WB say where it is not.
  [[nodiscard]] bool Run(const Pose& from, const Pose& to) {
    const double length = CalcLongestWay(from, to, probe_.problem().part->box_B());
    double at = 0;
    double distance = 0;
    while (at < length) {
      if (probe_.is_over()) {
        check_.is_over = true;
        return false;
      }
      at = std::min(length, at + step_ + std::max(0.0, distance));
      check_.X_WB = at < length ? Interpolate(from, to, at / length) : to;
      check_.fraction = at / length;
      distance = Look(check_.X_WB);
      if (distance < -probe_.tolerance()) {
        return false;
      }
    }
    return true;
  }

 private:
  // What touches mostly goes on touching: it is asked only whether it is too deep, which is cheap,
  // and from time to time how far others are. What is free is soon free further.
  [[nodiscard]] double Look(const Pose& X_WB) {
    if (until_look_ > 0) {
      --until_look_;
      return probe_.IsFree(X_WB) ? -probe_.tolerance() : -kTooDeep;
    }
    const double distance = probe_.Query(X_WB, margin_);
    check_.deepest = std::min(check_.deepest, distance);
    if (distance < step_) {
      until_look_ = probe_.candidates() > kManyCandidates ? kCloseLooksOfMany : kCloseLooks;
      margin_ = 4 * step_;
    } else {
      margin_ = distance >= margin_ ? std::min(2 * margin_, farthest_)
                                    : std::clamp(2 * distance, 4 * step_, farthest_);
    }
    return distance;
  }

  Probe& probe_;
  WayCheck& check_;
  double step_, farthest_, margin_;
  int until_look_{0};
};

}  // namespace

WayCheck CheckWay(Probe* probe, const Path& path, double step) {
  WayCheck check;
  check.deepest = std::numeric_limits<double>::infinity();
  check.X_WB = path.front();
  const auto note_stops = [&] {
    (void)probe->Query(check.X_WB, std::max(0.0, -probe->tolerance()));
    check.stops = ListStops(probe->contacts(), -probe->tolerance());
  };
  if (!probe->IsFree(path.front())) {
    note_stops();
    return check;
  }
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    check.edge = i;
    if (!ScrewCheck(probe, step, &check).Run(path[i], path[i + 1])) {
      note_stops();
      return check;
    }
  }
  check.is_free = true;
  return check;
}

WayCheck CheckWay(const WayProblem& problem, const Path& path, double step) {
  WayOptions options;
  options.budget = std::numeric_limits<std::uint64_t>::max();
  Probe probe(problem, options);
  return CheckWay(&probe, path, step);
}

bool IsScrewFree(Probe* probe, const Pose& from, const Pose& to, double step) {
  const double length = CalcLongestWay(from, to, probe->problem().part->box_B());
  if (!probe->IsFree(to)) {
    return false;
  }
  // Halves, quarters and so on down to an eighth of the part; then one after the other.
  const double coarse = std::max(probe->size() / 64, 2 * step);
  for (int pieces = 2; length / pieces > coarse / 2; pieces *= 2) {
    for (int k = 1; k < pieces; k += 2) {
      if (probe->is_over() ||
          !probe->IsFree(Interpolate(from, to, static_cast<double>(k) / pieces))) {
        return false;
      }
    }
  }
  WayCheck check;
  return ScrewCheck(probe, step, &check).Run(from, to);
}

}  // namespace hvas::paths
