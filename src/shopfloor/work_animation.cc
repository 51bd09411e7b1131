#include "shopfloor/work_animation.h"

#include <map>
#include <utility>
#include <vector>

#include "cad/glb.h"
#include "shopfloor/step_picture.h"

namespace hvas::shopfloor {
namespace {

using product::OccurrenceId;
using spatial::Pose;

/** Poses of a part along the way of its step, from where it appears to its place. */
std::vector<Pose> ListPoses(const simulation::Model& model, const WorkStep& step, OccurrenceId id) {
  const Pose& X_WB = model.bodies[id.index()].X_WB_goal;
  if (step.there.empty()) {
    return {X_WB};
  }
  if (step.way.empty()) {
    const double apart = CalcApart(model, step);
    return {Pose(X_WB.q(), Vec3(X_WB.p() + apart * step.out_W)), X_WB};
  }
  std::vector<Pose> poses;
  const Pose X_LB = model.bodies[step.leading.front().index()].X_WB_goal.Inverse() * X_WB;
  for (auto X_WL = step.way.rbegin(); X_WL != step.way.rend(); ++X_WL) {
    poses.push_back(*X_WL * X_LB);
  }
  return poses;
}

}  // namespace

std::vector<double> ListStepStarts(const WorkPlan& plan) {
  std::vector<double> starts;
  double start = 0;
  for (const WorkStep& step : plan.steps) {
    starts.push_back(start);
    start += step.kind == WorkStep::Kind::kLayAside ? 0 : kStepSeconds;
  }
  return starts;
}

Result<std::string> MakeWorkAnimation(const simulation::Model& model, const WorkPlan& plan) {
  constexpr double kNever = 1e6;  // Later than any animation ends [s].
  std::map<OccurrenceId, cad::GlbMotion> motions;
  const std::vector<double> starts = ListStepStarts(plan);
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const WorkStep& step = plan.steps[s];
    if (step.kind == WorkStep::Kind::kLayAside) {
      continue;
    }
    for (const OccurrenceId id : step.coming) {
      const std::vector<Pose> poses = ListPoses(model, step, id);
      const auto [entry, is_new] = motions.try_emplace(id);
      cad::GlbMotion& motion = entry->second;
      if (is_new) {
        motion.occurrence = id;
        motion.appears_s = starts[s];
      }
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const double share =
            poses.size() == 1 ? 0 : static_cast<double>(i) / static_cast<double>(poses.size() - 1);
        motion.times_s.push_back(starts[s] + share * kWaySeconds);
        motion.X_WB.push_back(poses[i]);
      }
    }
  }
  for (const OccurrenceId id : plan.left_out) {
    const Pose& X_WB = model.bodies[id.index()].X_WB_goal;
    motions.try_emplace(id, cad::GlbMotion{id, kNever, {0}, {X_WB}});
  }
  std::vector<cad::GlbMotion> list;
  list.reserve(motions.size());
  for (auto& [id, motion] : motions) {
    list.push_back(std::move(motion));
  }
  return cad::MakeGlb(*model.product, false, list);
}

}  // namespace hvas::shopfloor
