#include "haptics/kick_detector.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

constexpr std::array kSpans{4e-3, 6e-3, 8e-3, 12e-3};  // [s]
/** Positions that are rounded by half a step, eight of them in e. */
constexpr double kSteps = 4;
constexpr double kHandMass = 0.05;  // [kg]; no hand that holds is lighter

}  // namespace

Kick KickDetector::Update(const Vec3& p, const Vec3& f, double dt) noexcept {
  time_ += dt;
  newest_ = (newest_ + 1) % kSize;
  samples_[newest_] = {time_, p, f.norm()};
  count_ = std::min(count_ + 1, kSize);
  for (const double span : kSpans) {
    Window window;
    if (FindWindow(span, &window)) {
      if (const Kick kick = Judge(window, span, f); kick != Kick::kNone) {
        return kick;
      }
    }
  }
  return Kick::kNone;
}

const KickDetector::Sample& KickDetector::FindBack(std::size_t ticks) const noexcept {
  return samples_[(newest_ + kSize - ticks) % kSize];
}

/** False while there are too few samples. Ticks need not be even, but the spans are then. */
bool KickDetector::FindWindow(double span, Window* window) const noexcept {
  std::array<Vec3, 4> p;
  std::size_t found = 0;
  window->most_force = window->least_force = FindBack(0).force;
  for (std::size_t back = 0; back < count_ && found < p.size(); ++back) {
    const Sample& sample = FindBack(back);
    window->most_force = std::max(window->most_force, sample.force);
    window->least_force = std::min(window->least_force, sample.force);
    constexpr double kRounding = 1e-9;  // [s]: the rounding of sums of samples.
    // Samples need not be even: the position of a time lies between two of them.
    const Sample& newer = FindBack(back > 0 ? back - 1 : 0);
    const double gap = newer.time - sample.time;
    for (; found < p.size(); ++found) {
      const double late = time_ - static_cast<double>(found) * span - sample.time;
      if (late < -kRounding) {
        break;
      }
      const bool is_between = gap > 0 && late > kRounding;
      if (is_between && gap > span) {
        return false;  // Where the handle was between samples so far apart is unknown.
      }
      p[found] = is_between ? Vec3(sample.p + late / gap * (newer.p - sample.p)) : sample.p;
    }
  }
  if (found < p.size()) {
    return false;
  }
  window->deviation = p[0] - 3 * p[1] + 3 * p[2] - p[3];
  window->moved = p[0] - p[1];
  window->moved_before = p[1] - p[2];
  return true;
}

Kick KickDetector::Judge(const Window& window, double span, const Vec3& f) const noexcept {
  const double force = f.norm();
  const double mass = thresholds_.mass + kHandMass;
  const double unseen = kSteps * thresholds_.resolution;
  const double of_hand = thresholds_.jerk * span * span * span;
  if (force >= thresholds_.min_force) {
    // A force that has fallen lets the hand through.
    const double fallen = (window.most_force - force) / mass * span * span;
    const double against = -window.deviation.dot(f) / force;
    const double inwards = -window.moved.dot(f) / force;
    if (against > unseen + of_hand + fallen && inwards > thresholds_.resolution) {
      return Kick::kAgainst;
    }
  }
  const double change = (window.most_force - window.least_force) / mass + thresholds_.blow;
  const bool is_faster = window.moved.norm() > window.moved_before.norm() + unseen;
  return is_faster && window.deviation.norm() > unseen + change * span * span ? Kick::kRunaway
                                                                              : Kick::kNone;
}

}  // namespace hvas::haptics
