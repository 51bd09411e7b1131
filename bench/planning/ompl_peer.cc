#include "ompl_peer.h"

#include <chrono>

#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "fcl_check.h"

namespace hvas::bench {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Space = ob::SE3StateSpace;

spatial::Pose PoseOf(const ob::State* state) {
  const auto* s = state->as<Space::StateType>();
  const auto& q = s->rotation();
  return {Quat(q.w, q.x, q.y, q.z), 1e-3 * Vec3(s->getX(), s->getY(), s->getZ())};
}

}  // namespace

PeerRun SolveByOmpl(const Puzzle& puzzle, const PeerOptions& options) {
  ompl::msg::setLogLevel(
      ompl::msg::LOG_NONE);  // It takes a seed once a process, and complains of others.
  ompl::RNG::setSeed(options.seed);
  const FclPair pair(puzzle);
  PeerRun run;
  // In millimetres, so that turns and ways have the weights that OMPL.app's files are made for.
  const auto space = std::make_shared<Space>();
  spatial::Box box = puzzle.around_shape->box_B();
  box.Add(puzzle.X_WB_start.p());
  box.Add(puzzle.X_WB_goal->p());
  box = box.Expanded(0.35 * puzzle.part_shape->box_B().size().norm());
  ob::RealVectorBounds bounds(3);
  for (unsigned i = 0; i < 3; ++i) {
    bounds.setLow(i, 1e3 * box.low[static_cast<Eigen::Index>(i)]);
    bounds.setHigh(i, 1e3 * box.high[static_cast<Eigen::Index>(i)]);
  }
  space->setBounds(bounds);
  og::SimpleSetup setup(space);
  setup.setStateValidityChecker([&](const ob::State* state) {
    ++run.queries;
    return setup.getSpaceInformation()->satisfiesBounds(state) && !pair.Collides(PoseOf(state));
  });
  const auto state_of = [&](const spatial::Pose& X) {
    ob::ScopedState<Space> state(space);
    state->setXYZ(1e3 * X.p().x(), 1e3 * X.p().y(), 1e3 * X.p().z());
    auto& q = state->rotation();
    q.w = X.q().w();
    q.x = X.q().x();
    q.y = X.q().y();
    q.z = X.q().z();
    return state;
  };
  setup.setStartAndGoalStates(state_of(puzzle.X_WB_start), state_of(*puzzle.X_WB_goal));
  setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
  setup.getSpaceInformation()->setStateValidityCheckingResolution(options.resolution);
  run.check_step = 1e-3 * options.resolution * space->getMaximumExtent();
  const auto start = std::chrono::steady_clock::now();
  const ob::PlannerStatus status = setup.solve(options.limit_s);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.is_solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  if (run.is_solved) {
    og::PathGeometric& path = setup.getSolutionPath();
    run.poses = path.getStateCount();
    // It moves between its poses as OMPL interpolates, which is no screw.
    constexpr unsigned kFine = 5000;
    path.interpolate(kFine);
    for (const ob::State* state : path.getStates()) {
      run.path.push_back(PoseOf(state));
    }
  }
  return run;
}

}  // namespace hvas::bench
