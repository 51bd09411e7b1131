#include "paths/push.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paths/slide_step.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

constexpr double kLargestStep = 1.0 / 48;  // Of the part's size.
constexpr double kLeastStep = 1.0 / 3000;  // Of the part's size.
constexpr double kShorter = 0.3;           // A step that failed is tried again as long as this.
constexpr double kLonger = 1.8;            // And one that went well is followed by one as long.
constexpr double kLeastGain = 0.05;  // Of a step; a push that comes no nearer than this is stuck.

}  // namespace

WantedPose MakePushTo(const Probe& probe, const Pose& X_WB_goal) {
  return [&probe, X_WB_goal](const Pose& X_WB, double step) -> std::optional<Pose> {
    const Displacement d = probe.CalcDisplacement(X_WB, X_WB_goal);
    const double length = probe.CalcReachOf(d);
    if (length < 1e-9) {
      return std::nullopt;
    }
    if (length <= step) {
      return X_WB_goal;
    }
    const double part = step / length;
    return probe.Move(X_WB, {Vec3(part * d.w_W), Vec3(part * d.v_W)});
  };
}

WantedPose MakePushBy(const Probe& probe, const Displacement& d) {
  const double length = probe.CalcReachOf(d);
  return [&probe, d, length](const Pose& X_WB, double step) -> std::optional<Pose> {
    const double part = step / length;
    return probe.Move(X_WB, {Vec3(part * d.w_W), Vec3(part * d.v_W)});
  };
}

WantedPose MakePushAbout(const Probe& probe, const ScrewAxis& axis, double sign) {
  return [&probe, axis, sign](const Pose& X_WB, double step) -> std::optional<Pose> {
    const Vec3 centre = X_WB * probe.centre_B();
    const double lead = axis.pitch / (2 * std::numbers::pi);
    const double arm = (centre - axis.p_WQ).cross(axis.axis_W).norm() + probe.reach();
    const double angle = sign * step / std::hypot(arm, lead);
    const Quat q = spatial::RotationFromVector(Vec3(angle * axis.axis_W));
    const Pose turn(q, Vec3(axis.p_WQ - q * axis.p_WQ + angle * lead * axis.axis_W));
    return turn * X_WB;
  };
}

PushOptions MakePushOptions(const Probe& probe, double longest) {
  PushOptions options;
  options.longest = longest;
  options.largest_step = kLargestStep * probe.size();
  options.first_step = 0.5 * options.largest_step;
  options.least_step = std::max(kLeastStep * probe.size(), probe.grain());
  return options;
}

Push PushPart(Probe* probe, const Pose& from, const WantedPose& wanted,
              const PushOptions& options) {
  Push push;
  Pose X = from;
  double step = options.first_step;
  while (push.length < options.longest && !probe->is_over()) {
    const std::optional<Pose> next = wanted(X, step);
    if (!next) {
      push.is_reached = true;
      return push;
    }
    std::optional<Pose> made = SlideStep(probe, X, *next, step);
    if (made && options.ends_in_gain) {
      // The wanted pose is nearer to the goal; what was made may have slid away from it.
      const double wanted_gain = probe->CalcLength(probe->CalcDisplacement(X, *next));
      const auto to = [&](const Pose& at) {
        const std::optional<Pose> goal = wanted(at, 1e9);
        return goal ? probe->CalcLength(probe->CalcDisplacement(at, *goal)) : 0.0;
      };
      if (to(X) - to(*made) < kLeastGain * wanted_gain) {
        made.reset();
      }
    }
    if (!made) {
      step *= kShorter;
      if (step < options.least_step) {
        push.is_blocked = true;
        return push;
      }
      continue;
    }
    push.length += probe->CalcReachOf(probe->CalcDisplacement(X, *made));
    X = *made;
    push.path.push_back(X);
    step = std::min(kLonger * step, options.largest_step);
  }
  return push;
}

}  // namespace hvas::paths
